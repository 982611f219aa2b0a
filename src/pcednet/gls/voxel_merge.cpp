#include "pcednet/gls/voxel_merge.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "pcednet/core/parallel.h"
#include "pcednet/spatial/morton.h"
#include "pcednet/spatial/radix_sort.h"

namespace pcednet::gls {
namespace {

using spatial::Keyed;

/// Sums of the points of one voxel, about a fixed place near them.
struct VoxelSums {
  Vec3 place = Vec3::Zero();
  double count = 0, qq = 0, qn = 0;
  Vec3 q = Vec3::Zero(), n = Vec3::Zero();

  void add(const Voxel& voxel) {
    if (count == 0) place = voxel.position;
    const Vec3 offset = voxel.position - place;
    const Vec3 normal(voxel.normal[0], voxel.normal[1], voxel.normal[2]);
    const double c = voxel.count;
    count += c;
    q += c * offset;
    n += c * normal;
    qq += c * (offset.squaredNorm() + voxel.qq);
    qn += c * (offset.dot(normal) + voxel.qn);
  }

  Voxel voxel() const {
    const Vec3 mean = q / count, normal = n / count;
    return {.position = place + mean,
            .normal = {static_cast<float>(normal.x()), static_cast<float>(normal.y()),
                       static_cast<float>(normal.z())},
            .count = static_cast<float>(count),
            .qq = static_cast<float>(std::max(0.0, qq / count - mean.squaredNorm())),
            .qn = static_cast<float>(qn / count - mean.dot(normal))};
  }
};

std::size_t dominant_axis(const std::array<float, 3>& n) {
  const float x = std::abs(n[0]), y = std::abs(n[1]), z = std::abs(n[2]);
  return x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
}

/// The cells of a level. Keys tell 2^20 cells along an axis apart; where there are more (points far
/// from all others), equal keys are followed by a look at the cells themselves.
class Grid {
 public:
  Grid(const std::vector<Voxel>& voxels, const Vec3& origin, double cell)
      : voxels_(&voxels), origin_(origin), inverse_cell_(1.0 / cell) {}

  /// The cell's place on the curve, then the axis of the normal.
  std::uint64_t key(std::size_t i) const {
    const std::array<std::uint64_t, 3> cell = cell_of(i);
    const auto wrapped = [&](std::size_t a) { return static_cast<std::uint32_t>(cell[a] & kMost); };
    const std::uint64_t place = spatial::morton_code({wrapped(0), wrapped(1), wrapped(2)});
    return place << 2 | dominant_axis((*voxels_)[i].normal);
  }

  /// The bits of a key, for coordinates within `side` of the origin.
  int key_bits(double side) const {
    return 2 + 3 * std::bit_width(static_cast<std::uint64_t>(
                       std::min(side * inverse_cell_ + 1.0, static_cast<double>(kMost))));
  }

  bool is_same_cell(std::size_t i, std::size_t j) const { return cell_of(i) == cell_of(j); }

 private:
  static constexpr std::uint64_t kMost = (1 << 20) - 1;

  std::array<std::uint64_t, 3> cell_of(std::size_t i) const {
    const Vec3 place = ((*voxels_)[i].position - origin_) * inverse_cell_;
    std::array<std::uint64_t, 3> cell;
    for (std::size_t a = 0; a < 3; ++a) {
      const double c = place[static_cast<Eigen::Index>(a)];
      cell[a] = static_cast<std::uint64_t>(std::clamp(c, 0.0, 0x1p62));
    }
    return cell;
  }

  const std::vector<Voxel>* voxels_;
  Vec3 origin_;
  double inverse_cell_;
};

/// Appends the voxels of one cell and axis, given its members in order: one per sign of the
/// normal's dominant component, the sign of the first member first, so that a flip of all normals
/// changes nothing but the signs. Members without a normal count for nothing.
void append_voxels(std::span<const Keyed> members, const std::vector<Voxel>& from,
                   std::vector<Voxel>& to) {
  VoxelSums same, opposite;
  const std::size_t axis = members.front().key & 3;
  bool first_sign = false;
  for (const Keyed& member : members) {
    const Voxel& voxel = from[member.index];
    if (voxel.count == 0.0f) continue;
    const bool sign = voxel.normal[axis] < 0.0f;
    if (same.count == 0) first_sign = sign;
    (sign == first_sign ? same : opposite).add(voxel);
  }
  if (same.count > 0) to.push_back(same.voxel());
  if (opposite.count > 0) to.push_back(opposite.voxel());
}

/// The voxels of the cells that begin within [begin, end).
std::vector<Voxel> merge_stretch(const std::vector<Voxel>& from, const Grid& grid,
                                 std::span<const Keyed> keyed, std::size_t begin, std::size_t end) {
  const auto continues = [&](std::size_t i) {
    return keyed[i].key == keyed[i - 1].key &&
           grid.is_same_cell(keyed[i].index, keyed[i - 1].index);
  };
  std::vector<Voxel> to;
  to.reserve((end - begin) / 2);
  while (begin > 0 && begin < end && continues(begin)) ++begin;
  while (begin < end) {
    std::size_t last = begin + 1;
    while (last < keyed.size() && continues(last)) ++last;
    append_voxels(keyed.subspan(begin, last - begin), from, to);
    begin = last;
  }
  return to;
}

}  // namespace

std::vector<Voxel> merge_voxels(const std::vector<Voxel>& from, const Vec3& origin, double side,
                                double cell) {
  constexpr std::size_t kStretch = 1 << 14;
  const Grid grid(from, origin, cell);
  std::vector<Keyed> keyed(from.size());
  parallel_blocks(from.size(), kStretch, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      keyed[i] = {grid.key(i), static_cast<std::uint32_t>(i)};
    }
  });
  spatial::sort_by_key(keyed, grid.key_bits(side));

  std::vector<std::vector<Voxel>> stretches((keyed.size() + kStretch - 1) / kStretch);
  parallel_blocks(keyed.size(), kStretch, [&](std::size_t begin, std::size_t end) {
    stretches[begin / kStretch] = merge_stretch(from, grid, keyed, begin, end);
  });
  keyed = {};
  std::size_t count = 0;
  for (const auto& stretch : stretches) count += stretch.size();
  std::vector<Voxel> to;
  to.reserve(count);
  for (auto& stretch : stretches) {
    to.insert(to.end(), stretch.begin(), stretch.end());
    stretch = {};
  }
  return to;
}

double mean_merge(const std::vector<Voxel>& from, const Vec3& origin, double cell) {
  constexpr std::size_t kStretch = 1024, kStep = 16 * kStretch;
  const Grid grid(from, origin, cell);
  double points = 0, squares = 0;
  std::vector<std::pair<std::uint64_t, float>> members;
  for (std::size_t begin = 0; begin < from.size(); begin += kStep) {
    members.clear();
    for (std::size_t i = begin; i < std::min(from.size(), begin + kStretch); ++i) {
      members.emplace_back(grid.key(i), from[i].count);
    }
    std::sort(members.begin(), members.end());
    for (std::size_t i = 0; i < members.size();) {
      std::size_t last = i;
      double count = 0;
      for (; last < members.size() && members[last].first == members[i].first; ++last) {
        count += members[last].second;
      }
      points += count;
      squares += count * static_cast<double>(last - i);
      i = last;
    }
  }
  return points > 0 ? squares / points : 1.0;
}

}  // namespace pcednet::gls
