// SPDX-License-Identifier: BSD-3-Clause
#include "ConsistencyFlight.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "TestWindow.h"
#include "lintel/estimator/Estimator.h"
#include "lintel/estimator/StatePriors.h"
#include "lintel/geometry/Alignment.h"
#include "lintel/geometry/Rotation.h"

namespace lintel::test {

namespace {

constexpr double kPixelSigma = 0.7;  // of the tracks, and what the estimator assumes

struct Draw {
  std::mt19937_64 engine;
  std::normal_distribution<double> normal;
  double operator()(double sigma) { return sigma * normal(engine); }
  Eigen::Vector3d vector(double sigma) { return {(*this)(sigma), (*this)(sigma), (*this)(sigma)}; }
};

/// A rig that is wrong by one draw from the priors.
Rig wrongRig(const Rig& rig, const CalibrationParams& p, Draw& draw) {
  Rig wrong = rig;
  wrong.camera.fx += draw(p.focal_sigma_px);
  wrong.camera.fy += draw(p.focal_sigma_px);
  wrong.camera.cx += draw(p.centre_sigma_px);
  wrong.camera.cy += draw(p.centre_sigma_px);
  wrong.camera.lens[0] += draw(p.distortion_sigma);
  wrong.camera.lens[1] += draw(p.distortion_sigma);
  wrong.T_b_c.p += draw.vector(p.extrinsic_translation_sigma_m);
  wrong.T_b_c.q = wrong.T_b_c.q * expRotation(draw.vector(p.extrinsic_rotation_sigma_rad));
  return wrong;
}

/// What a draw from the priors has the IMU's axes wrong by. The accelerometer's samples keep their mean over the first
/// two seconds, about which the estimator's biases are.
ImuAxes turnAxes(const CalibrationParams& p, Draw& draw, TrackedFlight& flight) {
  AxesBlock block = axesSigmas(AxesBlock::Zero(), p);
  for (double& element : block) element = draw(element);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  for (std::size_t k = 0; k < 40; ++k)
    for (const ImuSample& sample : flight.sim.frames[k].imu) sum += sample.accel, ++count;
  const ImuAxes axes = axesFromBlock(block.data(), sum / count);
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  for (SimulatedFrame& frame : flight.sim.frames)
    for (ImuSample& sample : frame.imu) {
      sample.accel = (I + axes.A).inverse() * (sample.accel + axes.A * axes.mean_f);
      sample.gyro = (I + axes.G).inverse() * sample.gyro;
    }
  return axes;
}

/// Another motion, later by `offset_s`.
class Shifted : public Trajectory {
 public:
  Shifted(const FigureParams& params, double offset_s) : motion_(params), offset_s_(offset_s) {}
  KinematicState at(double t_s) const override { return motion_.at(t_s + offset_s_); }

 private:
  FigureTrajectory motion_;
  double offset_s_;
};

/// The tracks as a front end with this camera sees them.
FrameTracks seenWith(const Camera& camera, FrameTracks tracks) {
  for (PointObservation& o : tracks.points) o.ray = camera.ray(o.px);
  for (LineObservation& o : tracks.lines) {
    o.start = camera.ray(o.start_px);
    o.end = camera.ray(o.end_px);
  }
  return tracks;
}

/// A flight whose images are taken `offset_s` later than they are stamped.
TrackedFlight flyLate(std::uint64_t seed, const ConsistencySetting& setting, double offset_s) {
  FigureParams figure;
  figure.seed = seed;
  ImuSimulatorParams imu;
  imu.seed = seed;
  TrackSimulationParams tracks;
  tracks.duration_s = setting.duration_s;
  tracks.seed = seed;
  tracks.max_points_per_frame = setting.points;
  tracks.max_lines_per_frame = setting.lines;
  tracks.point_noise_px = tracks.line_noise_px = kPixelSigma;
  TrackedFlight flight = fly(imu, tracks, Shifted(figure, offset_s));
  const TrackedFlight on_time = fly(imu, tracks, Shifted(figure, 0));
  for (std::size_t k = 0; k < flight.sim.frames.size(); ++k) {
    flight.sim.frames[k].imu = on_time.sim.frames[k].imu;
    flight.sim.frames[k].truth = on_time.sim.frames[k].truth;
  }
  return flight;
}

SquaredError squared(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
  return {error.dot(covariance.ldlt().solve(error)), static_cast<int>(error.size())};
}

using Vector15 = Eigen::Matrix<double, 15, 1>;

/// The true state seen from the estimate, after both have been laid on each other by position and yaw of the first one.
class Comparison {
 public:
  Comparison(const Pose& estimate, const Pose& truth) : at_(estimate.p), from_(truth.p) {
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d turned = logRotation(estimate.q * (yaw_ * truth.q).conjugate());
      yaw_ = Eigen::Quaterniond(Eigen::AngleAxisd(turned.z(), Eigen::Vector3d::UnitZ())) * yaw_;
    }
  }

