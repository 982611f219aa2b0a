#include "pcednet/io/las/extra_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "pcednet/io/las/offsets.h"

namespace pcednet::io {
namespace {

/// "[12]" for the last component; nothing for a single number.
std::string last_index(const Attribute& attribute) {
  return attribute.components > 1 ? fmt::format("[{}]", attribute.components - 1) : "";
}

std::vector<std::string> with_indices(const Attribute& attribute, const std::string& stem) {
  if (attribute.components <= 1) return {stem};
  std::vector<std::string> names;
  for (std::size_t c = 0; c < attribute.components; ++c) {
    names.push_back(fmt::format("{}[{}]", stem, c));
  }
  return names;
}

bool fits(const Attribute& attribute) {
  return attribute.name.size() + last_index(attribute).size() <= las_descriptor::kNameBytes;
}

/// The first `most` bytes of a longer name, or up to three fewer, which end with a character. Names
/// need not be UTF-8: those that are not are cut anywhere.
std::string cut(std::string_view name, std::size_t most) {
  constexpr std::size_t kLongestCharacter = 4;
  const auto begins = [&](std::size_t at) {
    return (static_cast<unsigned char>(name[at]) & 0xC0U) != 0x80U;
  };
  for (std::size_t end = most; end + kLongestCharacter > most; --end) {
    if (begins(end)) return std::string(name.substr(0, end));
  }
  return std::string(name.substr(0, most));
}

std::vector<std::string> short_names(const Attribute& attribute,
                                     const std::set<std::string>& taken) {
  const std::size_t room = las_descriptor::kNameBytes - last_index(attribute).size();
  for (std::size_t n = 1;; ++n) {
    const std::string tail = n == 1 ? "" : fmt::format("_{}", n);
    auto names = with_indices(attribute, cut(attribute.name, room - tail.size()) + tail);
    const bool is_new = std::none_of(names.begin(), names.end(), [&](const std::string& name) {
      return taken.count(name) != 0;
    });
    if (is_new) return names;
  }
}

}  // namespace

std::vector<std::vector<std::string>> las_extra_names(std::span<const Attribute* const> attributes,
                                                      std::set<std::string> taken,
                                                      std::vector<std::string>& losses) {
  std::vector<std::vector<std::string>> all;
  for (const Attribute* attribute : attributes) {
    all.push_back(with_indices(*attribute, attribute->name));
    if (fits(*attribute)) taken.insert(all.back().begin(), all.back().end());
  }
  for (std::size_t a = 0; a < all.size(); ++a) {
    if (fits(*attributes[a])) continue;
    all[a] = short_names(*attributes[a], taken);
    taken.insert(all[a].begin(), all[a].end());
    const std::string last = all[a].size() > 1 ? " to " + all[a].back() : "";
    losses.push_back(fmt::format("the name of {}, which becomes {}{}: LAS has {} bytes for it",
                                 attributes[a]->name, all[a].front(), last,
                                 las_descriptor::kNameBytes));
  }
  return all;
}

}  // namespace pcednet::io
