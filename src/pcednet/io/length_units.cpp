#include "pcednet/io/length_units.h"

#include <algorithm>
#include <cmath>

namespace pcednet::io {
namespace {

constexpr LengthUnitEntry kUnits[] = {
    {LengthUnit::kNone, 0, "none", 0.0, 0, false},
    {LengthUnit::kMillimetre, 0, "mm", 0.001, 4, false},
    {LengthUnit::kCentimetre, 0, "cm", 0.01, 5, false},
    {LengthUnit::kMetre, 9001, "m", 1.0, 6, false},
    {LengthUnit::kInch, 0, "in", 0.0254, 1, true},
    {LengthUnit::kFoot, 9002, "ft", 0.3048, 2, true},
    {LengthUnit::kUsSurveyFoot, 9003, "us-ft", 1200.0 / 3937.0, 21, true},
};

/// Definitions round the US survey foot, which is two millionths longer than the foot.
constexpr double kRounding = 1e-7;

/// The first unit for which `is_it`; kNone if there is none.
template <typename Predicate>
LengthUnit first_unit(Predicate&& is_it) {
  const auto found = std::ranges::find_if(kUnits, is_it);
  return found == std::end(kUnits) ? LengthUnit::kNone : found->unit;
}

}  // namespace

std::span<const LengthUnitEntry> length_units() {
  return kUnits;
}

const LengthUnitEntry& entry_of(LengthUnit unit) {
  return *std::ranges::find(kUnits, unit, &LengthUnitEntry::unit);
}

LengthUnit unit_of_metres(double metres) {
  return first_unit([=](const LengthUnitEntry& entry) {
    return std::abs(entry.metres - metres) <= kRounding * entry.metres;
  });
}

LengthUnit unit_of_code(int epsg) {
  return first_unit([=](const LengthUnitEntry& entry) { return entry.epsg == epsg; });
}

}  // namespace pcednet::io
