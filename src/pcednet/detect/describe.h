#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "pcednet/detect/acute_edge.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/cloud_kind.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/gls/engine/scale_space.h"

namespace pcednet::detect {

/// Points described at a time: enough to keep every thread busy, few enough for their rows to stay
/// in cache.
constexpr std::size_t kBlock = 16 * 1024;

/// The number of features per point: scales x columns.
std::size_t row_width(const gls::ScaleSpaceOptions& descriptor);

/// Describes `points` into `rows`, row_width() numbers each; scales without a fit are 0.
void describe(const gls::ScaleSpace& space, std::span<const std::uint32_t> points,
              std::span<float> rows, const Progress* progress = nullptr);

/// Describes every point with a finite position, or those wanted of a part of a cloud, a block at a
/// time: take(points, rows) gets points and their rows of row_width() numbers. Returns the scales,
/// as lengths, of the first octave. Throws as classify() does.
std::vector<double> describe_rows(const PreparedCloud& cloud,
                                  const gls::ScaleSpaceOptions& descriptor,
                                  const std::function<void(std::span<const std::uint32_t> points,
                                                           std::span<const float> rows)>& take,
                                  const Progress* progress = nullptr);

/// The whole scale-space matrix of a cloud, for classification by several networks.
struct DescribedCloud {
  std::size_t points = 0;                        ///< of the cloud
  std::vector<std::uint32_t> order = {};         ///< the point that each row describes
  std::vector<float> values = {};                ///< rows x scales x columns
  std::vector<double> scales = {};               ///< as lengths, of the first octave
  CloudTraits traits = {};                       ///< of the cloud
  std::vector<AcuteEdgePoint> acute_edges = {};  ///< find_acute_edges()
};

/// Describes every point with a finite position. Throws as classify() does.
DescribedCloud describe(const PreparedCloud& cloud, const gls::ScaleSpaceOptions& descriptor,
                        const Progress* progress = nullptr);

/// classify() for a cloud described as the model requires. Throws Error(kModelMismatch) if the rows
/// are not of the model's size, or the positions not those of the cloud.
Classification classify(const DescribedCloud& cloud, std::span<const Vec3> positions,
                        const EdgeModel& model, const Progress* progress = nullptr);

}  // namespace pcednet::detect
