// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/estimator/Estimator.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "TestWindow.h"
#include "lintel/geometry/Alignment.h"
#include "lintel/geometry/Frames.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

using namespace test;

/// Everything an estimator said about a flight; the last update is finish()'s.
std::vector<WindowUpdate> run(const TrackedFlight& flight, const EstimatorParams& params = {}, bool lines = true) {
  Estimator estimator(flight.rig, params);
  std::vector<WindowUpdate> updates;
  for (const SimulatedFrame& frame : flight.sim.frames) {
    FrameTracks tracks = frame.tracks;
    if (!lines) tracks.lines.clear();
    updates.push_back(estimator.process(tracks, frame.imu));
  }
  updates.push_back(estimator.finish());
  return updates;
}

/// Where the body was, by the causal trajectory and truly, wherever there is a pose [m].
struct Positions {
  std::vector<Eigen::Vector3d> estimate, truth;
};

Positions positionsOf(const std::vector<WindowUpdate>& updates, const TrackedFlight& flight) {
  Positions p;
  for (std::size_t k = 0; k < flight.sim.frames.size(); ++k)
    if (updates[k].hasPose()) {
      p.estimate.push_back(updates[k].T_w_b.p);
      p.truth.push_back(flight.truth(k).state.T_w_b.p);
    }
  return p;
}

/// Root mean square position error of the causal trajectory after alignment of position and yaw [m].
double positionError(const std::vector<WindowUpdate>& updates, const TrackedFlight& flight) {
  const auto [estimate, truth] = positionsOf(updates, flight);
  const Similarity T = alignPositions(AlignmentKind::kYaw, estimate, truth);
  double sum = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) sum += (T * estimate[i] - truth[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(truth.size()));
}

int posesOf(const std::vector<WindowUpdate>& updates) {
  return static_cast<int>(std::count_if(updates.begin(), updates.end(), [](const auto& u) { return u.hasPose(); }));
}

int lostOf(const std::vector<WindowUpdate>& updates) {
  return static_cast<int>(
      std::count_if(updates.begin(), updates.end(), [](const auto& u) { return u.status == EstimatorStatus::kLost; }));
}

TrackSimulationParams tracksFor(double duration_s, double noise_px) {
  TrackSimulationParams tracks;
  tracks.duration_s = duration_s;
  tracks.max_points_per_frame = 80;
  tracks.max_lines_per_frame = 25;
  tracks.point_noise_px = tracks.line_noise_px = noise_px;
  return tracks;
}

/// The calibration of a simulated flight is perfect: what is left of the error is the estimator's.
EstimatorParams withoutCalibration() {
  EstimatorParams params;
  params.calibration.refine_camera = params.calibration.refine_extrinsics = params.calibration.refine_readout =
      params.calibration.refine_time_offset = false;
  return params;
}

/// Keyframes are handed over once, landmarks once between two starts.
void expectEachIdOnce(const std::vector<WindowUpdate>& updates) {
  std::set<FrameId> keyframes;
  std::set<TrackId> points, lines;
  for (const WindowUpdate& u : updates) {
    // a new start has a new world: what is still tracked is estimated and handed over again
    for (const auto& k : u.keyframes) EXPECT_TRUE(keyframes.insert(k.id).second) << "keyframe " << k.id << " twice";
    for (const auto& p : u.points) EXPECT_TRUE(points.insert(p.id).second) << "point " << p.id << " twice";
    for (const auto& l : u.lines) EXPECT_TRUE(lines.insert(l.id).second) << "line " << l.id << " twice";
    if (u.status == EstimatorStatus::kLost) points.clear(), lines.clear();
  }
}

TEST(Estimator, FollowsAPerfectFlightToACentimetre) {
  const TrackedFlight flight = fly(perfectImu(), tracksFor(10, 0));
  const auto updates = run(flight, withoutCalibration());
  EXPECT_EQ(lostOf(updates), 0);
  EXPECT_GT(posesOf(updates), 160);
  EXPECT_LT(positionError(updates, flight), 0.01);
}

