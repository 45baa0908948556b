// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/Propagation.h"

#include "lintel/geometry/Frames.h"

namespace lintel {

InertialState propagated(const InertialState& from, const Preintegration& imu) {
  const double dt = imu.dt_s();
  const auto delta = imu.corrected(from.bias);
  InertialState to;
  to.T_w_b.q = (from.T_w_b.q * delta.delta_R).normalized();
  to.T_w_b.p = from.T_w_b.p + from.v_w_b * dt + 0.5 * gravityW() * dt * dt + from.T_w_b.q * delta.delta_p;
  to.v_w_b = from.v_w_b + gravityW() * dt + from.T_w_b.q * delta.delta_v;
  to.bias = from.bias;
  return to;
}

}  // namespace lintel
