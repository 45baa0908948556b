// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/estimator/Estimator.h"

#include <gmock/gmock.h>

#include <set>

#include "EstimatorRuns.h"
#include "lintel/geometry/Alignment.h"

namespace lintel {
namespace {

using namespace test;

/// A flight of 0.4 px of noise whose noise is drawn by `seed`.
TrackedFlight flightOf(std::uint64_t seed, double duration_s, const FigureParams& figure = {}) {
  ImuSimulatorParams imu;
  imu.seed = seed;
  TrackSimulationParams tracks = tracksFor(duration_s, 0.4);
  tracks.seed = seed;
  return fly(imu, tracks, FigureTrajectory(figure));
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

TEST(Estimator, PointsThatLastInThePriorMakeItBetter) {
  double log_ratio = 0;
  constexpr int kSeeds = 4;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const TrackedFlight flight = flightOf(seed, 10);
    EstimatorParams none;
    none.landmarks.lasting_points = 0;
    log_ratio += std::log(positionError(run(flight), flight) / positionError(run(flight, none), flight)) / kSeeds;
  }
  RecordProperty("with_over_without", std::to_string(std::exp(log_ratio)));
  EXPECT_LT(std::exp(log_ratio), 0.9);
}

TEST(Estimator, TheFramesOfAStartLeaveOneByOne) {
  FigureParams gentle;
  gentle.shake = 0;  // a start waits for its scale
  const TrackedFlight flight = fly(ImuSimulatorParams{}, tracksFor(8, 0.4), FigureTrajectory(gentle));
  std::size_t most = 0, of_the_start = 0;
  bool started = false;
  auto updates = run(flight);
  updates.pop_back();  // finish()'s: all that are left
  for (const WindowUpdate& update : updates) {
    if (update.status == EstimatorStatus::kTracking && !started) of_the_start = update.keyframes.size();
    started |= update.status == EstimatorStatus::kTracking;
    most = std::max(most, update.keyframes.size());
  }
  EXPECT_TRUE(started);
  EXPECT_EQ(of_the_start, 0U) << "none leaves when the first pose is found";
  EXPECT_LE(most, 2U);
}

/// Steps that damping shortens would leave the bias where the start began, and frames that come would move it.
TEST(Estimator, AStartIsSolvedToItsMinimum) {
  FigureParams gentle;
  gentle.shake = 0;
  double sum = 0;
  constexpr int kSeeds = 8;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    std::vector<Eigen::Vector3d> biases;
    for (const WindowUpdate& update : run(flightOf(seed, 5, gentle)))
      if (update.status == EstimatorStatus::kTracking) biases.push_back(update.bias.gyro);
    ASSERT_GT(biases.size(), 20U);
    sum += (biases[3] - biases[0]).squaredNorm() / kSeeds;
  }
  EXPECT_LT(std::sqrt(sum), 4e-4) << "[rad/s], in the first three frames";
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
