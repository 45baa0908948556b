// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "DriftedFlight.h"
#include "lintel/simulation/Random.h"

namespace lintel {
namespace {

class BatchRefinementTest : public test::DriftedFlight {};

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
