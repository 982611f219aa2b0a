#pragma once

#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/core/vec3.h"

namespace pcednet::classic {

// Methods without training: a number per point, and edges where it is above a threshold.

/// A point whose value is larger than the threshold is on an edge; NaN where there is no answer.
struct EdgeMeasure {
  std::vector<double> values;
  double threshold = 0.0;
};

struct CovarianceAnalysisOptions {
  int neighbours = 10;      ///< the point itself among them
  double threshold = 0.65;  ///< in units of twice the standard deviation over the cloud
};

/// Covariance analysis (Bazazian, Casas, Ruiz-Hidalgo 2015) as the comparison of Himeur et al. 2021
/// ran it: surface_variation() above threshold * 2 s, s its standard deviation over the cloud
/// (found from their published output, which this repeats; see docs/classic.md). Throws what
/// surface_variation() throws, and Error(kUsage) for a negative threshold.
EdgeMeasure covariance_analysis(std::span<const Vec3> positions,
                                const CovarianceAnalysisOptions& options = {},
                                const Progress* progress = nullptr);

struct MultiScaleOptions {
  std::vector<int> neighbours = {12, 24, 48,
                                 96};  ///< rising; those the cloud is too small for are left out
  double threshold = 0.06;             ///< of surface variation
};

/// Multi-scale surface variation (after Pauly, Keiser, Gross 2003): the median over several
/// neighbourhoods, so that what shows at most scales counts and noise at the smallest does not.
EdgeMeasure multi_scale_variation(std::span<const Vec3> positions,
                                  const MultiScaleOptions& options = {},
                                  const Progress* progress = nullptr);

}  // namespace pcednet::classic
