#pragma once

#include <cstdint>

namespace pcednet::gls {

/// The reliability of a description. It depends only on the number of neighbours, unless the fit
/// fails altogether.
enum class FitStatus : std::uint8_t {
  kStable = 0,     ///< 6 neighbours or more
  kUnstable = 1,   ///< 3 to 5: usable
  kUndefined = 2,  ///< fewer, or they determine no surface: every feature is 0
};

constexpr FitStatus status_of_count(std::uint32_t neighbours) {
  if (neighbours < 3) return FitStatus::kUndefined;
  return neighbours < 6 ? FitStatus::kUnstable : FitStatus::kStable;
}

}  // namespace pcednet::gls
