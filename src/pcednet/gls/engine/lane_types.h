#pragma once

#include <cstddef>
#include <cstdint>

namespace pcednet::gls {

/// Targets that one call of a kernel serves, one per vector lane.
inline constexpr std::size_t kLanes = 16;

/// One point or voxel of the neighbourhood, in the frame of its block and in units of the support
/// radius.
struct Source {
  float x, y, z;     ///< mean position
  float nx, ny, nz;  ///< mean normal, not renormalised
  float count;       ///< points it stands for
  float qq;          ///< mean |q|^2 of its points about their mean position
  float qn;          ///< mean q.n likewise
};

/// A box in the frame of the sources.
struct SourceBox {
  float min[3], max[3];
};

/// A box that holds some normals.
struct NormalBox {
  float middle[3], half[3];
};

/// Candidate sources: their numbers and, for the test of reach, their positions again.
struct Candidates {
  float *x, *y, *z;
  std::uint32_t* index;
  std::size_t count;
};

struct LaneTargets {
  float x[kLanes], y[kLanes], z[kLanes];     ///< evaluation points, in the sources' frame
  float nx[kLanes], ny[kLanes], nz[kLanes];  ///< their normals, used by the gate alone
};

/// The gate of side-aware neighbourhoods, see side_gate().
struct LaneGate {
  bool enabled = false;
  float threshold = 0.0f;
};

/// The sources of a neighbourhood by number: those that let every gate open for every target, and
/// the rest, whose gates are evaluated. Without a gate all are open.
struct LaneSources {
  const Source* all;
  const std::uint32_t *open, *rest;
  std::size_t open_count, rest_count;
  bool points;  ///< all are single points with normals
};

/// The sums of a neighbourhood over u = gate count (1 - r^2) and over w = u (1 - r^2), support
/// radius 1 and r^2 = |y|^2 + qq, from which the moments of the sphere fit and all their first
/// derivatives follow:
///
///     t dw/dt = 4 (u - w)    t dw/dx = 4 u y    S w = S u - S u r^2    S w y = S u y - S u r^2 y
///
/// One row of kLanes targets per sum.
struct LaneSums {
  float u[kLanes], uy[3][kLanes], un[3][kLanes], uyn[kLanes], uyy[kLanes];
  float wn[3][kLanes], wyn[kLanes], wyy[kLanes];
  float u_y_y[6][kLanes];     ///< S u y y^T: xx xy xz yy yz zz
  float u_n_y[3][3][kLanes];  ///< S u n y^T
  float u_yn_y[3][kLanes];    ///< S u (y.n) y
  float u_yy_y[3][kLanes];    ///< S u r^2 y
};

/// The same sums over sources that are inside the support of every target of interest, as
/// polynomials in the place of the target: sums of products of p, the source's position about a
/// centre among the targets, rho = |p|^2 + qq, and the weights count {1, n, p.n + qn}.
struct InsideSums {
  static constexpr int kWeights = 5;
  float centre[3];              ///< in the sources' frame
  float moments[kWeights][15];  ///< 1, p (3), p p^T (6), rho, rho p (3), rho^2
  float higher[20];  ///< with weight count: rho p p^T (6), p p p (10: xxx xxy xxz xyy xyz xzz yyy
                     ///< yyz yzz zzz), rho^2 p (3), rho^3
};

/// How many points are neighbours: of those counted in `maybe` but not in `surely`, rounding leaves
/// open whether they are.
struct LaneCounts {
  float surely[kLanes], maybe[kLanes];
};

/// The verdict of single precision on a fit.
inline constexpr float kSound = 1.0f;
inline constexpr float kDoubtful = 0.0f;  ///< rounding may have spoilt it
inline constexpr float kVoid = -1.0f;     ///< its normals cancel beyond doubt: it is undefined

/// What is known of each lane's target, in units of the support radius.
struct LaneFits {
  float verdict[kLanes];                                       ///< kSound, kDoubtful or kVoid
  float uc[kLanes], ul[3][kLanes], uq[kLanes], pratt[kLanes];  ///< the sphere
  float features[28][kLanes];  ///< in the order of FeatureSet::kAll28
};

/// How many of the features are wanted.
enum class LaneDetail {
  kRelief,     ///< tau dtau phi alone
  kInvariant,  ///< the first seven
  kAll,
};

/// The vector code of one instruction set.
struct LaneKernels {
  const char* name;
  /// Writes the candidates of `in` nearer than `reach` to `box` to `out`, which has room for all
  /// and kLanes more; `in` is readable for kLanes more. Without positions where out.x is null.
  void (*select)(const Candidates& in, const SourceBox& box, float reach, Candidates& out);
  /// As select(), but moves those whose every point of `box` is nearer than `inner` to `inside`.
  void (*split)(const Candidates& in, const SourceBox& box, float reach, float inner,
                Candidates& out, Candidates& inside);
  /// Moves those of indices[0 .. count) whose normal has a cosine of `least` or more to every
  /// normal in the box to `open`, which may be `indices`, and the others to `rest`; returns how
  /// many are open.
  std::size_t (*part_open)(const Source* sources, const std::uint32_t* indices, std::size_t count,
                           const NormalBox& normals, float least, std::uint32_t* open,
                           std::uint32_t* rest);
  /// Sums for each of up to two gates, all enabled; for none, sums[0]. With two gates each has the
  /// same bits as alone.
  void (*sum)(const LaneSources& sources, const LaneTargets& targets, const LaneGate* gates,
              std::size_t gate_count, LaneSums* sums);
  /// Sums over sources[indices[0 .. count)) about sums.centre.
  void (*sum_inside)(const Source* sources, const std::uint32_t* indices, std::size_t count,
                     InsideSums& sums);
  /// Adds to `sums` what these sources contribute at the targets, the gate open.
  void (*add_inside)(const InsideSums& inside, const LaneTargets& targets, LaneSums& sums);
  void (*count)(const Source* sources, const std::uint32_t* indices, std::size_t count,
                const LaneTargets& targets, const LaneGate& gate, LaneCounts& counts);
  /// Fits the spheres; `rounding` is how far rounding may have moved each sum, relative to the sum
  /// of the sizes of its terms.
  void (*solve)(const LaneSums& sums, LaneDetail detail, float rounding, LaneFits& fits);
};

/// Of lane_kernels_*.cpp; the last two on x86-64 alone.
extern const LaneKernels lane_kernels_baseline, lane_kernels_avx2, lane_kernels_avx512;

}  // namespace pcednet::gls
