#pragma once

#include "pcednet/core/vec3.h"
#include "pcednet/gls/fit_status.h"
#include "pcednet/gls/moments.h"

namespace pcednet::gls {

/// The zero set of S(y) = uc + ul.y + uq |y|^2, y relative to the evaluation point x: a sphere, or
/// a plane where uq = 0.
struct AlgebraicSphere {
  double uc = 0.0;
  Vec3 ul = Vec3::Zero();
  double uq = 0.0;
  double pratt = 1.0;  ///< sqrt(|ul|^2 - 4 uc uq), the gradient's length on the surface
};

struct SphereFit {
  FitStatus status = FitStatus::kUndefined;
  AlgebraicSphere sphere;
  double a = 0.0;  ///< A = PN - P.N/W
  double b = 0.0;  ///< B = PP - P.P/W; 0 in the plane limit, see fit_sphere()
};

/// The algebraic sphere whose gradients match the normals best (APSS):
///
///     uq = A / 2B     ul = (N - 2 uq P) / W     uc = -(ul.P + uq PP) / W
///
/// Neighbours within a millionth of t of each other (B <= 1e-12 t^2 W: duplicates) determine no
/// curvature; then uq = 0 and the surface is the plane through them with their mean normal.
/// Undefined with fewer than 3 neighbours, and where the normals cancel: |ul| or pratt, otherwise
/// about 1, is below 1e-4 and the direction is meaningless.
SphereFit fit_sphere(const Moments& moments, std::uint32_t count, double t);

/// The derivative of a sphere with respect to t or to one coordinate of x, in the moving frame.
struct SphereDerivative {
  double uc = 0.0;
  Vec3 ul = Vec3::Zero();
  double uq = 0.0;
  double sq_pratt = 0.0;
};

/// Differentiates `fit`, made from `moments`, along the moments' derivative `d`:
///
///     dA  = dPN - (N.dP + P.dN)/W + (P.N) dW/W^2     dB = dPP - 2 P.dP/W + (P.P) dW/W^2
///     duq = (dA B - A dB) / 2B^2                     (0 in the plane limit)
///     dul = (dN - ul dW - 2 (uq dP + P duq)) / W
///     duc = -(P.dul + ul.dP + PP duq + uq dPP + uc dW) / W
///     dpratt^2 = 2 ul.dul - 4 uq duc - 4 uc duq
///
/// `fit` must not be undefined.
SphereDerivative differentiate(const SphereFit& fit, const Moments& moments, const Moments& d);

}  // namespace pcednet::gls
