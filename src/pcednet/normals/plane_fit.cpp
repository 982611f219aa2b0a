#include "pcednet/normals/plane_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "pcednet/core/eigendecomposition.h"
#include "pcednet/core/vector_clones.h"

namespace pcednet::normals {
namespace {

/// Second eigenvalue over the largest below which a neighbourhood is taken for a line: a width of
/// 1e-5 of the length.
constexpr double kLine = 1e-10;

/// Points at a time.
constexpr std::size_t kLanes = 8;
using Lane = double[kLanes];

/// Symmetric matrices.
struct Matrices {
  Lane xx = {}, xy = {}, xz = {}, yy = {}, yz = {}, zz = {};
};

/// The weighted covariances of neighbours that lie at `offsets` (x, y and z of each) from their
/// points.
PCEDNET_VECTOR_CLONES
void add_up(const Lane* offsets, std::size_t neighbours, Matrices& __restrict c) {
  Lane sq_radius, weights, sum_x = {}, sum_y = {}, sum_z = {};
  for (std::size_t i = 0; i < kLanes; ++i) {
    const Lane* const last = offsets + 3 * (neighbours - 1);
    const double x = last[0][i], y = last[1][i], z = last[2][i];
    sq_radius[i] = 1.05 * (x * x + y * y + z * z);
    weights[i] = 1.0;
  }
  for (std::size_t k = 0; k < neighbours; ++k) {
    const Lane* const offset = offsets + 3 * k;
    for (std::size_t i = 0; i < kLanes; ++i) {
      const double x = offset[0][i], y = offset[1][i], z = offset[2][i];
      const double falloff = 1.0 - (x * x + y * y + z * z) / sq_radius[i];
      const double weight = falloff * falloff;
      const double wx = weight * x, wy = weight * y, wz = weight * z;
      weights[i] += weight;
      sum_x[i] += wx, sum_y[i] += wy, sum_z[i] += wz;
      c.xx[i] += wx * x, c.xy[i] += wy * x, c.xz[i] += wz * x;
      c.yy[i] += wy * y, c.yz[i] += wz * y, c.zz[i] += wz * z;
    }
  }
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double x = sum_x[i], y = sum_y[i], z = sum_z[i], w = weights[i];
    c.xx[i] -= x * x / w, c.xy[i] -= x * y / w, c.xz[i] -= x * z / w;
    c.yy[i] -= y * y / w, c.yz[i] -= y * z / w, c.zz[i] -= z * z / w;
  }
}

/// Compares sums of products of eigenvalues, which have no rounding error to speak of where the
/// eigenvalues themselves, from the closed form, are good to 1e-8 of the largest only.
bool is_line(const Matrices& c, std::size_t i) {
  const double pairs = c.xx[i] * c.yy[i] - c.xy[i] * c.xy[i] + c.xx[i] * c.zz[i] -
                       c.xz[i] * c.xz[i] + c.yy[i] * c.zz[i] - c.yz[i] * c.yz[i];
  const double trace = c.xx[i] + (c.yy[i] + c.zz[i]);
  return !(pairs > kLine * trace * trace);
}

/// The terms of the closed form of the eigenvalues, for matrices shifted to a trace of 0 and scaled
/// to a largest entry of 1.
struct Cubic {
  Matrices m;
  Lane shift, scale, third, a, half_b, q;
};

/// Here and below the steps are those of Eigen's SelfAdjointEigenSolver::computeDirect().
PCEDNET_VECTOR_CLONES
void make_cubics(const Matrices& c, Cubic& __restrict cubic) {
  constexpr double kThird = 1.0 / 3.0;
  Matrices& m = cubic.m;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double shift = (c.xx[i] + (c.yy[i] + c.zz[i])) / 3.0;
    const double xx = c.xx[i] - shift, yy = c.yy[i] - shift, zz = c.zz[i] - shift;
    const double diagonal = larger(larger(std::fabs(xx), std::fabs(yy)), std::fabs(zz));
    const double rest = larger(larger(std::fabs(c.xy[i]), std::fabs(c.xz[i])), std::fabs(c.yz[i]));
    const double scale = larger(diagonal, rest), divisor = scale > 0.0 ? scale : 1.0;
    cubic.shift[i] = shift, cubic.scale[i] = scale;
    m.xx[i] = xx / divisor, m.yy[i] = yy / divisor, m.zz[i] = zz / divisor;
    m.xy[i] = c.xy[i] / divisor, m.xz[i] = c.xz[i] / divisor, m.yz[i] = c.yz[i] / divisor;
  }
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double xx = m.xx[i], xy = m.xy[i], xz = m.xz[i], yy = m.yy[i], yz = m.yz[i], zz = m.zz[i];
    const double c0 =
        xx * yy * zz + 2.0 * xy * xz * yz - xx * yz * yz - yy * xz * xz - zz * xy * xy;
    const double c1 = xx * yy - xy * xy + xx * zz - xz * xz + yy * zz - yz * yz;
    const double c2 = xx + yy + zz, third = c2 * kThird;
    const double a = larger((c2 * third - c1) * kThird, 0.0);
    const double half_b = 0.5 * (c0 + third * (2.0 * third * third - c1));
    cubic.third[i] = third, cubic.a[i] = a, cubic.half_b[i] = half_b;
    cubic.q[i] = larger(a * a * a - half_b * half_b, 0.0);
  }
}

struct Eigenvalues {
  Lane least, middle, largest;
};

