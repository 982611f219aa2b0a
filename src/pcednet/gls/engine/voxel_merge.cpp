#include "pcednet/gls/engine/voxel_merge.h"

#include <algorithm>
#include <limits>

#include "pcednet/core/parallel.h"
#include "pcednet/core/parallel_loops.h"
#include "pcednet/core/prefetch.h"
#include "pcednet/gls/engine/normal_spread.h"
#include "pcednet/gls/engine/voxel_grid.h"
#include "pcednet/spatial/radix_sort.h"

namespace pcednet::gls {
namespace {

using spatial::Keyed;

constexpr std::size_t kStretch = 1 << 14;  // members planned, merged or forecast together

// filling() from which a block is merged further: 18 cells with normals of every direction.
constexpr double kFillsSpace = 4.0;
constexpr std::size_t kFewestToFill = 18;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

Vec3 vector_of(const MeanNormal& normal) {
  return {normal[0], normal[1], normal[2]};
}

/// Sums of the points of one voxel, about a fixed place near them.
struct VoxelSums {
  Vec3 place = Vec3::Zero();
  double count = 0, qq = 0, qn = 0;
  Vec3 q = Vec3::Zero(), n = Vec3::Zero();

  void add(const Voxel& voxel) {
    if (count == 0) place = voxel.position;
    const Vec3 offset = voxel.position - place, normal = vector_of(voxel.normal);
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

/// Assigns each member of a block to a voxel, numbered along the curve. For two signs in one place,
/// that of the first member comes first, so that a flip of all normals changes only the signs.
/// Members without a normal are ignored.
class BlockPlan {
 public:
  BlockPlan(VoxelSpan from, const VoxelGrid& grid, Crowd crowd)
      : from_(from), grid_(&grid), crowd_(crowd) {}

  /// The voxel of each of `members`, sorted by key.
  std::span<const std::uint32_t> plan(std::span<const Keyed> members) {
    members_ = members;
    voxel_of_.resize(members.size());
    if (crowd_ == Crowd::kKeep || filling() < kFillsSpace) {
      number_by_axis(kAxisBits);
    } else if (crowd_ == Crowd::kMergeByAxis) {
      number_by_axis(kGatedBits);
    } else {
      number_by_place();
    }
    return voxel_of_;
  }

  /// The number of voxels in the block last planned.
  std::size_t count() const { return count_; }

  /// MergeForecast::filling of that block: how little it resembles a surface.
  double filling() const {
    if (members_.size() < kFewestToFill) return 0.0;
    NormalSpread spread;
    std::size_t occupied = 0;
    for_cells(kAxisBits, [&](std::size_t begin, std::size_t end) {
      bool is_empty = true;
      for (std::size_t i = begin; i < end; ++i) {
        spread.add(vector_of(normal(i)), count(i));
        is_empty = is_empty && count(i) == 0.0f;
      }
      occupied += is_empty ? 0 : 1;
    });
    return static_cast<double>(occupied) * spread.mean_sq_volume();
  }

 private:
  const MeanNormal& normal(std::size_t i) const { return from_.normal(members_[i].index); }
  float count(std::size_t i) const { return from_.count(members_[i].index); }

  /// Calls `use(begin, end)` for the members of every cell, or cube of cells.
  template <typename Use>
  void for_cells(int bits, Use&& use) const {
    for (std::size_t begin = 0, end; begin < members_.size(); begin = end) {
      end = begin + 1;
      while (end < members_.size() && grid_->are_together(members_[end - 1], members_[end], bits)) {
        ++end;
      }
      use(begin, end);
    }
  }

  /// One voxel per cell, axis and sign.
  void number_by_axis(int bits) {
    count_ = 0;
    for_cells(bits, [&](std::size_t begin, std::size_t end) {
      std::uint32_t number[3][2] = {{kNone, kNone}, {kNone, kNone}, {kNone, kNone}};
      for (std::size_t i = begin; i < end; ++i) {
        voxel_of_[i] = kNone;
        if (count(i) == 0.0f) continue;
        const std::size_t axis = members_[i].key & 3;
        std::uint32_t& mine = number[axis][normal(i)[axis] < 0.0f];
        if (mine == kNone) mine = count_++;
        voxel_of_[i] = mine;
      }
    });
  }

  /// kBlockVoxels voxels a side.
  void number_by_place() {
    count_ = 0;
    std::array<std::uint32_t, kBlockVoxels * kBlockVoxels * kBlockVoxels> number;
    number.fill(kNone);
    for (std::size_t i = 0; i < members_.size(); ++i) {
      voxel_of_[i] = kNone;
      if (count(i) == 0.0f) continue;
      std::uint32_t& mine = number[grid_->place_in_block(members_[i].index)];
      if (mine == kNone) mine = count_++;
      voxel_of_[i] = mine;
    }
  }

  VoxelSpan from_;
  const VoxelGrid* grid_;
  Crowd crowd_;
  std::span<const Keyed> members_;
  std::vector<std::uint32_t> voxel_of_;
  std::uint32_t count_ = 0;
};

/// The voxels with their keys, along the curve: by cube, and by key within.
UnsetArray<Keyed> along_curve(VoxelSpan from, const VoxelGrid& grid) {
  UnsetArray<Keyed> keyed(from.size());
  const auto set_keys = [&](const auto& key_of) {
    parallel_for_each(keyed.size(), [&](std::size_t i) { keyed[i].key = key_of(keyed[i].index); });
  };
  parallel_for_each(keyed.size(), [&](std::size_t i) {
    keyed[i] = {grid.key(i), static_cast<std::uint32_t>(i)};
  });
  spatial::sort_by_key(keyed, grid.key_bits());
  if (grid.has_cubes()) {
    set_keys([&](std::uint32_t i) { return grid.cube(i); });
    spatial::sort_by_key(keyed, 63);
    set_keys([&](std::uint32_t i) { return grid.key(i); });
  }
  return keyed;
}

/// Asks for the voxel of a later one of `members`, Keyed or Assigned.
template <typename Members>
void ask_ahead(VoxelSpan from, const Members& members, std::size_t i) {
  if (i + kAskAhead < members.size()) from.prefetch(members[i + kAskAhead].index);
}

/// Calls `use(members, voxel_of, plan)` for every block of `keyed`, which begins and ends with one.
template <typename Use>
void for_blocks(VoxelSpan from, const VoxelGrid& grid, Crowd crowd, std::span<const Keyed> keyed,
                Use&& use) {
  BlockPlan plan(from, grid, crowd);
  for (std::size_t begin = 0, end; begin < keyed.size(); begin = end) {
    ask_ahead(from, keyed, begin);
    for (end = begin + 1; end < keyed.size(); ++end) {
      if (!grid.are_together(keyed[end - 1], keyed[end], kBlockBits)) break;
      ask_ahead(from, keyed, end);
    }
    const auto members = keyed.subspan(begin, end - begin);
    const std::span<const std::uint32_t> voxel_of = plan.plan(members);
    use(members, voxel_of, plan);
  }
}

/// Where the stretches begin that threads merge by themselves, and the end: every `length` members,
/// or where the next block does.
std::vector<std::size_t> stretches_of(std::span<const Keyed> keyed, const VoxelGrid& grid,
                                      std::size_t length) {
  std::vector<std::size_t> starts((keyed.size() + length - 1) / length + 1, keyed.size());
  for (std::size_t s = starts.size() - 1; s-- > 0;) {
    const std::size_t last = std::min((s + 1) * length, keyed.size());
    std::size_t start = s * length;
    while (start > 0 && start < last &&
           grid.are_together(keyed[start - 1], keyed[start], kBlockBits)) {
      ++start;
    }
    starts[s] = start < last ? start : starts[s + 1];
  }
  return starts;
}

/// A voxel to merge, and the number within its block of the voxel that it becomes part of, or
/// kNone.
struct Assigned {
  std::uint32_t index, voxel;
};

/// How a stretch becomes voxels.
struct StretchPlan {
  struct Block {
    std::uint32_t members, voxels;
  };
  std::vector<Block> blocks;  ///< along the curve
  std::size_t voxels = 0;     ///< of all blocks
};

/// Plans the blocks of `keyed`, and writes their members to `to`.
StretchPlan plan_stretch(VoxelSpan from, const VoxelGrid& grid, Crowd crowd,
                         std::span<const Keyed> keyed, Assigned* to) {
  StretchPlan stretch;
  for_blocks(from, grid, crowd, keyed,
             [&](std::span<const Keyed> members, std::span<const std::uint32_t> voxel_of,
                 const BlockPlan& plan) {
               stretch.blocks.push_back({static_cast<std::uint32_t>(members.size()),
                                         static_cast<std::uint32_t>(plan.count())});
               stretch.voxels += plan.count();
               for (std::size_t i = 0; i < members.size(); ++i) {
                 *to++ = {members[i].index, voxel_of[i]};
               }
             });
  return stretch;
}

/// Writes the voxels of a planned stretch from number `first` on.
void merge_stretch(VoxelSpan from, const StretchPlan& stretch, std::span<const Assigned> members,
                   VoxelArray& to, std::size_t first) {
  std::vector<VoxelSums> sums;
  std::size_t i = 0;
  for (const StretchPlan::Block& block : stretch.blocks) {
    sums.assign(block.voxels, {});
    for (const std::size_t end = i + block.members; i < end; ++i) {
      ask_ahead(from, members, i);
      if (members[i].voxel != kNone) sums[members[i].voxel].add(from[members[i].index]);
    }
    for (const VoxelSums& sum : sums) to.set(first++, sum.voxel());
  }
}

/// MergeForecast, each number summed over `points`.
struct ForecastSums {
  double points = 0, merged = 0, filling = 0;
};

/// The forecast for the points of the voxels [begin, end), as if there were no others.
ForecastSums forecast_stretch(VoxelSpan from, const VoxelGrid& grid, Crowd crowd, std::size_t begin,
                              std::size_t end) {
  std::vector<Keyed> keyed;
  keyed.reserve(end - begin);
  for (std::size_t i = begin; i < end; ++i) {
    keyed.push_back({grid.key(i), static_cast<std::uint32_t>(i)});
  }
  std::sort(keyed.begin(), keyed.end(), [](const Keyed& a, const Keyed& b) {
    return a.key != b.key ? a.key < b.key : a.index < b.index;
  });
  ForecastSums sums;
  std::vector<double> merged, count;
  for_blocks(from, grid, crowd, keyed,
             [&](std::span<const Keyed> members, std::span<const std::uint32_t> voxel_of,
                 const BlockPlan& plan) {
               const double filling = crowd == Crowd::kKeep ? plan.filling() : 0.0;
               merged.assign(plan.count(), 0.0), count.assign(plan.count(), 0.0);
               for (std::size_t i = 0; i < members.size(); ++i) {
                 if (voxel_of[i] == kNone) continue;
                 merged[voxel_of[i]] += 1.0;
                 count[voxel_of[i]] += from.count(members[i].index);
               }
               for (std::size_t v = 0; v < plan.count(); ++v) {
                 sums.points += count[v];
                 sums.merged += count[v] * merged[v];
                 sums.filling += count[v] * filling;
               }
             });
  return sums;
}

/// The forecast for the points of the first `length` of every `step` voxels.
struct Sampling {
  std::size_t length, step;
};
ForecastSums forecast_samples(VoxelSpan from, const VoxelGrid& grid, Crowd crowd,
                              Sampling sampling) {
  const auto [length, step] = sampling;
  std::vector<ForecastSums> samples((from.size() + step - 1) / step);
  parallel_blocks(from.size(), step,
                  [&, length = length, step = step](std::size_t begin, std::size_t end) {
                    samples[begin / step] =
                        forecast_stretch(from, grid, crowd, begin, std::min(end, begin + length));
                  });
  ForecastSums sums;
  for (const ForecastSums& sample : samples) {
    sums.points += sample.points;
    sums.merged += sample.merged, sums.filling += sample.filling;
  }
  return sums;
}

}  // namespace

VoxelArray merge_voxels(VoxelSpan from, const MergeCells& cells) {
  const VoxelGrid grid(from, cells);
  UnsetArray<Keyed> keyed = along_curve(from, grid);
  const std::vector<std::size_t> starts = stretches_of(keyed, grid, kStretch);
  const auto stretch = [&](auto& of, std::size_t s) {
    return std::span(of).subspan(starts[s], starts[s + 1] - starts[s]);
  };
  UnsetArray<Assigned> members(from.size());
  std::vector<StretchPlan> plans(starts.size() - 1);
  parallel_blocks(plans.size(), 1, [&](std::size_t s, std::size_t) {
    plans[s] = plan_stretch(from, grid, cells.crowd, stretch(keyed, s), members.data() + starts[s]);
  });
  keyed = {};  // before the voxels take their memory
  std::vector<std::size_t> first(starts.size());
  for (std::size_t s = 0; s < plans.size(); ++s) first[s + 1] = first[s] + plans[s].voxels;
  VoxelArray to = VoxelArray::of_voxels(first.back());
  parallel_blocks(plans.size(), 1, [&](std::size_t s, std::size_t) {
    merge_stretch(from, plans[s], stretch(members, s), to, first[s]);
  });
  return to;
}

MergeForecast forecast_merge(VoxelSpan from, const MergeCells& cells) {
  const VoxelGrid grid(from, cells);
  // Clumps far from each other may differ.
  const std::size_t step = grid.has_cubes() ? kStretch : 16 * kStretch;
  const ForecastSums sums = forecast_samples(from, grid, cells.crowd, {kStretch, step});
  if (sums.points == 0) return {};
  return {.merged = sums.merged / sums.points, .filling = sums.filling / sums.points};
}

double least_merged(VoxelSpan from, const MergeCells& cells) {
  const ForecastSums sums =
      forecast_samples(from, VoxelGrid(from, cells), cells.crowd, {kStretch / 16, kStretch});
  return sums.points == 0 ? 1.0 : sums.merged / sums.points;
}

}  // namespace pcednet::gls
