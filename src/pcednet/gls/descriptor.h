#pragma once

#include <span>

#include "pcednet/core/vec3.h"
#include "pcednet/gls/features.h"
#include "pcednet/gls/moments.h"
#include "pcednet/gls/sphere_fit.h"

namespace pcednet::gls {

/// The geometry of the surface reconstructed at scale t, seen from x: its parameters and their
/// derivatives in scale and space, in the units of the cloud. Zero throughout when undefined.
struct Descriptor {
  double tau = 0.0;  ///< local relief: algebraic distance of x, positive on the normals' side
  Vec3 eta = Vec3::Zero();    ///< unit normal at x
  double kappa = 0.0;         ///< mean curvature of the primitive; +1/R with outward normals
  double phi = 0.0;           ///< residual of the fit, in [0, 1]
  double k1 = 0.0, k2 = 0.0;  ///< signed principal curvatures of deta/dx, |k1| >= |k2|

  double dtau_dt = 0.0;
  Vec3 deta_dt = Vec3::Zero();
  double dkappa_dt = 0.0;
  Vec3 dtau_dx = Vec3::Zero();
  Mat3 deta_dx = Mat3::Zero();  ///< row i, column k: d eta_i / d x_k
  Vec3 dkappa_dx = Vec3::Zero();
};

/// Writes the features of `set`, made dimensionless by the support radius t: lengths are divided by
/// t, curvatures multiplied by t, derivatives in x or t by one more t. `out` has feature_count(set)
/// numbers.
void write_features(FeatureSet set, const Descriptor& descriptor, double t, std::span<double> out);

/// The description of `fit`, made from `moments.value`:
///
///     tau = uc/pratt    eta = ul/|ul|    kappa = 2 uq/pratt    phi = 1 - pratt^2
///     dtau   = dS/pratt - uc dpratt^2/(2 pratt^3)             dS = duc (+ ul_k for d/dx_k)
///     dkappa = 2 duq/pratt - uq dpratt^2/pratt^3
///     deta   = (I - eta eta^T)(dul (+ 2 uq e_k for d/dx_k)) / |ul|
Descriptor describe_sphere(const SphereFit& fit, const MomentSet& moments);

struct PrincipalCurvatures {
  double k1, k2;
};

/// The eigenvalues of the symmetric part of `deta_dx` restricted to the plane of the unit vector
/// `eta`, the larger in magnitude first. At equal magnitudes and opposite signs k1 has the sign of
/// `tie` (positive for 0), so that turning the normals negates both exactly.
PrincipalCurvatures principal_curvatures(const Mat3& deta_dx, const Vec3& eta, double tie);

}  // namespace pcednet::gls
