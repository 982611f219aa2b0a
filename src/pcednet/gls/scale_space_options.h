#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pcednet/core/vec3.h"
#include "pcednet/gls/features.h"
#include "pcednet/gls/reconstruction.h"

namespace pcednet::gls {

inline constexpr int kMinScales = 4, kMaxScales = 128;

inline constexpr double kPartOfDiagonal = 0.1;

/// How a scale-space matrix is computed.
enum class Engine {
  kFast,   ///< from a voxel pyramid, in single precision
  kExact,  ///< from exact neighbourhoods, in double precision
};

/// The smallest and the largest scale, as lengths, or how a cloud's own are found.
struct ScaleRange {
  double s_min = 0.0, s_max = 0.0;          ///< 0: from the cloud
  double s_max_fraction = kPartOfDiagonal;  ///< of the diagonal, where s_max is 0
  double s_max_ratio = 0.0;                 ///< if not 0 while s_max is 0: s_max over s_min
  bool octaves = false;  ///< with a ratio: larger scales where the spacing of a cloud is wider
  bool rounded = true;   ///< with a ratio: an s_min of the cloud is a preferred number

  bool operator==(const ScaleRange&) const = default;
};

struct ScaleSpaceOptions {
  int scales = 16;  ///< a power of two, 4 to 128
  ScaleRange range = {};
  FeatureSet features = FeatureSet::kPaper6;
  Reconstruction reconstruction = Reconstruction::kSphere;
  int max_projection_steps = 5;  ///< for the reconstructions that project
  std::optional<double>
      side_gate;  ///< the a of side_gate(), -1 to 1; without one all count equally
  std::optional<double> second_gate;  ///< features with this gate follow those with the first
  Engine engine = Engine::kFast;      ///< used by ScaleSpace
  double eps = 0.10;  ///< voxel edge over support radius, 0.01 to 1; fast engine only

  bool operator==(const ScaleSpaceOptions&) const = default;
};

/// The column names of a matrix for one scale; those of the second gate begin with "second_".
std::vector<std::string> column_names(const ScaleSpaceOptions& options);

/// The number of column_names().
int column_count(const ScaleSpaceOptions& options);

/// The gates to describe with: one, which may be open, or two.
std::vector<std::optional<double>> gates_of(const ScaleSpaceOptions& options);

/// A sentence for the user if the cloud is too sparse for the usual scales; otherwise empty.
std::string note_on(const ScaleSpaceOptions& options, std::span<const double> scales,
                    std::span<const Vec3> positions);

/// All options that determine the description of a given cloud, as text: for cache keys.
std::string text_of(const ScaleSpaceOptions& options);

}  // namespace pcednet::gls