TEST(Estimator, FollowsANoisyFlight) {
  const TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(10, 0.5));
  const auto updates = run(flight);
  EXPECT_EQ(lostOf(updates), 0);
  EXPECT_GT(posesOf(updates), 160);
  EXPECT_LT(positionError(updates, flight), 0.05);
  for (std::size_t k = 0; k < flight.sim.frames.size(); ++k) {
    if (updates[k].status != EstimatorStatus::kTracking || k < 100) continue;
    const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    EXPECT_LT((updates[k].T_w_b.q.conjugate() * up).cross(flight.truth(k).state.T_w_b.q.conjugate() * up).norm(), 0.02);
    EXPECT_LT((updates[k].bias.gyro - flight.truth(k).bias_gyro).norm(), 0.01);
    EXPECT_NEAR(updates[k].v_w_b.norm(), flight.truth(k).state.v_w_b.norm(), 0.1);
  }
}

TEST(Estimator, FollowsAFlightThroughAnyLens) {
  for (const LensModel model : {LensModel::kRational, LensModel::kEquidistant, LensModel::kDoubleSphere}) {
    Rig rig = eurocRig();
    rig.camera = lensCamera(model);
    const TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(10, 0.5), FigureTrajectory(), rig);
    const auto updates = run(flight);
    EXPECT_EQ(lostOf(updates), 0);
    EXPECT_GT(posesOf(updates), 160);
    EXPECT_LT(positionError(updates, flight), 0.05) << static_cast<int>(model);
  }
}

/// The flight as a front end sees it that was told another rig.
TrackedFlight toldAnotherRig(TrackedFlight flight, const Rig& told) {
  for (SimulatedFrame& frame : flight.sim.frames) {
    for (PointObservation& o : frame.tracks.points) o.ray = told.camera.ray(o.px);
    for (LineObservation& o : frame.tracks.lines) {
      o.start = told.camera.ray(o.start_px);
      o.end = told.camera.ray(o.end_px);
    }
  }
  flight.rig = told;
  return flight;
}

TEST(Estimator, FindsTheCalibrationFromARoughOne) {
  const TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(10, 0.5));
  Rig rough = flight.rig;
  rough.camera.fx *= 1.02;
  rough.camera.fy *= 1.02;
  rough.camera.lens = {};
  rough.T_b_c.q = rough.T_b_c.q * expRotation(Eigen::Vector3d(0.03, -0.03, 0.03));
  rough.T_b_c.p += Eigen::Vector3d(0.02, -0.01, 0.02);
  const TrackedFlight told = toldAnotherRig(flight, rough);
  Estimator estimator(rough, {});
  std::vector<WindowUpdate> updates;
  for (const SimulatedFrame& frame : told.sim.frames) updates.push_back(estimator.process(frame.tracks, frame.imu));
  EXPECT_EQ(lostOf(updates), 0);
  EXPECT_LT(positionError(updates, flight), 0.1);
  const CalibrationEstimate found = estimator.calibration();
  EXPECT_NEAR(found.camera.meanFocal(), flight.rig.camera.meanFocal(), 2);
  EXPECT_NEAR(found.camera.lens[0], flight.rig.camera.lens[0], 0.01);
  EXPECT_LT(found.T_b_c.q.angularDistance(flight.rig.T_b_c.q), 0.005);
}

/// The flight with an IMU whose samples f and w show the specific force f + A f and the rate w + G w.
TrackedFlight misaligned(TrackedFlight flight, const ImuAxes& axes) {
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  for (SimulatedFrame& frame : flight.sim.frames)
    for (ImuSample& sample : frame.imu) {
      sample.accel = (I + axes.A).inverse() * sample.accel;
      sample.gyro = (I + axes.G).inverse() * sample.gyro;
    }
  return flight;
}

/// Of a telephone.
ImuAxes roughAxes() {
  ImuAxes axes;
  axes.A << 0.004, -0.02, 0, 0.05, -0.006, -0.03, -0.01, 0.02, 0.01;
  axes.G << 0.015, 0.01, 0, 0.01, -0.02, -0.01, 0, -0.01, 0.01;
  return axes;
}

