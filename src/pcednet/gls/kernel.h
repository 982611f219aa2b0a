#pragma once

namespace pcednet::gls {

/// The weight of a neighbour at y = p_j - x within the support radius t, and its derivatives.
struct KernelWeight {
  double value;  ///< w     = (1 - |y|^2/t^2)^2
  double dt;     ///< dw/dt = (4/t) (|y|^2/t^2) (1 - |y|^2/t^2)
  double dx;     ///< dw/dx = dx * y, dx = (4/t^2) (1 - |y|^2/t^2); x is the evaluation point
};

/// The kernel for one support radius t > 0.
class Kernel {
 public:
  explicit Kernel(double t)
      : inverse_sq_t_(1.0 / (t * t)), dt_factor_(4.0 / t), dx_factor_(4.0 * inverse_sq_t_) {}

  /// `sq_distance` = |y|^2 must be below t^2.
  KernelWeight operator()(double sq_distance) const {
    const double s = sq_distance * inverse_sq_t_;
    const double rest = 1.0 - s;
    return {rest * rest, dt_factor_ * s * rest, dx_factor_ * rest};
  }

 private:
  double inverse_sq_t_, dt_factor_, dx_factor_;
};

}  // namespace pcednet::gls
