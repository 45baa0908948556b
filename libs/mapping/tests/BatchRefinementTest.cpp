// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/BatchRefinement.h"

#include <gtest/gtest.h>

#include <functional>

#include "lintel/geometry/Alignment.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/mapping/MapBuilder.h"
#include "lintel/simulation/EurocRig.h"
#include "lintel/simulation/FigureTrajectory.h"
#include "lintel/simulation/Random.h"
#include "lintel/simulation/TrackSimulation.h"

namespace lintel {
namespace {

/// A simulated flight of four seconds, every fifth frame a keyframe; the causal poses drift away from the truth.
class BatchRefinementTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    TrackSimulationParams tracks;
    tracks.duration_s = 4;
    tracks.max_points_per_frame = 60;
    tracks.max_lines_per_frame = 20;
    tracks.point_noise_px = tracks.line_noise_px = 0.3;
    ImuSimulatorParams imu;
    imu.initial_gyro_bias = imu.initial_accel_bias = 0;
    flight_ = simulateTracks(FigureTrajectory(), eurocRig(), imu, tracks);
  }
  static void TearDownTestSuite() { flight_ = {}; }

  BatchRefinementTest() {
    MapBuilder builder(rig_, {});
    const Eigen::Vector3d drift(0.02, -0.03, 0.01), turn(0.001, 0.001, 0.006);  // a second
    std::shared_ptr<Preintegration> imu;
    std::map<TrackId, RetiredPoint> points;
    std::map<TrackId, RetiredLine> lines;
    WindowUpdate last;
    for (std::size_t i = 0; i < flight_.frames.size(); ++i) {
      const SimulatedFrame& frame = flight_.frames[i];
      const double t = 1e-9 * static_cast<double>(frame.tracks.t_ns - flight_.frames[0].tracks.t_ns);
      if (imu) imu->append(frame.imu);
      WindowUpdate update;
      update.t_ns = frame.tracks.t_ns;
      update.status = EstimatorStatus::kTracking;
      update.T_w_b = frame.truth.state.T_w_b;
      update.T_w_b.p += t * drift;
      update.T_w_b.q = expRotation(t * turn) * update.T_w_b.q;
      builder.add(update);
      if (i % 5 != 0) continue;
      last.keyframes.push_back(
          {i, update.t_ns, update.T_w_b, frame.truth.state.v_w_b + drift, {}, imu, false, false, {}, 0});
      imu = std::make_shared<Preintegration>(ImuBias{}, rig_.imu_noise);
      imu->append({frame.imu.back()});
      for (const PointObservation& o : frame.tracks.points) {
        points[o.id].triangulated = false;
        points[o.id].id = o.id;
        points[o.id].sightings.push_back({i, {}, o.px});
      }
      for (const LineObservation& o : frame.tracks.lines) {
        lines[o.id].triangulated = false;
        lines[o.id].id = o.id;
        lines[o.id].sightings.push_back({i, {}, {}, o.start_px, o.end_px, 1.0});
      }
    }
    for (auto& [id, point] : points) last.points.push_back(point);
    for (auto& [id, line] : lines) last.lines.push_back(line);
    builder.add(last);
    material_ = builder.material();
    estimator_.calibration.refine_camera = estimator_.calibration.refine_extrinsics =
        estimator_.calibration.refine_time_offset = false;
  }