TEST(Estimator, FindsWhatTheAxesOfTheImuAreWrongBy) {
  FigureParams tilting;
  tilting.rotation = 2;
  tilting.seed = 1;
  const TrackedFlight right = fly(ImuSimulatorParams{}, tracksFor(20, 0.3), FigureTrajectory(tilting)),
                      wrong = misaligned(right, roughAxes());
  EstimatorParams held;
  held.calibration.refine_axes = false;
  EXPECT_LT(positionError(run(wrong), right), 0.6 * positionError(run(wrong, held), right));
  Estimator estimator(wrong.rig, {});
  for (const SimulatedFrame& frame : wrong.sim.frames) estimator.process(frame.tracks, frame.imu);
  const CalibrationEstimate found = estimator.calibration();
  const ImuAxes axes = roughAxes();
  EXPECT_NEAR(found.accelerometer_axes(0, 1), axes.A(0, 1), 0.004);
  EXPECT_NEAR(found.accelerometer_axes(1, 2), axes.A(1, 2), 0.005);
  EXPECT_LT((found.accelerometer_axes - axes.A).cwiseAbs().maxCoeff(), 0.4 * 0.05) << found.accelerometer_axes;
  EXPECT_LT((found.gyroscope_axes - axes.G).cwiseAbs().maxCoeff(), 0.25 * 0.02) << found.gyroscope_axes;
}

/// The flight with stamps of the images that are off by `sigma_s` each; the samples are those between the stamps.
TrackedFlight withJitter(TrackedFlight flight, double sigma_s, unsigned seed) {
  ImuBatch all;
  for (const SimulatedFrame& frame : flight.sim.frames)
    for (const ImuSample& sample : frame.imu)
      if (all.empty() || sample.t_ns > all.back().t_ns) all.push_back(sample);
  const auto at = [&](std::int64_t t_ns) {
    const auto after = std::lower_bound(all.begin() + 1, all.end() - 1, t_ns,
                                        [](const ImuSample& s, std::int64_t t) { return s.t_ns < t; });
    const ImuSample &a = after[-1], &b = *after;
    const double share = static_cast<double>(t_ns - a.t_ns) / static_cast<double>(b.t_ns - a.t_ns);
    return ImuSample{t_ns, a.gyro + share * (b.gyro - a.gyro), a.accel + share * (b.accel - a.accel)};
  };
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, sigma_s);
  std::int64_t before_ns = all.front().t_ns;
  for (SimulatedFrame& frame : flight.sim.frames) {
    const std::int64_t t_ns = frame.tracks.t_ns += std::llround(1e9 * std::clamp(normal(random), -0.02, 0.02));
    frame.imu = {at(before_ns)};
    for (const ImuSample& sample : all)
      if (sample.t_ns > before_ns && sample.t_ns < t_ns) frame.imu.push_back(sample);
    frame.imu.push_back(at(t_ns));
    before_ns = t_ns;
  }
  return flight;
}

TEST(Estimator, StampsThatAreOffEachByItsOwnAmountAreFoundAndCounted) {
  const double sigma_s = 0.002;
  const TrackedFlight exact = fly(ImuSimulatorParams{}, tracksFor(10, 0.3));
  EstimatorParams ignoring;
  ignoring.calibration.find_stamp_jitter = false;
  double log_ratio = 0;
  for (const unsigned seed : {1u, 2u, 3u}) {
    const TrackedFlight flight = withJitter(exact, sigma_s, seed);
    Estimator estimator(flight.rig, {});
    std::vector<WindowUpdate> updates;
    for (const SimulatedFrame& frame : flight.sim.frames) updates.push_back(estimator.process(frame.tracks, frame.imu));
    EXPECT_GT(posesOf(updates), 160);
    EXPECT_NEAR(estimator.calibration().stamp_jitter_s, sigma_s, 0.5 * sigma_s);
    log_ratio += std::log(positionError(updates, flight) / positionError(run(flight, ignoring), flight)) / 3;
  }
  EXPECT_LT(std::exp(log_ratio), 0.9);
}

TEST(Estimator, StampsThatAreRightHaveNoJitter) {
  const TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(10, 0.5));
  Estimator estimator(flight.rig, {});
  for (const SimulatedFrame& frame : flight.sim.frames) estimator.process(frame.tracks, frame.imu);
  EXPECT_EQ(estimator.calibration().stamp_jitter_s, 0);
}

TEST(Estimator, PointsThatLastInThePriorMakeItBetter) {
  double log_ratio = 0;
  constexpr int kSeeds = 4;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    ImuSimulatorParams imu;
    imu.seed = seed;
    TrackSimulationParams tracks = tracksFor(10, 0.4);
    tracks.seed = seed;
    const TrackedFlight flight = fly(imu, tracks);
    EstimatorParams none;
    none.landmarks.lasting_points = 0;
    log_ratio += std::log(positionError(run(flight), flight) / positionError(run(flight, none), flight)) / kSeeds;
  }
  RecordProperty("with_over_without", std::to_string(std::exp(log_ratio)));
  EXPECT_LT(std::exp(log_ratio), 0.9);
}

