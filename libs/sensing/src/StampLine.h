// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace lintel {

/// A straight line through stamps over their numbers, by weighted least squares.
class StampLine {
 public:
  void add(double weight, double number, double t_ns) {
    w_ += weight, k_ += weight * number, t_ += weight * t_ns;
    kk_ += weight * number * number, kt_ += weight * number * t_ns;
  }

  /// 0 for a single number.
  double slope_ns() const {
    const double determinant = w_ * kk_ - k_ * k_;
    return determinant > 0 ? (w_ * kt_ - k_ * t_) / determinant : 0;
  }
  double at(double number) const { return (t_ + slope_ns() * (number * w_ - k_)) / w_; }

 private:
  double w_ = 0, k_ = 0, t_ = 0, kk_ = 0, kt_ = 0;
};

}  // namespace lintel
