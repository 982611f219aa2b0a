#pragma once

#include <cstdint>
#include <span>

#include "pcednet/gls/descriptor.h"
#include "pcednet/gls/neighbourhood.h"
#include "pcednet/gls/sphere_fit.h"

namespace pcednet::gls {

struct CovariancePlane {
  AlgebraicSphere plane;  ///< uq = 0, ul = eta, pratt = 1
  FitStatus status = FitStatus::kUndefined;
  Descriptor descriptor;
};

/// The covariance plane of the neighbours, all closer than `t`, and its description.
///
/// With m the weighted mean and C = S w (y - m)(y - m)^T, the plane goes through m; its normal eta
/// is the eigenvector of the smallest eigenvalue of C, on the side of the mean normal. Then
///
///     tau = -eta.m    kappa = 0    phi = 3 lambda_0 / (lambda_0 + lambda_1 + lambda_2)
///
/// and the derivatives of tau and eta are exact: the weights are differentiated. kappa belongs to
/// the primitive, and a plane has none; k1 and k2 come from deta/dx as elsewhere and are the
/// curvatures of the surface that the planes envelop.
///
/// Undefined with fewer than 3 neighbours, where they are collinear, coincident or isotropic (the
/// smallest eigenvalue is not below the next by 1e-9 of the largest), and where the mean normal
/// lies in the plane.
CovariancePlane fit_covariance_plane(std::span<const LocalNeighbour> neighbours, double t);

}  // namespace pcednet::gls