TEST(Estimator, NoPointLastsWhileTheStartIsOnTrial) {
  const TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(8, 0.4));
  EstimatorParams none;
  none.landmarks.lasting_points = 0;
  const auto with = run(flight), without = run(flight, none);
  std::size_t alike = 0, tracked = 0;
  for (std::size_t k = 0; k < with.size() && with[k].T_w_b.p == without[k].T_w_b.p; ++k) {
    ++alike;
    tracked += with[k].hasPose();
  }
  EXPECT_GE(tracked, 30u);
  EXPECT_LT(alike, with.size()) << "no point lasted at all";
}

TEST(Estimator, LinesDoNotMakeItWorse) {
  double log_ratio = 0;
  constexpr int kSeeds = 12;
  for (std::uint64_t seed = 2; seed < 2 + kSeeds; ++seed) {
    ImuSimulatorParams imu;
    imu.seed = seed;
    TrackSimulationParams tracks = tracksFor(5, 0.5);
    tracks.seed = seed;
    tracks.max_points_per_frame = 40;
    const TrackedFlight flight = fly(imu, tracks);
    log_ratio += std::log(positionError(run(flight), flight) / positionError(run(flight, {}, false), flight)) / kSeeds;
  }
  RecordProperty("with_lines_over_without", std::to_string(std::exp(log_ratio)));
  EXPECT_LT(std::exp(log_ratio), 1.1);
}

TEST(Estimator, RetiredLandmarksAreWhereTheyAre) {
  const TrackedFlight flight = fly(perfectImu(), tracksFor(8, 0));
  const auto updates = run(flight, withoutCalibration());
  // the world of the estimate is the true one moved and turned about z
  const auto [estimate, truth] = positionsOf(updates, flight);
  const Similarity T = alignPositions(AlignmentKind::kYaw, estimate, truth);
  int points = 0, lines = 0;
  for (const WindowUpdate& u : updates) {
    for (const RetiredPoint& p : u.points) {
      if (!p.triangulated) continue;
      const Eigen::Vector3d error = T * p.p_w - flight.sim.points_w[flight.sim.point_of_track[p.id]];
      EXPECT_LT(error.norm(), 0.05 + 3 * p.sigma_distance_m) << "point " << p.id;
      ++points;
    }
    for (const RetiredLine& l : u.lines) {
      if (!l.triangulated || l.degenerate) continue;
      const Segment3& segment = flight.sim.lines_w[flight.sim.line_of_track[l.id]];
      EXPECT_LT(lineAngle(T.T_a_b.q * l.line_w.d, segment.direction()), 0.02 + 3 * l.sigma_direction_rad);
      const Eigen::Vector3d foot = T * l.line_w.nearestPoint(), d = T.T_a_b.q * l.line_w.d.normalized();
      EXPECT_LT((segment.midpoint() - foot).cross(d).norm(), 0.05 + 3 * l.sigma_distance_m) << "line " << l.id;
      ++lines;
    }
  }
  EXPECT_GT(points, 200);
  EXPECT_GT(lines, 8);
}

TEST(Estimator, HandsOverEverythingOnce) {
  const TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(5, 0.5));
  const auto updates = run(flight);
  expectEachIdOnce(updates);
  const WindowUpdate& last = updates.back();
  EXPECT_GE(last.keyframes.size(), 5u) << "the window is handed over at the end";
  EXPECT_FALSE(last.points.empty());
  std::set<FrameId> known;
  for (const WindowUpdate& u : updates)
    for (const auto& k : u.keyframes) known.insert(k.id);
  for (const WindowUpdate& u : updates)
    for (const auto& p : u.points)
      for (const PointSighting& s : p.sightings) EXPECT_TRUE(known.count(s.frame)) << "a sighting in no keyframe";
}

TEST(Estimator, FinishTwiceIsNothingMore) {
  const TrackedFlight flight = fly(perfectImu(), tracksFor(3, 0));
  Estimator estimator(flight.rig, {});
  for (const SimulatedFrame& frame : flight.sim.frames) estimator.process(frame.tracks, frame.imu);
  EXPECT_FALSE(estimator.finish().keyframes.empty());
  const WindowUpdate again = estimator.finish();
  EXPECT_TRUE(again.keyframes.empty() && again.points.empty() && again.lines.empty());
}

