// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/inertial/Propagation.h"

#include <Eigen/Cholesky>

#include "lintel/geometry/Rotation.h"

namespace lintel {

InertialState propagated(const InertialState& from, const Preintegration& imu) {
  const double dt = imu.dt_s();
  const auto delta = imu.corrected(from.bias);
  InertialState to;
  to.T_w_b.q = (from.T_w_b.q * delta.delta_R).normalized();
  to.T_w_b.p = from.T_w_b.p + from.v_w_b * dt + 0.5 * imu.gravityW() * dt * dt + from.T_w_b.q * delta.delta_p;
  to.v_w_b = from.v_w_b + imu.gravityW() * dt + from.T_w_b.q * delta.delta_v;
  to.bias = from.bias;
  return to;
}

double squaredMisfit(const InertialState& from, const InertialState& to, const Preintegration& imu) {
  const InertialState expected = propagated(from, imu);
  const Eigen::Quaterniond R_b_w = from.T_w_b.q.conjugate();  // of the earlier body
  Eigen::Matrix<double, 9, 1> r;
  r.segment<3>(Preintegration::kTheta) = logRotation(expected.T_w_b.q.conjugate() * to.T_w_b.q);
  r.segment<3>(Preintegration::kVelocity) = R_b_w * (to.v_w_b - expected.v_w_b);
  r.segment<3>(Preintegration::kPosition) = R_b_w * (to.T_w_b.p - expected.T_w_b.p);
  return r.dot(imu.covariance().llt().solve(r));
}

}  // namespace lintel