  Similarity alignment(const MapMaterial& material) const {
    std::vector<Eigen::Vector3d> estimate, truth;
    for (std::size_t i = 0; i < material.trajectory.size(); ++i) {
      estimate.push_back(material.trajectory[i].second.p);
      truth.push_back(flight_.frames[i].truth.state.T_w_b.p);
    }
    return alignPositions(AlignmentKind::kYaw, estimate, truth);
  }
  double scale(const MapMaterial& material) const {
    std::vector<Eigen::Vector3d> estimate, truth;
    for (const RetiredKeyframe& k : material.keyframes) {
      estimate.push_back(k.T_w_b.p);
      truth.push_back(flight_.frames[k.id].truth.state.T_w_b.p);
    }
    return alignPositions(AlignmentKind::kSim3, estimate, truth).scale;
  }
  double error(const MapMaterial& material) const {
    const Similarity T = alignment(material);
    double sum = 0;
    for (std::size_t i = 0; i < material.trajectory.size(); ++i)
      sum += (T * material.trajectory[i].second.p - flight_.frames[i].truth.state.T_w_b.p).squaredNorm();
    return std::sqrt(sum / static_cast<double>(material.trajectory.size()));
  }
  RefinementReport refine(MapMaterial& material, const std::vector<PointJoin>& joins = {}) const {
    return BatchRefinement(rig_, estimator_, map_, params_).refine(material, {}, joins);
  }
  /// In the middle of the flight it is dark for a second: points are other tracks afterwards; the joins say which.
  std::vector<PointJoin> splitTracks() {
    constexpr TrackId kAfter = 1'000'000;
    const FrameId dark = flight_.frames.size() / 2 - 10, light = dark + 20;
    std::vector<PointJoin> joins;
    std::vector<PointRecord> split;
    for (const PointRecord& point : material_.points) {
      PointRecord before = point, after = point;
      after.id += kAfter;
      before.views.clear();
      after.views.clear();
      for (const PointView& view : point.views) {
        if (view.keyframe < dark) before.views.push_back(view);
        if (view.keyframe >= light) after.views.push_back(view);
      }
      if (before.views.size() > 3 && after.views.size() > 3) joins.push_back({before.id, after.id, 1});
      if (before.views.size() > 1) split.push_back(before);
      if (after.views.size() > 1) split.push_back(after);
    }
    std::sort(split.begin(), split.end(), [](const PointRecord& a, const PointRecord& b) { return a.id < b.id; });
    material_.points = split;
    return joins;
  }

  /// All points but those held out, every twentieth, slide by three pixels from keyframe to keyframe.
  static void slideAllButHeldOut(RefinementParams& params, MapMaterial& material) {
    params.lines = false;
    params.max_imu_error = params.max_moved_m = 1000;
    for (PointRecord& point : material.points)
      if (point.id % 20 != 1)
        for (PointView& view : point.views) view.px.x() += 0.6F * static_cast<float>(view.keyframe);
  }

  /// From keyframe `first` on the images' stamps are late: they show the world of so much earlier. Points only.
  void delayStamps(FrameId first, double late_s) {
    material_.lines.clear();
    for (PointRecord& point : material_.points)
      for (PointView& view : point.views) {
        if (view.keyframe < first) continue;
        const InertialTruth& truth = flight_.frames[view.keyframe].truth;
        const Pose &now = truth.state.T_w_b,
                   then{now.q * expRotation(-late_s * truth.state.omega_b), now.p - late_s * truth.state.v_w_b};
        const Eigen::Vector3d& p_w = flight_.points_w[flight_.point_of_track[point.track]];
        view.px += (rig_.camera.project((then * rig_.T_b_c).inverse() * p_w) -
                    rig_.camera.project((now * rig_.T_b_c).inverse() * p_w))
                       .cast<float>();
      }
  }

  static SimulatedTracks flight_;
  const Rig rig_ = eurocRig();
  EstimatorParams estimator_;
  MapParams map_;
  RefinementParams params_;
  MapMaterial material_;
};
SimulatedTracks BatchRefinementTest::flight_;

TEST_F(BatchRefinementTest, TakesTheDriftAway) {
  const double before = error(material_);
  const RefinementReport report = refine(material_);
  EXPECT_TRUE(report.accepted) << report.verdict;
  EXPECT_GT(before, 0.02);
  EXPECT_LT(error(material_), 0.2 * before);
  EXPECT_LT(report.held_out_after_px, report.held_out_before_px);
  EXPECT_LT(report.imu_after, 1.5);
  EXPECT_EQ(material_.trajectory.size(), flight_.frames.size()) << "every frame has a refined pose";
  EXPECT_NE(report.verdict.find("refined"), std::string::npos);
  EXPECT_NE(report.verdict.find("; the size of everything is known to "), std::string::npos) << report.verdict;
  EXPECT_GT(report.scale_sigma, 0.005) << "the accelerometer's own scale";
  EXPECT_LT(report.scale_sigma, 0.02);
}