TEST(Estimator, TwoRunsGiveTheSameBits) {
  TrackSimulationParams tracks = tracksFor(3.5, 0.5);
  tracks.outlier_share = 0.02;
  const TrackedFlight flight = fly(ImuSimulatorParams{}, tracks);
  const auto a = run(flight), b = run(flight);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    ASSERT_EQ(a[k].status, b[k].status);
    ASSERT_EQ(a[k].T_w_b.p, b[k].T_w_b.p) << "frame " << k;
    ASSERT_EQ(a[k].T_w_b.q.coeffs(), b[k].T_w_b.q.coeffs());
    ASSERT_EQ(a[k].points.size(), b[k].points.size());
    for (std::size_t i = 0; i < a[k].points.size(); ++i) ASSERT_EQ(a[k].points[i].p_w, b[k].points[i].p_w);
    ASSERT_EQ(a[k].lines.size(), b[k].lines.size());
    for (std::size_t i = 0; i < a[k].lines.size(); ++i) ASSERT_EQ(a[k].lines[i].line_w.n, b[k].lines[i].line_w.n);
  }
  EXPECT_GT(posesOf(a), 30);
}

TEST(Estimator, AShortDropOutOfTheImuIsBridged) {
  TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(6, 0.3));
  const std::size_t from = 60, to = 68;  // 0.4 s
  const ImuSample a = flight.sim.frames[from].imu.front(), b = flight.sim.frames[to - 1].imu.back();
  for (std::size_t k = from; k < to; ++k)
    for (ImuSample& sample : flight.sim.frames[k].imu) {
      const double s = static_cast<double>(sample.t_ns - a.t_ns) / static_cast<double>(b.t_ns - a.t_ns);
      sample = {sample.t_ns, a.gyro + s * (b.gyro - a.gyro), a.accel + s * (b.accel - a.accel), true};
    }
  const auto updates = run(flight);
  EXPECT_EQ(lostOf(updates), 0);
  EXPECT_LT(positionError(updates, flight), 0.05);
}

TEST(Estimator, AnImuGapIsAFailureAndItStartsAgainWhereItWas) {
  TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(6, 0.3));
  const std::size_t gap = 60;
  flight.sim.frames[gap].imu.clear();
  const auto updates = run(flight);
  ASSERT_TRUE(updates[gap - 1].hasPose());
  EXPECT_EQ(updates[gap].status, EstimatorStatus::kLost);
  EXPECT_EQ(updates[gap].reason, "the IMU has a gap");
  EXPECT_EQ(updates[gap].failure, Failure::kInterrupted);
  EXPECT_FALSE(updates[gap].keyframes.empty()) << "what was computed before is handed over";
  EXPECT_FALSE(updates[gap].points.empty());
  EXPECT_EQ(lostOf(updates), 1);
  std::size_t again = gap + 1;
  while (again < flight.sim.frames.size() && !updates[again].hasPose()) ++again;
  ASSERT_LT(again, gap + 55) << "starts again";
  EXPECT_NE(updates[gap + 5].reason, "");
  // the second start continues at the last pose: the first frame of its window lies there
  EXPECT_LT((updates[again].T_w_b.p - updates[gap - 1].T_w_b.p).norm(),
            (flight.truth(again).state.T_w_b.p - flight.truth(gap).state.T_w_b.p).norm() + 1.0);
  EXPECT_NEAR(updates[again].v_w_b.norm(), flight.truth(again).state.v_w_b.norm(), 0.2);
  expectEachIdOnce(updates);
}

TEST(Estimator, StartsAtRestAndTakesOff) {
  const DelayedStart resting(std::make_shared<FigureTrajectory>(), 3);
  const TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(7, 0.1), resting);
  const auto updates = run(flight);
  EXPECT_EQ(lostOf(updates), 0);
  std::size_t first = 0;
  while (first < updates.size() && !updates[first].hasPose()) ++first;
  EXPECT_LE(first, 25u) << "a pose while it still rests";
  EXPECT_TRUE(updates[first + 4].at_rest || updates[first + 5].at_rest);
  EXPECT_LT(updates[40].v_w_b.norm(), 0.05);
  EXPECT_LT((updates[48].T_w_b.p - updates[first].T_w_b.p).norm(), 0.03) << "drift while it rests";
  EXPECT_LT(positionError(updates, flight), 0.05);
}

