// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "lintel/geometry/Rotation.h"
#include "lintel/inertial/Propagation.h"
#include "lintel/mapping/BatchRefinement.h"

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

/// Poses at `times` between two keyframes.
void fillInterval(const RetiredKeyframe& from, const RetiredKeyframe& to, const std::vector<std::int64_t>& times,
                  std::vector<std::pair<std::int64_t, Pose>>& trajectory) {
  std::vector<std::int64_t> all = times;
  all.push_back(to.t_ns);
  const std::vector<InertialState> states = propagatedTo(from, *to.imu, all);
  const InertialState& arrived = states.back();
  const double T = 1e-9 * static_cast<double>(to.t_ns - from.t_ns);
  const Eigen::Vector3d turn = logRotation(arrived.T_w_b.q.conjugate() * to.T_w_b.q);
  const Eigen::Vector3d missing_p = to.T_w_b.p - arrived.T_w_b.p, missing_v = to.v_w_b - arrived.v_w_b;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double s = 1e-9 * static_cast<double>(times[i] - from.t_ns) / T, s2 = s * s, s3 = s2 * s;
    Pose T_w_b = states[i].T_w_b;
    T_w_b.q = (T_w_b.q * expRotation(s * turn)).normalized();
    T_w_b.p += (3 * s2 - 2 * s3) * missing_p + (s3 - s2) * T * missing_v;  // Hermite: nothing missing at the start
    trajectory.emplace_back(times[i], T_w_b);
  }
}

}  // namespace

std::vector<std::pair<std::int64_t, Pose>> refinedTrajectory(const MapMaterial& causal,
                                                             const std::vector<RetiredKeyframe>& refined) {
  std::vector<std::pair<std::int64_t, Pose>> result;
  if (refined.empty()) return causal.trajectory;
  const auto& frames = causal.trajectory;
  // what a frame that the IMU does not reach moves by: the change of the keyframe `k`
  const auto movedWith = [&](std::size_t k, const std::pair<std::int64_t, Pose>& frame) {
    const Pose T_w_e = refined[k].T_w_b * causal.keyframes[k].T_w_b.inverse();
    return std::make_pair(frame.first, T_w_e * frame.second);
  };
  std::size_t next = 0;
  while (next < frames.size() && frames[next].first < refined.front().t_ns)
    result.push_back(movedWith(0, frames[next++]));
  for (std::size_t k = 0; k < refined.size(); ++k) {
    if (next < frames.size() && frames[next].first == refined[k].t_ns) {
      result.emplace_back(frames[next++].first, refined[k].T_w_b);
    }
    const std::int64_t until = k + 1 < refined.size() ? refined[k + 1].t_ns : INT64_MAX;
    std::size_t end = next;
    while (end < frames.size() && frames[end].first < until) ++end;
    if (k + 1 < refined.size() && refined[k + 1].imu && refined[k + 1].imu->dt_s() > 0) {
      std::vector<std::int64_t> times;
      for (; next < end; ++next) times.push_back(frames[next].first);
      fillInterval(refined[k], refined[k + 1], times, result);
    } else {
      for (; next < end; ++next) result.push_back(movedWith(k, frames[next]));
    }
  }
  return result;
}

}  // namespace lintel