/// Poses of a start are off by centimetres, views of near landmarks by pixels: those mend the poses.
TEST_F(BatchRefinementTest, ViewsThatWrongPosesPutOffHaveResiduals) {
  for (RetiredKeyframe& keyframe : material_.keyframes)
    if (keyframe.t_ns - flight_.frames[0].tracks.t_ns < 1'000'000'000)
      keyframe.T_w_b.p += Eigen::Vector3d(0, keyframe.id % 2 ? 0.03 : -0.03, 0);
  params_.rounds = 1;
  MapMaterial narrow = material_, all = material_;
  const std::size_t residuals = refine(material_).residuals;
  params_.view_max_error_px = 1000;
  EXPECT_EQ(residuals, refine(all).residuals) << "none is 10 px off";
  params_.view_max_error_px = 2;
  EXPECT_GT(residuals, refine(narrow).residuals + 100);
  EXPECT_LT(error(material_), error(narrow));
}

/// On long flights each landmark has fewer views in the adjustment.
TEST_F(BatchRefinementTest, ViewsOfAllLandmarksTogetherAreBounded) {
  MapMaterial all = material_;
  const RefinementReport unbounded = refine(all);
  params_.most_residuals = 600;
  const double before = error(material_);
  const RefinementReport report = refine(material_);
  EXPECT_TRUE(report.accepted) << report.verdict;
  const std::size_t others = 2 * report.points + 15 * material_.keyframes.size() + 100;  // lengths, IMU, priors
  EXPECT_GT(unbounded.residuals, 2 * 1000 + others) << "else the bound means nothing";
  EXPECT_LT(report.residuals, 2 * 600 + others);
  EXPECT_NEAR(static_cast<double>(report.points), static_cast<double>(unbounded.points), 2)
      << "or every second is left out";
  EXPECT_LT(error(material_), 0.3 * before);
}

/// With still more landmarks than views, some take no part.
TEST_F(BatchRefinementTest, LandmarksAreBoundedWhereEachWouldHaveTooFewViews) {
  params_.most_residuals = 600;
  MapMaterial more = material_;
  const RefinementReport all = refine(more);
  params_.most_residuals = static_cast<int>(all.points + all.lines);
  const double before = error(material_);
  const RefinementReport report = refine(material_);
  EXPECT_TRUE(report.accepted) << report.verdict;
  EXPECT_LT(report.points + report.lines, (all.points + all.lines) / 2) << "every fourth";
  EXPECT_GT(report.points + report.lines, (all.points + all.lines) / 6);
  EXPECT_LT(error(material_), 0.5 * before);
}

TEST_F(BatchRefinementTest, IsRefusedWherePointsLeftOutFitWorse) {
  slideAllButHeldOut(params_, material_);
  const double before = error(material_);
  const RefinementReport report = refine(material_);
  EXPECT_GE(report.held_out, 5u);
  EXPECT_GT(report.held_out_growth, 2);
  EXPECT_FALSE(report.accepted);
  EXPECT_NE(report.verdict.find("points left out of it fit worse"), std::string::npos) << report.verdict;
  EXPECT_EQ(error(material_), before) << "the poses stay";
}

TEST_F(BatchRefinementTest, TwoPointsLeftOutDoNotDecide) {
  int held_out = 0;
  for (PointRecord& point : material_.points)
    if (point.id % 20 == 1 && point.views.size() > 3 && ++held_out > 2) point.id += 1'000'001;  // held out no more
  std::sort(material_.points.begin(), material_.points.end(),
            [](const PointRecord& a, const PointRecord& b) { return a.id < b.id; });
  slideAllButHeldOut(params_, material_);
  const RefinementReport report = refine(material_);
  EXPECT_EQ(report.held_out, 2u);
  EXPECT_GT(report.held_out_after_px, 1.02 * report.held_out_before_px + 0.01);
  EXPECT_TRUE(report.accepted) << report.verdict;
}

TEST_F(BatchRefinementTest, ErrorsOfTheCamerasAreAsLargeAsItSays) {
  ASSERT_TRUE(refine(material_).accepted);
  ASSERT_EQ(material_.camera_errors.size(), material_.keyframes.size());
  const Similarity S = [&] {
    std::vector<Eigen::Vector3d> estimate, truth;
    for (const RetiredKeyframe& k : material_.keyframes) {
      estimate.push_back(k.T_w_b.p);
      truth.push_back(flight_.frames[k.id].truth.state.T_w_b.p);
    }
    return alignPositions(AlignmentKind::kSe3, estimate, truth);
  }();
  double shift2 = 0, turn2 = 0, said_shift2 = 0, said_turn2 = 0;
  for (std::size_t i = 0; i < material_.keyframes.size(); ++i) {
    const Pose& truth = flight_.frames[material_.keyframes[i].id].truth.state.T_w_b;
    const Pose T = S.T_a_b * material_.keyframes[i].T_w_b;
    shift2 += (T.p - truth.p).squaredNorm();
    turn2 += logRotation(truth.q.conjugate() * T.q).squaredNorm();
    said_shift2 += material_.camera_errors[i].topRows<3>().squaredNorm() / kErrorDraws;
    said_turn2 += material_.camera_errors[i].bottomRows<3>().squaredNorm() / kErrorDraws;
  }
  // one flight: its error as a whole may be half or twice of what is usual, and the draws' mean is off by a quarter
  EXPECT_GT(said_shift2, shift2 / 5);
  EXPECT_LT(said_shift2, shift2 * 5);
  EXPECT_GT(said_turn2, turn2 / 5);
  EXPECT_LT(said_turn2, turn2 * 5);
}

TEST_F(BatchRefinementTest, ACancelledRefinementLeavesPosesAndEstimatesLandmarks) {
  for (const double when : {0.0, 0.25, 0.7}) {  // at the start, within a round, when lines are merged
    MapMaterial refused = material_, prepared = material_;
    std::vector<double> told;
    const RefinementReport report = BatchRefinement(rig_, estimator_, {}, params_).refine(refused, [&](double done) {
      told.push_back(done);
      return done < when;
    });
    EXPECT_FALSE(report.accepted);
    EXPECT_EQ(report.verdict, "not refined: the run was cancelled");
    ASSERT_GE(told.size(), 2u);
    EXPECT_EQ(told.back(), 1);
    EXPECT_LT(told[told.size() - 2], when + 0.2) << "it went on";
    prepareMaterial({}, prepared);
    EXPECT_EQ(error(refused), error(prepared));
    const LineMap map = drawMap({}, refused), expected = drawMap({}, prepared);
    ASSERT_EQ(map.lines.size(), expected.lines.size());
    ASSERT_FALSE(map.lines.empty());
    for (std::size_t i = 0; i < map.lines.size(); ++i)
      EXPECT_EQ(map.lines[i].segment_w.start, expected.lines[i].segment_w.start);
  }
}

TEST_F(BatchRefinementTest, LandmarksComeOutWhereTheyAre) {
  refine(material_);
  const Similarity T = alignment(material_);
  int lines = 0;
  for (const MapLine& line : drawMap({}, material_).lines) {
    const Segment3& segment = flight_.lines_w[flight_.line_of_track[line.id]];
    EXPECT_LT(lineAngle(T.T_a_b.q * line.segment_w.direction(), segment.direction()),
              0.02 + 3 * line.sigma_direction_rad);
    const Eigen::Vector3d middle = T * line.segment_w.midpoint();
    EXPECT_LT((middle - segment.start).cross(segment.direction()).norm(), 0.02 + 3 * line.sigma_distance_m);
    ++lines;
  }
  EXPECT_GT(lines, 10);
}

TEST_F(BatchRefinementTest, LinesOfAGroupShareTheirDirection) {
  MapMaterial free = material_;
  params_.groups = false;
  const RefinementReport without = refine(free);
  params_.groups = true;
  const RefinementReport with = refine(material_);
  ASSERT_TRUE(with.accepted && without.accepted);
  const LineMap map = drawMap({}, material_);
  const auto members = std::count_if(map.lines.begin(), map.lines.end(), [](const MapLine& l) { return l.group >= 0; });
  ASSERT_GE(members, 5);
  EXPECT_GE(with.residuals, without.residuals + std::size_t{2} * 5) << "two residuals each";
  EXPECT_LT(error(material_), 1.05 * error(free));
}

TEST_F(BatchRefinementTest, PointsSeenAgainTieTheirVisitsTogether) {
  const std::vector<PointJoin> joins = splitTracks();
  ASSERT_GT(joins.size(), 15u);
  MapMaterial apart = material_;
  params_.lines = false;
  map_.merge.point_max_error_px = 0.01;  // nothing else joins them
  ASSERT_TRUE(refine(apart).accepted);
  const RefinementReport report = refine(material_, joins);
  EXPECT_TRUE(report.accepted) << report.verdict;
  EXPECT_FALSE(report.joins_refused);
  EXPECT_GT(report.joined, 15);
  EXPECT_LT(error(material_), 0.9 * error(apart));
}

/// As a false loop would say: points after the middle are those 0.4 m beside them before it.
TEST_F(BatchRefinementTest, AFalseLoopBendsNothing) {
  std::vector<PointJoin> joins = splitTracks();
  MapMaterial apart = material_;
  ASSERT_TRUE(refine(apart).accepted);
  std::map<TrackId, Eigen::Vector3d> p_w;
  for (const PointRecord& point : apart.points)
    if (point.known) p_w[point.id] = point.p_w;
  const std::vector<PointJoin> right = joins;
  for (PointJoin& join : joins) {
    if (p_w.count(join.b) == 0) continue;
    const Eigen::Vector3d beside = p_w[join.b] + Eigen::Vector3d(0.4, 0, 0);
    const auto nearer = [&](const PointJoin& x, const PointJoin& y) {
      const auto distance = [&](TrackId id) { return p_w.count(id) > 0 ? (p_w[id] - beside).norm() : 1e9; };
      return distance(x.a) < distance(y.a);
    };
    join.a = std::min_element(right.begin(), right.end(), nearer)->a;
    join.votes = 5;
  }
  const RefinementReport report = refine(material_, joins);
  EXPECT_TRUE(report.accepted) << report.verdict;
  EXPECT_LT(error(material_), 1.05 * error(apart) + 1e-4);
}

/// Landmarks with wrong sightings raise the cost of single steps, and the scale is weakly observed: the adjustment must
/// not end early.
TEST_F(BatchRefinementTest, EndsWhereMoreEffortWouldEnd) {
  constexpr double kWrongScale = 1.03;
  for (RetiredKeyframe& k : material_.keyframes) k.T_w_b.p *= kWrongScale, k.v_w_b *= kWrongScale;
  for (auto& [t_ns, T_w_b] : material_.trajectory) T_w_b.p *= kWrongScale;
  RandomStream random(5);
  for (PointRecord& point : material_.points)
    for (PointView& view : point.views)
      if (random.uniform(0, 1) < 0.05)
        view.px += Eigen::Vector2d(random.uniform(-6, 6), random.uniform(-6, 6)).cast<float>();
  MapMaterial thorough = material_;
  const RefinementReport report = refine(material_);
  ASSERT_TRUE(report.accepted) << report.verdict;
  params_.rounds = 12;
  params_.max_iterations = 60;
  refine(thorough);
  EXPECT_LT(error(material_), 1.1 * error(thorough) + 1e-4) << "more effort would still have changed it";
}

/// By how much the way bends between the keyframes that are adjusted comes from the poses as they were.
TEST_F(BatchRefinementTest, KeyframesBetweenTheAdjustedOnesDoNotHoldTheScale) {
  constexpr double kWrongScale = 1.04;
  for (RetiredKeyframe& k : material_.keyframes) k.T_w_b.p *= kWrongScale, k.v_w_b *= kWrongScale;
  for (auto& [t_ns, T_w_b] : material_.trajectory) T_w_b.p *= kWrongScale;
  params_.most_keyframes = 12;  // of 16: six are adjusted
  params_.rounds = 1;
  const RefinementReport report = refine(material_);
  ASSERT_TRUE(report.accepted) << report.verdict;
  EXPECT_NEAR(scale(material_), 1, 0.02);
}

TEST_F(BatchRefinementTest, TheSameBitsEveryTime) {
  MapMaterial other = material_;
  refine(material_);
  refine(other);
  ASSERT_EQ(material_.keyframes.size(), other.keyframes.size());
  for (std::size_t i = 0; i < material_.keyframes.size(); ++i) {
    EXPECT_EQ(material_.keyframes[i].T_w_b.p, other.keyframes[i].T_w_b.p);
    EXPECT_EQ(material_.keyframes[i].T_w_b.q.coeffs(), other.keyframes[i].T_w_b.q.coeffs());
  }
  EXPECT_EQ(material_.rig.camera.fx, other.rig.camera.fx);
}

TEST_F(BatchRefinementTest, WhatTheImuContradictsIsNotUsed) {
  for (RetiredKeyframe& keyframe : material_.keyframes) {
    if (!keyframe.imu) continue;
    ImuBatch wrong = keyframe.imu->samples();
    for (std::size_t i = 0; i < wrong.size(); ++i) wrong[i].accel *= i % 2 ? 1.6 : 0.3;
    for (ImuSample& s : wrong) s.gyro.x() += s.t_ns % 2'000'000'000 < 1'000'000'000 ? 0.3 : -0.3;
    auto imu = std::make_shared<Preintegration>(ImuBias{}, rig_.imu_noise);
    imu->append(wrong);
    keyframe.imu = imu;
  }
  const std::vector<RetiredKeyframe> before = material_.keyframes;
  const RefinementReport report = refine(material_);
  EXPECT_FALSE(report.accepted);
  EXPECT_NE(report.verdict.find("not refined"), std::string::npos);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(material_.keyframes[i].T_w_b.p, before[i].T_w_b.p);
  EXPECT_TRUE(std::any_of(material_.lines.begin(), material_.lines.end(), [](const LineRecord& l) { return l.known; }))
      << "the map is made with the poses as they were";
}

TEST_F(BatchRefinementTest, AChangeThatIsTooLargeIsNotUsed) {
  params_.max_moved_m = params_.max_moved_share = 0;
  const RefinementReport report = refine(material_);
  EXPECT_FALSE(report.accepted);
  EXPECT_NE(report.verdict.find("moved"), std::string::npos) << report.verdict;
}

TEST_F(BatchRefinementTest, AfterAStartThatFailsItIsTriedFromWhereThePosesWere) {
  MapMaterial elsewhere = material_, as_it_was = material_;
  const auto tearApart = [](MapMaterial& start) {  // the adjustment cannot mend it
    for (RetiredKeyframe& keyframe : start.keyframes) keyframe.T_w_b.p.x() += keyframe.id % 2 ? 1e6 : -1e6;
  };
  const BatchRefinement refinement(rig_, estimator_, map_, params_);
  const RefinementReport report = refinement.refine(elsewhere, {}, {}, tearApart);
  EXPECT_TRUE(report.accepted) << report.verdict;
  EXPECT_TRUE(report.joins_refused);
  EXPECT_FALSE(refinement.refine(as_it_was).joins_refused);
  EXPECT_EQ(error(elsewhere), error(as_it_was));
}

TEST_F(BatchRefinementTest, WhereNothingWasSeenKeyframesMayMoveFarther) {
  params_.max_moved_m = params_.max_moved_share = 0;
  for (std::size_t k = 2; k + 2 < material_.keyframes.size(); ++k) material_.keyframes[k].blind = true;
  const RefinementReport report = refine(material_);
  EXPECT_TRUE(report.accepted) << report.verdict;
}

TEST_F(BatchRefinementTest, ProgressGoesFromNothingToAll) {
  std::vector<double> done;
  BatchRefinement(rig_, estimator_, {}, params_).refine(material_, [&](double d) {
    done.push_back(d);
    return true;
  });
  ASSERT_GT(done.size(), 3u);
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
  EXPECT_EQ(done.back(), 1);
}

TEST_F(BatchRefinementTest, TheOffsetBetweenTheClocksMayJump) {
  const FrameId middle = flight_.frames.size() / 2;
  delayStamps(middle, 0.006);
  estimator_.calibration.refine_time_offset = true;
  MapMaterial same = material_;
  const RefinementReport report = refine(material_);
  EXPECT_TRUE(report.accepted) << report.verdict;
  EXPECT_NEAR(report.most_offset_s - report.least_offset_s, 0.006, 0.001);
  for (const RetiredKeyframe& keyframe : material_.keyframes) {
    const double from_middle_s = 0.05 * (static_cast<double>(keyframe.id) - static_cast<double>(middle));
    if (std::abs(from_middle_s) < 1) continue;  // the stretch that it jumps in
    EXPECT_NEAR(material_.time_offset_s + keyframe.offset_change_s, from_middle_s < 0 ? 0 : -0.006, 0.001)
        << keyframe.id;
  }
  params_.offset_walk_s = 0;
  refine(same);
  EXPECT_EQ(same.keyframes.front().offset_change_s, 0);
  EXPECT_LT(error(material_), 0.6 * error(same));
}

TEST_F(BatchRefinementTest, ARecordingThatWasMadeEarlierHasAnOffsetOfItsOwn) {
  MapMaterial earlier = material_;
  earlier.lines.clear();
  delayStamps(0, 0.003);
  estimator_.calibration.refine_time_offset = true;
  for (RetiredKeyframe& keyframe : earlier.keyframes) keyframe.t_ns -= 3'600'000'000'000;
  material_.pieces = separatePieces(material_), earlier.pieces = separatePieces(earlier);
  earlier.time_offset_s = 0.004;
  const std::size_t first = material_.keyframes.size();
  material_.trajectory.clear(), earlier.trajectory.clear();
  appendMaterial(earlier, material_);
  const RefinementReport report = refine(material_);
  EXPECT_TRUE(report.accepted) << report.verdict;
  for (const std::size_t k : {std::size_t{0}, first - 1, first, material_.keyframes.size() - 1})
    EXPECT_NEAR(material_.time_offset_s + material_.keyframes[k].offset_change_s, k < first ? -0.003 : 0, 6e-4) << k;
}

/// The keyframes' IMU with another error of the accelerometer, by the time since the first one, and with noise.
void disturb(MapMaterial& material, double correlated, const std::function<Eigen::Vector3d(double)>& error) {
  ImuNoise noise;
  noise.accel_correlated = correlated;
  const std::int64_t start_ns = material.keyframes.front().t_ns;
  for (RetiredKeyframe& keyframe : material.keyframes) {
    if (!keyframe.imu) continue;
    ImuBatch samples = keyframe.imu->samples();
    for (ImuSample& sample : samples) sample.accel += error(1e-9 * static_cast<double>(sample.t_ns - start_ns));
    auto imu = std::make_shared<Preintegration>(keyframe.imu->bias(), noise);
    imu->append(samples);
    keyframe.imu = imu;
  }
}

TEST_F(BatchRefinementTest, AnErrorOfTheAccelerometerThatComesAndGoesIsNoMotion) {
  const auto error_b = [](double t_s) -> Eigen::Vector3d {
    return Eigen::Vector3d(std::sin(3 * t_s), 0, std::cos(2 * t_s)) * 0.1;
  };
  MapMaterial without = material_;
  disturb(material_, 0.07, error_b);
  disturb(without, 0, error_b);
  const RefinementReport report = refine(material_);
  EXPECT_TRUE(report.accepted);
  EXPECT_LT(report.axes.cwiseAbs().maxCoeff(), 4 * estimator_.calibration.axes_angle_sigma_rad)
      << "nor a fault of its axes";
  refine(without);
  EXPECT_LT(error(material_), 0.6 * error(without));
}

/// An IMU whose samples f and w show the specific force f + A f and the rate w + G w.
void misalign(MapMaterial& material, const Eigen::Matrix3d& A, const Eigen::Matrix3d& G = Eigen::Matrix3d::Zero()) {
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  for (RetiredKeyframe& keyframe : material.keyframes) {
    if (!keyframe.imu) continue;
    ImuBatch samples = keyframe.imu->samples();
    for (ImuSample& sample : samples) {
      sample.accel = (I + A).inverse() * sample.accel;
      sample.gyro = (I + G).inverse() * sample.gyro;
    }
    auto imu = std::make_shared<Preintegration>(keyframe.imu->bias(), keyframe.imu->noise());
    imu->append(samples);
    keyframe.imu = imu;
  }
}

Eigen::Matrix3d axesOfATelephone() {
  Eigen::Matrix3d axes;
  axes << 0.004, -0.02, 0, 0.05, -0.006, -0.03, -0.01, 0.02, 0.01;
  return axes;
}

TEST_F(BatchRefinementTest, WrongAxesOfTheAccelerometerAreFoundAndItsSamplesCorrected) {
  const Eigen::Matrix3d axes = axesOfATelephone();
  misalign(material_, axes);
  MapMaterial held = material_;
  const RefinementReport report = refine(material_);
  EXPECT_TRUE(report.accepted) << report.verdict;
  EXPECT_LT((report.axes - axes).norm(), 0.5 * axes.norm()) << report.axes;
  EXPECT_NEAR(report.axes(1, 2), axes(1, 2), 0.003);  // of what varies most
  EXPECT_GT(report.scale_sigma, report.axes.norm() / 3) << "nor is its scale known better than its axes";
  estimator_.calibration.refine_axes = false;
  EXPECT_LT(refine(held).axes.norm(), 1e-6);
  const auto spread = [](const MapMaterial& m) {
    Eigen::Vector3d least = m.keyframes.front().bias.accel, most = least;
    for (const RetiredKeyframe& keyframe : m.keyframes) {
      least = least.cwiseMin(keyframe.bias.accel);
      most = most.cwiseMax(keyframe.bias.accel);
    }
    return (most - least).norm();
  };
  EXPECT_LT(spread(material_), 0.3 * spread(held)) << "what was taken for a bias that changes";
}

TEST_F(BatchRefinementTest, WrongAxesOfTheGyroscopeAreFound) {
  Eigen::Matrix3d G;
  G << 0.015, 0.01, 0, 0.01, -0.02, -0.01, 0, -0.01, 0.01;
  misalign(material_, Eigen::Matrix3d::Zero(), G);
  const RefinementReport report = refine(material_);
  EXPECT_TRUE(report.accepted) << report.verdict;
  EXPECT_LT((report.gyro_axes - G).norm(), 0.3 * G.norm()) << report.gyro_axes;
  EXPECT_LT(report.axes.cwiseAbs().maxCoeff(), 0.01) << "the accelerometer's are right";
}

TEST_F(BatchRefinementTest, AxesBeyondThePriorOfACalibratedSensorAreHeldLessFirmly) {
  estimator_.calibration.axes_scale_sigma = 0.0004;
  estimator_.calibration.axes_angle_sigma_rad = 0.001;
  const auto found = [&](double share) {
    MapMaterial material = material_;
    misalign(material, share * axesOfATelephone());
    const RefinementReport report = refine(material);
    return report.axes(1, 2) / (share * axesOfATelephone()(1, 2));
  };
  EXPECT_GT(found(1), 4 * found(0.1)) << "one prior would find the same share of both";
}

TEST_F(BatchRefinementTest, EachRecordingHasAMeanBiasOfItsOwn) {
  MapMaterial other = material_;
  const Eigen::Vector3d bias(0.25, -0.2, 0.15);
  disturb(material_, 0.005, [](double) { return Eigen::Vector3d(0, 0, 0); });
  disturb(other, 0.005, [&](double) { return bias; });
  material_.pieces = separatePieces(material_), other.pieces = separatePieces(other);
  const std::size_t first = material_.keyframes.size();
  material_.trajectory.clear(), other.trajectory.clear();
  appendMaterial(other, material_);
  EXPECT_TRUE(refine(material_).accepted);
  for (std::size_t k = 0; k < material_.keyframes.size(); ++k)
    EXPECT_LT((material_.keyframes[k].bias.accel - (k < first ? Eigen::Vector3d(0, 0, 0) : bias)).norm(), 0.04) << k;
}

TEST_F(BatchRefinementTest, AnOffsetThatStaysIsFoundTheSameAllTheTime) {
  delayStamps(0, 0.003);
  estimator_.calibration.refine_time_offset = true;
  const RefinementReport report = refine(material_);
  EXPECT_NEAR(material_.time_offset_s, -0.003, 3e-4);
  EXPECT_LT(report.most_offset_s - report.least_offset_s, 5e-4);
}

TEST_F(BatchRefinementTest, AnAbsurdScaleIsRefusedByName) {
  for (const double scale : {0.0, -1.0, 1e9, std::nan("")}) {
    params_.sigma_scale = scale;
    EXPECT_THROW(refine(material_), std::invalid_argument) << scale;
  }
}

TEST_F(BatchRefinementTest, TooLittleToRefineSaysSo) {
  MapMaterial empty;
  empty.rig = rig_;
  const RefinementReport report = refine(empty);
  EXPECT_FALSE(report.accepted);
  EXPECT_NE(report.verdict.find("keyframes"), std::string::npos);
}

/// The IMU has a gap in the middle; what comes after was brought to the same frame, some centimetres off.
TEST_F(BatchRefinementTest, PiecesOfOneWorldAreHeldByTheirPointsAlone) {
  const std::vector<PointJoin> joins = splitTracks();
  const FrameId second = 5 * ((flight_.frames.size() / 2 + 9) / 5);
  for (RetiredKeyframe& keyframe : material_.keyframes)
    if (keyframe.id == second) keyframe.imu.reset();
  material_.pieces = separatePieces(material_);
  ASSERT_EQ(material_.pieces.size(), 2u);
  const MapMaterial truth_like = material_;
  movePiece(1, {expRotation({0, 0, 0.01}), {0.06, -0.05, 0.03}}, material_);
  MapMaterial joined = material_, separate = material_;
  joined.pieces[1].world = 0;
  EXPECT_TRUE(refine(joined, joins).accepted);
  EXPECT_LT(error(joined), 0.012);
  refine(separate);
  EXPECT_GT(error(separate), 0.02) << "each keeps its own frame";
}

}  // namespace
}  // namespace lintel