TEST(Estimator, RestsWhileItsMotorsRunBeforeTakeOff) {
  const DelayedStart resting(std::make_shared<FigureTrajectory>(), 6);
  TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(9, 0.2), resting);
  constexpr std::size_t kMotorsOn = 40, kTakeOff = 115;  // 2 s, a little before 6 s
  for (std::size_t k = kMotorsOn; k < kTakeOff; ++k)
    for (std::size_t i = 0; i < flight.sim.frames[k].imu.size(); ++i) {
      ImuSample& sample = flight.sim.frames[k].imu[i];
      sample.accel += Eigen::Vector3d(0.05, -0.03, 0.02) + (i % 2 == 0 ? 1 : -1) * Eigen::Vector3d(0.8, 0.7, 1);
      sample.gyro += (i % 2 == 0 ? 0.06 : -0.06) * Eigen::Vector3d(1, -1, 0.5);
    }
  const auto updates = run(flight);
  EXPECT_EQ(lostOf(updates), 0);
  ASSERT_TRUE(updates[kMotorsOn].hasPose());
  EXPECT_TRUE(updates[kTakeOff - 1].at_rest || updates[kTakeOff - 2].at_rest);
  for (std::size_t k = kMotorsOn; k < kTakeOff; ++k)
    ASSERT_LT((updates[k].T_w_b.p - updates[kMotorsOn].T_w_b.p).norm(), 0.02) << "drift, frame " << k;
}

TEST(Estimator, OnlyAfterAStartInMotionTheAccelerometerHasCorrelatedNoise) {
  const auto noiseAfter = [](double rest_s) {
    const DelayedStart flown(std::make_shared<FigureTrajectory>(), rest_s);
    TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(rest_s + 5, 0.2), flown);
    for (std::size_t k = static_cast<std::size_t>(20 * rest_s); k < flight.sim.frames.size(); ++k)
      for (std::size_t i = 0; i < flight.sim.frames[k].imu.size(); ++i)  // its motors run
        flight.sim.frames[k].imu[i].accel.x() += i % 2 == 0 ? 2 : -2;
    std::set<bool> has_some;
    for (const WindowUpdate& update : run(flight))
      for (const RetiredKeyframe& keyframe : update.keyframes)
        if (keyframe.imu) has_some.insert(keyframe.imu->noise().accel_correlated > 0);
    return has_some;
  };
  EXPECT_EQ(noiseAfter(0), std::set<bool>{true});
  EXPECT_EQ(noiseAfter(3), std::set<bool>{false});
}

/// Another motion, later.
class Later : public Trajectory {
 public:
  Later(std::shared_ptr<const Trajectory> motion, double by_s) : motion_(std::move(motion)), by_s_(by_s) {}
  KinematicState at(double t_s) const override { return motion_->at(t_s + by_s_); }

 private:
  std::shared_ptr<const Trajectory> motion_;
  double by_s_;
};

TEST(Estimator, MotorsDoNotShrinkTheTimeOffset) {
  // a rate that is one sample's is wrong by its vibration, and the slope of a line through wrong abscissas is too small
  constexpr double kOffset_s = 0.002;
  const auto motion = std::make_shared<FigureTrajectory>();
  TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(9, 0.1), Later(motion, kOffset_s));
  const TrackedFlight on_time = fly(ImuSimulatorParams{}, tracksFor(9, 0.1), *motion);
  std::mt19937_64 random(5);
  std::normal_distribution<double> shaking(0, 0.15);
  Eigen::Vector3d angle = Eigen::Vector3d::Zero(), vibration = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < flight.sim.frames.size(); ++k) {
    ImuBatch& imu = flight.sim.frames[k].imu = on_time.sim.frames[k].imu;
    for (std::size_t i = 0; i < imu.size(); ++i) {
      if (i > 0 || k == 0) {  // a batch begins with the sample that ends the one before
        const Eigen::Vector3d former = angle;
        angle = Eigen::Vector3d(shaking(random), shaking(random), shaking(random));
        vibration = angle - former;  // it does not turn the body
      }
      imu[i].gyro += vibration;
    }
  }
  Estimator estimator(flight.rig, {});
  for (const SimulatedFrame& frame : flight.sim.frames) estimator.process(frame.tracks, frame.imu);
  EXPECT_NEAR(estimator.calibration().time_offset_s, kOffset_s, 0.15 * kOffset_s);
}

