#include <algorithm>
#include <cmath>

#include "pcednet/io/drawing/drawing.h"

namespace pcednet::io {
namespace {

constexpr NamedUnit kUnits[] = {
    {"none", LengthUnit::kNone, 0.0, 0},
    {"mm", LengthUnit::kMillimetre, 0.001, 4},
    {"cm", LengthUnit::kCentimetre, 0.01, 5},
    {"m", LengthUnit::kMetre, 1.0, 6},
    {"in", LengthUnit::kInch, 0.0254, 1},
    {"ft", LengthUnit::kFoot, 0.3048, 2},
    {"us-ft", LengthUnit::kUsSurveyFoot, 1200.0 / 3937.0, 21},
};

/// Definitions round the US survey foot, which is .6 millionths longer than the foot.
constexpr double kRounding = 1e-7;

}  // namespace

std::span<const NamedUnit> length_units() {
  return kUnits;
}

LengthUnit unit_of(const CoordinateSystem& system) {
  const auto found = std::ranges::find_if(kUnits, [&](const NamedUnit& unit) {
    return std::abs(unit.metres - system.unit) <= kRounding * unit.metres;
  });
  return found == std::end(kUnits) ? LengthUnit::kNone : found->unit;
}

}  // namespace pcednet::io
