#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace pcednet::report {

/// RFC 4648 base64, with padding.
std::string encode_base64(std::span<const std::uint8_t> bytes);

}  // namespace pcednet::report