/// Of a gentle motion fifteen frames in a row, one and a half seconds, do not show the scale. While it is waited for,
/// the buffer becomes longer by frames that are left out between others.
TEST(Estimator, ABufferThatDoesNotShowTheScaleBecomesLonger) {
  FigureParams gentle;
  gentle.shake = 0;
  const TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(8, 0.3), FigureTrajectory(gentle));
  EstimatorParams params = withoutCalibration();
  params.initializer.max_frames = 15;
  const auto updates = run(flight, params, false);
  ASSERT_GT(posesOf(updates), 60);
  EXPECT_EQ(lostOf(updates), 0);
  const auto [estimate, truth] = positionsOf(updates, flight);
  EXPECT_NEAR(alignPositions(AlignmentKind::kSim3, estimate, truth).scale, 1, 0.08);
}

TEST(Estimator, PureRotationGivesNoPoseRatherThanAWrongOne) {
  FigureParams turning;
  turning.translation = 0;
  const TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(3, 0.5), FigureTrajectory(turning));
  const auto updates = run(flight);
  EXPECT_EQ(posesOf(updates), 0);
  EXPECT_NE(updates[60].reason, "");
}

/// The flight with nothing to be seen in some frames.
TrackedFlight darkened(TrackedFlight flight, std::size_t from, std::size_t frames) {
  for (std::size_t k = from; k < from + frames; ++k) {
    flight.sim.frames[k].tracks.points.clear();
    flight.sim.frames[k].tracks.lines.clear();
  }
  return flight;
}

TEST(Estimator, AFrameThatShowsNothingIsLeftToTheNextOne) {
  TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(6, 0.3));
  const std::size_t every = static_cast<std::size_t>(EstimatorParams{}.every_nth_frame);
  const std::size_t step = 5 * every + 1;  // the one after a dark frame enters the window, and every n-th from it on
  for (std::size_t k = 60; k < flight.sim.frames.size(); k += step) flight = darkened(flight, k, 1);
  const auto updates = run(flight);
  EXPECT_EQ(lostOf(updates), 0);
  for (std::size_t k = 60; k + 1 < updates.size(); k += step) {
    EXPECT_EQ(updates[k].status, EstimatorStatus::kPropagated) << k;
    EXPECT_EQ(updates[k + 1].status, EstimatorStatus::kTracking) << k;
  }
  EXPECT_LT(positionError(updates, flight), 0.03);
}

TEST(Estimator, BlindnessIsBridgedForAWhileAndThenAFailure) {
  const TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(6, 0.3));
  const std::size_t dark = 60, waits = 10;  // half a second for an image that shows something
  EstimatorParams params;
  params.failure.max_blind_frames = 20;
  const auto moment = run(darkened(flight, dark, 6), params);
  EXPECT_EQ(lostOf(moment), 0);
  EXPECT_TRUE(moment[dark + 5].hasPose());
  const std::size_t frames = waits + 2 * static_cast<std::size_t>(params.failure.max_blind_frames) + 6;
  const auto longer = run(darkened(flight, dark, frames), params);
  ASSERT_GE(lostOf(longer), 1);
  for (const WindowUpdate& u : longer)
    if (u.status == EstimatorStatus::kLost) {
      EXPECT_NE(u.reason, "");
      break;
    }
}

TEST(Estimator, FiveSecondsOfDarknessAreCarriedByTheImu) {
  const TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(14, 0.3));
  const std::size_t dark = 120, light = dark + 100;
  const auto updates = run(darkened(flight, dark, light - dark));
  EXPECT_EQ(lostOf(updates), 0);
  EXPECT_FALSE(updates[dark - 20].blind);
  EXPECT_TRUE(updates[dark + 50].blind);
  EXPECT_FALSE(updates.end()[-4].blind);
  for (std::size_t k = dark; k < flight.sim.frames.size(); ++k) ASSERT_TRUE(updates[k].hasPose()) << k;
  EXPECT_LT(positionError(updates, flight), 0.1) << "one frame before and after";
}

