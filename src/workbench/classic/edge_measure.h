#pragma once

#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/core/vec3.h"

namespace pcednet::classic {

/// The surface variation of Pauly, Gross and Kobbelt 2002 at every position:
///
///     sigma = l0 / (l0 + l1 + l2),   l0 <= l1 <= l2 the eigenvalues of
///     C = 1/k sum (p_j - m)(p_j - m)^T,   m = 1/k sum p_j
///
/// over the `neighbours` nearest points, including the point itself. From 0 (plane) to 1/3
/// (isotropic); 0 where all neighbours coincide, NaN where the position is not finite.
/// The same for any number of threads and any order of the points. Throws Error(kUsage) for fewer
/// than 4 neighbours, Error(kInsufficient) for fewer finite points than neighbours.
std::vector<double> surface_variation(std::span<const Vec3> positions, int neighbours,
                                      const Progress* progress = nullptr);

// Methods without training: a measure per point, and edges where it exceeds a threshold.

/// A point whose value exceeds the threshold is on an edge; NaN where the measure is undefined.
struct EdgeMeasure {
  std::vector<double> values;
  double threshold = 0.0;
};

struct CovarianceAnalysisOptions {
  int neighbours = 10;      ///< including the point itself
  double threshold = 0.65;  ///< in units of twice the standard deviation over the cloud
};

/// Covariance analysis (Bazazian, Casas, Ruiz-Hidalgo 2015) as run in the comparison of Himeur et
/// al. 2021: surface_variation() above threshold * 2 s, s its standard deviation over the cloud.
/// This reproduces their published output (docs/classic.md). Throws as surface_variation() does,
/// and Error(kUsage) for a negative threshold.
EdgeMeasure covariance_analysis(std::span<const Vec3> positions,
                                const CovarianceAnalysisOptions& options = {},
                                const Progress* progress = nullptr);

struct MultiScaleOptions {
  std::vector<int> neighbours = {
      12, 24, 48, 96};      ///< ascending; those above the size of the cloud are left out
  double threshold = 0.06;  ///< of surface variation
};

/// Multi-scale surface variation (after Pauly, Keiser, Gross 2003): the median over several
/// neighbourhoods, which suppresses noise that shows only at the smallest.
EdgeMeasure multi_scale_variation(std::span<const Vec3> positions,
                                  const MultiScaleOptions& options = {},
                                  const Progress* progress = nullptr);

}  // namespace pcednet::classic
