#pragma once

#include <string>

namespace pcednet::app {

/// A word as a shell takes it: in quotes if it has blanks or other characters with a meaning there.
std::string shell_word(const std::string& word);

}  // namespace pcednet::app