/// The flight with an accelerometer that shows `share` of the motion in the first `frames`: gravity stays.
TrackedFlight withSlowStart(TrackedFlight flight, std::size_t frames, double share) {
  const Eigen::Vector3d up_w = -gravityW();
  for (std::size_t k = 1; k < frames; ++k) {
    const InertialTruth &a = flight.truth(k - 1), &b = flight.truth(k);
    for (ImuSample& sample : flight.sim.frames[k].imu) {
      const double s = static_cast<double>(sample.t_ns - flight.sim.frames[k - 1].tracks.t_ns) /
                       static_cast<double>(flight.sim.frames[k].tracks.t_ns - flight.sim.frames[k - 1].tracks.t_ns);
      const Eigen::Vector3d up_b = a.state.T_w_b.q.slerp(s, b.state.T_w_b.q).conjugate() * up_w;
      sample.accel = up_b + share * (sample.accel - up_b);
    }
  }
  return flight;
}

/// The trajectory that is left when what wrong starts gave is withdrawn.
std::vector<std::pair<std::int64_t, Pose>> trajectoryOf(const std::vector<WindowUpdate>& updates) {
  std::vector<std::pair<std::int64_t, Pose>> poses;
  std::size_t settled = 0;
  for (const WindowUpdate& u : updates) {
    for (const FramePose& frame : u.replaced) poses.emplace_back(frame.t_ns, frame.T_w_b);
    if (u.hasPose()) poses.emplace_back(u.t_ns, u.T_w_b);
    if (u.startWasWrong()) poses.resize(settled);
    if (u.status == EstimatorStatus::kLost) settled = poses.size();
  }
  return poses;
}

TEST(Estimator, AWrongStartIsWithdrawnAndReplacedWithoutAGap) {
  const std::size_t wrong = 36;
  const TrackedFlight flight = withSlowStart(fly(ImuSimulatorParams{}, tracksFor(9, 0.3)), wrong, 3);
  const auto updates = run(flight);
  ASSERT_EQ(lostOf(updates), 1);
  std::size_t lost = 0, first = 0;
  while (!updates[first].hasPose()) ++first;
  while (updates[lost].status != EstimatorStatus::kLost) ++lost;
  EXPECT_LT(first, wrong);
  EXPECT_LE(lost, first + 60) << "while the start was on trial";
  EXPECT_TRUE(updates[lost].startWasWrong());
  EXPECT_EQ(updates[lost].reason.find("the start was wrong"), 0u) << updates[lost].reason;
  EXPECT_TRUE(updates[lost].keyframes.empty());
  EXPECT_TRUE(updates[lost].points.empty());
  EXPECT_TRUE(updates[lost].lines.empty());
  const auto trajectory = trajectoryOf(updates);
  EXPECT_LE(trajectory.front().first, flight.sim.frames[wrong].tracks.t_ns) << "where the accelerometer becomes right";
  std::vector<Eigen::Vector3d> estimate, truth;
  for (std::size_t i = 0, k = 0; i < trajectory.size(); ++i) {
    if (i > 0) {
      EXPECT_LE(trajectory[i].first - trajectory[i - 1].first, 50'000'000) << "a frame without a pose";
      EXPECT_GT(trajectory[i].first, trajectory[i - 1].first);
    }
    while (flight.sim.frames[k].tracks.t_ns != trajectory[i].first) ++k;
    estimate.push_back(trajectory[i].second.p);
    truth.push_back(flight.truth(k).state.T_w_b.p);
  }
  const Similarity T = alignPositions(AlignmentKind::kYaw, estimate, truth);
  double sum = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) sum += (T * estimate[i] - truth[i]).squaredNorm();
  EXPECT_LT(std::sqrt(sum / static_cast<double>(truth.size())), 0.1);
}

TEST(Estimator, FramesBetweenWindowFramesArePropagated) {
  const TrackedFlight flight = fly(perfectImu(), tracksFor(4, 0));
  const auto updates = run(flight);
  int propagated = 0;
  for (std::size_t k = 40; k < flight.sim.frames.size(); ++k) {
    const bool enters = k % 2 == 0;
    EXPECT_EQ(updates[k].status, enters ? EstimatorStatus::kTracking : EstimatorStatus::kPropagated);
    propagated += !enters;
    // both kinds lie on one smooth path
    const Eigen::Vector3d step = updates[k].T_w_b.p - updates[k - 1].T_w_b.p;
    EXPECT_LT((step - 0.05 * updates[k].v_w_b).norm(), 0.02);
  }
  EXPECT_EQ(propagated, 20);
}

}  // namespace
}  // namespace lintel