  Vector15 error(const WindowUpdate& update, const InertialTruth& truth) const {
    const Pose T{yaw_ * truth.state.T_w_b.q, at_ + yaw_ * (truth.state.T_w_b.p - from_)};
    Vector15 e;
    e << T.p - update.T_w_b.p, logRotation(update.T_w_b.q.conjugate() * T.q), yaw_ * truth.state.v_w_b - update.v_w_b,
        truth.bias_gyro - update.bias.gyro, truth.bias_accel - update.bias.accel;
    return e;
  }

 private:
  Eigen::Vector3d at_, from_;
  Eigen::Quaterniond yaw_ = Eigen::Quaterniond::Identity();
};

void addState(const Vector15& e, const WindowUpdate& update, SquaredErrors& to) {
  const StateCovariance& P = update.covariance;
  const Eigen::Matrix3d R = update.T_w_b.R();
  const Eigen::Vector3d turn = R * e.segment<3>(3);
  const Eigen::Matrix3d turn_covariance = R * P.block<3, 3>(3, 3) * R.transpose();
  to["position"] = squared(e.head<3>(), P.topLeftCorner<3, 3>());
  to["yaw"] = squared(turn.tail<1>(), turn_covariance.bottomRightCorner<1, 1>());
  to["roll, pitch"] = squared(turn.head<2>(), turn_covariance.topLeftCorner<2, 2>());
  to["velocity"] = squared(e.segment<3>(6), P.block<3, 3>(6, 6));
  to["gyroscope bias"] = squared(e.segment<3>(9), P.block<3, 3>(9, 9));
  to["accelerometer bias"] = squared(e.tail<3>(), P.bottomRightCorner<3, 3>());
}

void addCalibration(const CalibrationEstimate& e, const Rig& truth, double offset_s, const ImuAxes& axes,
                    SquaredErrors& to) {
  if (!e.sigma) return;
  const auto inSigmas = [](const ImuAxes& error, const ImuAxes& sigma) {
    return Eigen::VectorXd(toBlock(error).array() / toBlock(sigma).array());
  };
  const Eigen::VectorXd of_axes = inSigmas({axes.A - e.accelerometer_axes, {0, 0, 0}, axes.G - e.gyroscope_axes},
                                           {e.sigma->accelerometer_axes, {0, 0, 0}, e.sigma->gyroscope_axes});
  to["accelerometer's axes"] = {of_axes.head(kGyroAxesAt).squaredNorm(), kGyroAxesAt};
  to["gyroscope's axes"] = {of_axes.tail(kAxesSize - kGyroAxesAt).squaredNorm(), kAxesSize - kGyroAxesAt};
  const Camera &c = e.camera, &t = truth.camera;
  Eigen::Matrix<double, 14, 1> error;
  error << truth.T_b_c.p - e.T_b_c.p, logRotation(e.T_b_c.q.conjugate() * truth.T_b_c.q), t.fx - c.fx, t.fy - c.fy,
      t.cx - c.cx, t.cy - c.cy, t.lens[0] - c.lens[0], t.lens[1] - c.lens[1], -e.readout_s, offset_s - e.time_offset_s;
  const auto part = [&](const char* name, int at, int size) {
    to[name] = squared(error.segment(at, size), e.sigma->covariance.block(at, at, size, size));
  };
  part("lever arm", 0, 3);
  part("rotation", 3, 3);
  part("focal length", 6, 2);
  part("principal point", 8, 2);
  part("distortion", 10, 2);
  part("time offset", 13, 1);
}

/// Errors of points and lines seen from the keyframe that saw them first: what their sigmas are about.
class LandmarkComparison {
 public:
  LandmarkComparison(const TrackedFlight& flight, ConsistencyFlight& result) : flight_(flight), result_(result) {}

  void add(const WindowUpdate& update) {
    for (const RetiredKeyframe& k : update.keyframes) keyframes_[k.id] = {k.t_ns, k.T_w_b};
    for (const RetiredPoint& p : update.points) addPoint(p);
    for (const RetiredLine& l : update.lines) addLine(l);
  }

 private:
  /// From the estimate's world to the true one, by one keyframe.
  std::optional<Pose> toTruth(FrameId id) const {
    const auto found = keyframes_.find(id);
    if (found == keyframes_.end()) return std::nullopt;
    for (const SimulatedFrame& frame : flight_.sim.frames)
      if (frame.tracks.t_ns == found->second.first) return frame.truth.state.T_w_b * found->second.second.inverse();
    return std::nullopt;
  }