void solve(const Cubic& cubic, Eigenvalues& e) {
  const double sqrt3 = std::sqrt(3.0);
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double rho = std::sqrt(cubic.a[i]);
    const double theta = std::atan2(std::sqrt(cubic.q[i]), cubic.half_b[i]) * (1.0 / 3.0);
    const double cos = std::cos(theta), sin = std::sin(theta);
    e.least[i] = cubic.third[i] - rho * (cos + sqrt3 * sin);
    e.middle[i] = cubic.third[i] - rho * (cos - sqrt3 * sin);
    e.largest[i] = cubic.third[i] + 2.0 * rho * cos;
  }
}

struct Vectors {
  Lane x, y, z, sq_length;
};

/// The eigenvectors of the eigenvalues `e`, of any length: crossed columns of m - e, the one with
/// the largest diagonal entry and the one that gives the longer product.
PCEDNET_VECTOR_CLONES
void find_kernels(const Matrices& m, const Lane& e, Vectors& __restrict v) {
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double xx = m.xx[i] - e[i], yy = m.yy[i] - e[i], zz = m.zz[i] - e[i];
    const double xy = m.xy[i], xz = m.xz[i], yz = m.yz[i];
    const double size_x = std::fabs(xx), size_y = std::fabs(yy), size_z = std::fabs(zz);
    const bool y_first = size_y > size_x, z_first = size_z > larger(size_x, size_y);
    // The chosen column p, the next, q, and the one after that.
    const auto chosen = [=](double x, double y, double z) { return z_first ? z : y_first ? y : x; };
    const double px = chosen(xx, xy, xz), qx = chosen(xy, xz, xx), rx = chosen(xz, xx, xy);
    const double py = chosen(xy, yy, yz), qy = chosen(yy, yz, xy), ry = chosen(yz, xy, yy);
    const double pz = chosen(xz, yz, zz), qz = chosen(yz, zz, xz), rz = chosen(zz, xz, yz);
    const double ax = py * qz - pz * qy, ay = pz * qx - px * qz, az = px * qy - py * qx;
    const double bx = py * rz - pz * ry, by = pz * rx - px * rz, bz = px * ry - py * rx;
    const double sq_a = ax * ax + ay * ay + az * az, sq_b = bx * bx + by * by + bz * bz;
    const bool first = sq_a > sq_b;
    v.x[i] = first ? ax : bx, v.y[i] = first ? ay : by, v.z[i] = first ? az : bz;
    v.sq_length[i] = first ? sq_a : sq_b;
  }
}

/// The eigenvector of the least eigenvalue where two are numerically the same.
Vec3 direction_of_doubtful(const Matrices& c, std::size_t i) {
  Mat3 covariance;
  covariance << c.xx[i], c.xy[i], c.xz[i], c.xy[i], c.yy[i], c.yz[i], c.xz[i], c.yz[i], c.zz[i];
  return eigendecomposition(covariance).vectors.col(0);
}

PlaneFit fit_of(const Matrices& c, const Cubic& cubic, const Eigenvalues& e, const Vectors& v,
                std::size_t i) {
  if (is_line(c, i)) return {};
  const double to_middle = e.middle[i] - e.least[i], from_middle = e.largest[i] - e.middle[i];
  const bool doubtful = e.largest[i] - e.least[i] <= std::numeric_limits<double>::epsilon() ||
                        (from_middle > to_middle && to_middle <= 0.0);
  const Vec3 direction = doubtful ? direction_of_doubtful(c, i)
                                  : Vec3(Vec3(v.x[i], v.y[i], v.z[i]) / std::sqrt(v.sq_length[i]));
  const double least = e.least[i] * cubic.scale[i] + cubic.shift[i];
  const double middle = e.middle[i] * cubic.scale[i] + cubic.shift[i];
  const double largest = e.largest[i] * cubic.scale[i] + cubic.shift[i];
  return {direction.normalized(), std::max(least, 0.0) / std::max(middle, 0.0), middle / largest};
}

}  // namespace

void fit_planes(std::span<const Vec3> points, std::span<const std::uint32_t> some,
                std::span<const std::uint32_t> neighbours, std::span<PlaneFit> fits) {
  const std::size_t degree = some.empty() ? 0 : neighbours.size() / some.size();
  if (degree < 2) {
    std::fill(fits.begin(), fits.end(), PlaneFit{});
    return;
  }
  const auto offsets = std::make_unique<Lane[]>(3 * degree);
  for (std::size_t first = 0; first < some.size(); first += kLanes) {
    const std::size_t count = std::min(kLanes, some.size() - first);
    for (std::size_t i = 0; i < kLanes; ++i) {
      const std::size_t row = first + std::min(i, count - 1);
      // Offsets from the point, not positions: nothing is lost far from the origin.
      const Vec3& centre = points[some[row]];
      for (std::size_t k = 0; k < degree; ++k) {
        const Vec3 offset = points[neighbours[row * degree + k]] - centre;
        for (int a = 0; a < 3; ++a) offsets[3 * k + static_cast<std::size_t>(a)][i] = offset[a];
      }
    }
    Matrices covariances;
    Cubic cubic;
    Eigenvalues e;
    Vectors v;
    add_up(offsets.get(), degree, covariances);
    make_cubics(covariances, cubic);
    solve(cubic, e);
    find_kernels(cubic.m, e.least, v);
    for (std::size_t i = 0; i < count; ++i) fits[first + i] = fit_of(covariances, cubic, e, v, i);
  }
}

std::vector<PlaneFit> fit_planes(const NeighbourGraph& graph, std::span<const std::uint32_t> some,
                                 std::size_t count) {
  std::vector<std::uint32_t> rows;
  rows.reserve(some.size() * count);
  for (const std::uint32_t i : some) {
    const auto row = graph.of(i).first(count);
    rows.insert(rows.end(), row.begin(), row.end());
  }
  std::vector<PlaneFit> fits(some.size());
  fit_planes(graph.points, some, rows, fits);
  return fits;
}

}  // namespace pcednet::normals
