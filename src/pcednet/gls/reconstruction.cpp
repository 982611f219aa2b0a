#include "pcednet/gls/reconstruction.h"

#include <algorithm>
#include <array>

namespace pcednet::gls {

std::span<const std::string_view> reconstruction_names() {
  static constexpr std::array<std::string_view, 4> kNames = {"covariance-plane", "plane-mls",
                                                             "sphere", "sphere-mls"};
  return kNames;
}

std::string_view name_of(Reconstruction reconstruction) {
  return reconstruction_names()[static_cast<std::size_t>(reconstruction)];
}

std::optional<Reconstruction> reconstruction_of(std::string_view name) {
  const auto names = reconstruction_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Reconstruction>(found - names.begin());
}

}  // namespace pcednet::gls
