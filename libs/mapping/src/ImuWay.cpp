// SPDX-License-Identifier: BSD-3-Clause
#include "ImuWay.h"

#include "lintel/geometry/Rotation.h"
#include "lintel/inertial/Propagation.h"

namespace lintel {

std::vector<Pose> posesBetween(const RetiredKeyframe& from, const RetiredKeyframe& to,
                               const std::vector<std::int64_t>& times_ns) {
  std::vector<std::int64_t> times = times_ns;
  times.push_back(to.t_ns);
  const InertialState start{from.T_w_b, from.v_w_b, from.bias};
  const std::vector<Preintegration> imu = integratedTo(from.bias, withAxes(*to.imu, to.axes), times);
  const InertialState arrived = propagated(start, imu.back());
  const double T = 1e-9 * static_cast<double>(to.t_ns - from.t_ns);
  const Eigen::Vector3d turn = logRotation(arrived.T_w_b.q.conjugate() * to.T_w_b.q);
  const Eigen::Vector3d missing_p = to.T_w_b.p - arrived.T_w_b.p, missing_v = to.v_w_b - arrived.v_w_b;
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < times_ns.size(); ++i) {
    const double s = 1e-9 * static_cast<double>(times[i] - from.t_ns) / T, s2 = s * s, s3 = s2 * s;
    Pose T_w_b = propagated(start, imu[i]).T_w_b;
    T_w_b.q = (T_w_b.q * expRotation(s * turn)).normalized();
    T_w_b.p += (3 * s2 - 2 * s3) * missing_p + (s3 - s2) * T * missing_v;  // Hermite: nothing missing at the start
    poses.push_back(T_w_b);
  }
  return poses;
}

}  // namespace lintel
