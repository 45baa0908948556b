// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/Random.h"

#include <cmath>

namespace lintel {

double RandomStream::gaussian() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  double u = 0, v = 0, s = 0;
  do {  // polar method: no trigonometry, both numbers used
    u = uniform(-1, 1);
    v = uniform(-1, 1);
    s = u * u + v * v;
  } while (s >= 1 || s == 0);
  const double scale = std::sqrt(-2 * std::log(s) / s);
  spare_ = v * scale;
  has_spare_ = true;
  return u * scale;
}

Eigen::Vector3d RandomStream::gaussian3(double sigma) {
  const double x = gaussian(), y = gaussian(), z = gaussian();  // named: the order of evaluation must be fixed
  return sigma * Eigen::Vector3d(x, y, z);
}

Eigen::Vector3d RandomStream::direction() { return gaussian3(1.0).normalized(); }

}  // namespace lintel
