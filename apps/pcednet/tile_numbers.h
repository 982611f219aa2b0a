#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace pcednet::app {

/// The numbers that texts such as "7" and "0-15" name, ascending; all of `tiles` if there are no
/// texts. Throws Error(kUsage) for a text that names none.
std::vector<std::size_t> tile_numbers(const std::vector<std::string>& texts, std::size_t tiles);

/// The options that name them (ascending): " --tile 7 --tile 9-15".
std::string tile_options(const std::vector<std::size_t>& numbers);

/// A word as a shell takes it: in quotes if it has blanks or other characters with a meaning there.
std::string shell_word(const std::string& word);

}  // namespace pcednet::app
