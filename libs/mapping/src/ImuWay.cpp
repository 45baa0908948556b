// SPDX-License-Identifier: BSD-3-Clause
#include "ImuWay.h"

#include "lintel/geometry/Rotation.h"
#include "lintel/inertial/Propagation.h"

namespace lintel {

namespace {

/// The states that the IMU gives at `times` after `from`, ascending, all within the samples.
std::vector<InertialState> propagatedTo(const RetiredKeyframe& from, const Preintegration& whole,
                                        const std::vector<std::int64_t>& times) {
  Preintegration imu(from.bias, whole.noise(), whole.gravity_m_s2());
  std::vector<InertialState> states;
  std::size_t next = 0;
  const ImuBatch& samples = whole.samples();
  for (const std::int64_t t_ns : times) {
    ImuBatch piece;
    while (next < samples.size() && samples[next].t_ns <= t_ns) piece.push_back(samples[next++]);
    imu.append(piece);
    Preintegration here = imu;
    if (next < samples.size() && next > 0 && samples[next - 1].t_ns < t_ns) {  // a frame between two samples
      const ImuSample &a = samples[next - 1], &b = samples[next];
      const double s = static_cast<double>(t_ns - a.t_ns) / static_cast<double>(b.t_ns - a.t_ns);
      ImuSample between = a;
      between.t_ns = t_ns;
      between.gyro = a.gyro + s * (b.gyro - a.gyro);
      between.accel = a.accel + s * (b.accel - a.accel);
      here.append({between});
    }
    states.push_back(propagated({from.T_w_b, from.v_w_b, from.bias}, here));
  }
  return states;
}

}  // namespace

std::vector<Pose> posesBetween(const RetiredKeyframe& from, const RetiredKeyframe& to,
                               const std::vector<std::int64_t>& times_ns) {
  std::vector<std::int64_t> times = times_ns;
  times.push_back(to.t_ns);
  const std::vector<InertialState> states = propagatedTo(from, *to.imu, times);
  const InertialState& arrived = states.back();
  const double T = 1e-9 * static_cast<double>(to.t_ns - from.t_ns);
  const Eigen::Vector3d turn = logRotation(arrived.T_w_b.q.conjugate() * to.T_w_b.q);
  const Eigen::Vector3d missing_p = to.T_w_b.p - arrived.T_w_b.p, missing_v = to.v_w_b - arrived.v_w_b;
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < times_ns.size(); ++i) {
    const double s = 1e-9 * static_cast<double>(times[i] - from.t_ns) / T, s2 = s * s, s3 = s2 * s;
    Pose T_w_b = states[i].T_w_b;
    T_w_b.q = (T_w_b.q * expRotation(s * turn)).normalized();
    T_w_b.p += (3 * s2 - 2 * s3) * missing_p + (s3 - s2) * T * missing_v;  // Hermite: nothing missing at the start
    poses.push_back(T_w_b);
  }
  return poses;
}

}  // namespace lintel
