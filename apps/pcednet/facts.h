#pragma once

#include <filesystem>
#include <string>

#include "pcednet/core/json.h"
#include "pcednet/formats/cloud_facts.h"

namespace pcednet::app {

/// The output of `info` for a file, for programs and for people.
OrderedJson json_of(const std::filesystem::path& path, const formats::CloudFacts& facts);
std::string text_of(const std::filesystem::path& path, const formats::CloudFacts& facts);

}  // namespace pcednet::app