  void addPoint(const RetiredPoint& p) {
    if (!p.triangulated || p.sightings.empty() || p.sigma_distance_m <= 0) return;
    const auto T = toTruth(p.sightings.front().frame);
    if (!T) return;
    const Eigen::Vector3d eye = *T * (keyframes_.at(p.sightings.front().frame).second * flight_.rig.T_b_c).p;
    const Eigen::Vector3d& truth = flight_.sim.points_w[flight_.sim.point_of_track[p.id]];
    const double error = ((*T * p.p_w) - eye).norm() - (truth - eye).norm();
    result_.points.push_back({{"distance", {std::pow(error / p.sigma_distance_m, 2), 1}}});
  }

  void addLine(const RetiredLine& l) {
    if (!l.triangulated || l.degenerate || l.sightings.empty() || l.sigma_direction_rad <= 0) return;
    const auto T = toTruth(l.sightings.front().frame);
    if (!T) return;
    const Segment3& segment = flight_.sim.lines_w[flight_.sim.line_of_track[l.id]];
    const Eigen::Vector3d d = T->q * l.line_w.d.normalized(), foot = *T * l.line_w.nearestPoint();
    result_.lines.push_back(
        {{"direction", {std::pow(lineAngle(d, segment.direction()) / l.sigma_direction_rad, 2), 1}},
         {"distance", {std::pow((segment.midpoint() - foot).cross(d).norm() / l.sigma_distance_m, 2), 1}}});
  }

  const TrackedFlight& flight_;
  ConsistencyFlight& result_;
  std::map<FrameId, std::pair<std::int64_t, Pose>> keyframes_;
};

EstimatorParams paramsOf(const ConsistencySetting& setting) {
  EstimatorParams params;
  params.factors.find_track_noise = false;  // it is told
  params.factors.point_sigma_px = params.factors.point_noise_px = kPixelSigma;
  params.factors.line_sigma_px = params.factors.line_noise_px = 1;  // of what the observations say of themselves
  params.factors.point_walk_px = params.factors.line_walk_px = 0;
  if (setting.plain)
    params.factors.point_loss_width = params.factors.line_loss_width = params.factors.track_freedom =
        params.calibration.loss_width = 1e6;
  if (setting.imu_as_given)
    for (double* scale : {&params.factors.gyro_noise_scale, &params.factors.accel_noise_scale,
                          &params.factors.gyro_walk_scale, &params.factors.accel_walk_scale})
      *scale = 1 + 1e-9;
  return params;
}

}  // namespace

ConsistencyFlight flyConsistently(std::uint64_t seed, const ConsistencySetting& setting) {
  Draw draw{std::mt19937_64(seed), {}};
  const EstimatorParams params = paramsOf(setting);
  const double offset_s = draw(params.calibration.time_offset_sigma_s);
  TrackedFlight flight = flyLate(seed, setting, offset_s);
  const Rig rig = wrongRig(flight.rig, params.calibration, draw);
  const ImuAxes axes = turnAxes(params.calibration, draw, flight);
  Estimator estimator(rig, params);
  ConsistencyFlight result;
  LandmarkComparison landmarks(flight, result);
  std::vector<Eigen::Vector3d> estimate, truth;
  std::optional<Comparison> comparison;
  std::vector<double> times = setting.times_s;
  for (const SimulatedFrame& frame : flight.sim.frames) {
    const WindowUpdate update = estimator.process(seenWith(rig.camera, frame.tracks), frame.imu);
    if (update.status == EstimatorStatus::kLost) ++result.lost;
    landmarks.add(update);
    if (!update.hasPose()) continue;
    if (!comparison) comparison.emplace(update.T_w_b, frame.truth.state.T_w_b);
    estimate.push_back(update.T_w_b.p);
    truth.push_back(frame.truth.state.T_w_b.p);
    const double t_s = 1e-9 * static_cast<double>(frame.tracks.t_ns - flight.sim.frames.front().tracks.t_ns);
    if (times.empty() || t_s < times.front() - 1e-6 || result.lost > 0) continue;
    SquaredErrors& errors = result.at[times.front()];
    addState(comparison->error(update, frame.truth), update, errors);
    addCalibration(estimator.calibration(), flight.rig, offset_s, axes, errors);
    times.erase(times.begin());
  }
  landmarks.add(estimator.finish());
  if (estimate.size() < 20) return result;
  const Similarity T = alignPositions(AlignmentKind::kYaw, estimate, truth);
  double sum = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) sum += (T * estimate[i] - truth[i]).squaredNorm();
  result.rmse_m = std::sqrt(sum / static_cast<double>(truth.size()));
  return result;
}

std::pair<double, double> boundsOfMean(std::size_t count, int freedom) {
  const double n = static_cast<double>(count), k = n * freedom;
  const auto quantile = [k, n](double z) { return k * std::pow(1 - 2 / (9 * k) + z * std::sqrt(2 / (9 * k)), 3) / n; };
  return {quantile(-1.959964), quantile(1.959964)};
}

}  // namespace lintel::test
