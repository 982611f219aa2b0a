#include "pcednet/detect/spread.h"

#include <cmath>
#include <numeric>

#include "pcednet/cloud/bounding_box.h"

namespace pcednet::detect {
namespace {

constexpr std::size_t kMostWhole = std::size_t{1} << 17;
constexpr double kCellsAlong = 0x1p26;

/// A quarter of all places, by the cells of a fine grid over the whole cloud: a part of it has the
/// same, and a point far from all others leaves the cells much smaller than the spacing.
class FirstPlaces {
 public:
  FirstPlaces(std::span<const Vec3> positions, const PartOfCloud* part) {
    const BoundingBox box = bounding_box(positions);
    corner_ = part ? part->pyramids.front().corner : box.min;
    per_length_ =
        kCellsAlong / (part ? part->pyramids.front().side : (box.max - box.min).maxCoeff());
  }

  bool hold(const Vec3& position) const {
    std::uint64_t bits = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double cell = std::floor((position[axis] - corner_[axis]) * per_length_);
      bits = (bits ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(cell))) *
             0x9e3779b97f4a7c15;  // 2^64 over the golden ratio
      bits ^= bits >> 32;
    }
    return bits % 4 == 0;
  }

 private:
  Vec3 corner_;
  double per_length_;
};

}  // namespace

std::vector<std::uint32_t> first_places(std::span<const Vec3> positions, const PartOfCloud* part) {
  std::vector<std::uint32_t> places(positions.size());
  std::iota(places.begin(), places.end(), 0u);
  if ((part ? part->points : places.size()) <= kMostWhole) return places;
  const FirstPlaces first(positions, part);
  std::erase_if(places, [&](std::uint32_t i) { return !first.hold(positions[i]); });
  return places;
}

}  // namespace pcednet::detect
