// SPDX-License-Identifier: BSD-3-Clause
#include "window/WindowCovariance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "DenseReference.h"
#include "TestWindow.h"
#include "landmarks/PointTriangulation.h"
#include "lintel/factors/PriorFactors.h"
#include "lintel/geometry/SmallMatrices.h"
#include "solver/Marginalizer.h"
#include "solver/ReducedSystem.h"
#include "window/WindowFactors.h"

namespace lintel {
namespace {

using namespace test;

/// Eight frames with points, and what is known about them.
class WindowCovarianceTest : public testing::Test {
 protected:
  WindowCovarianceTest() {
    TrackSimulationParams tracks;
    tracks.duration_s = 4;
    tracks.max_points_per_frame = 40;
    flight_ = fly(ImuSimulatorParams{}, tracks);
    window_ = trueWindow(flight_, 10, 8);
    triangulatePoints(window_, kParams.landmarks, 1);
  }

  /// All measurements, the biases of the first frame, the calibration; without the gauge.
  void addAll(WindowFactors& factors) const {
    factors.addImu();
    factors.addPoints();
    factors.add(makeBlockPrior(manifoldOf(BlockKey::kMotion), window_.frames[0].motion,
                               (Eigen::VectorXd(9) << 10, 10, 10, 0.1, 0.1, 0.1, 0.2, 0.2, 0.2).finished()),
                {{BlockKey::kMotion, window_.frames[0].id}});
    factors.addCalibrationPriors(kParams.calibration, flight_.rig.T_b_c);
  }

  WindowCovariance covariance(const std::vector<Factor>& factors) {
    std::vector<Factor> all = factors;
    WindowFactors gauge(window_, kParams.factors);
    gauge.addGauge();
    all.insert(all.end(), gauge.factors().begin(), gauge.factors().end());
    ReducedSystem system(window_, all, {}, {});
    system.linearise();
    return WindowCovariance(system.eliminate());
  }

  TrackedFlight flight_;
  SlidingWindow window_{eurocRig()};
};

/// What a shift and a turn of the world do to a pose.
Eigen::Matrix<double, 6, 4> byGauge(const Pose& T) {
  Eigen::Matrix<double, 6, 4> N = Eigen::Matrix<double, 6, 4>::Zero();
  N.topLeftCorner<3, 3>().setIdentity();
  N.block<3, 1>(0, 3) = Eigen::Vector3d::UnitZ().cross(T.p);
  N.block<3, 1>(3, 3) = T.R().row(2).transpose();
  return N;
}

TEST_F(WindowCovarianceTest, IsThatOfTheWholeProblemWithTheFirstPoseHeld) {
  WindowFactors factors(window_, kParams.factors);
  addAll(factors);
  const WindowCovariance window = covariance(factors.factors());
  ASSERT_TRUE(window.ok());
  const FrameId first = window_.frames[3].id;
  window.start(window_, first);
  // the same by a dense inverse: any gauge, then position and yaw of the first pose subtracted
  WindowFactors held(window_, kParams.factors);
  addAll(held);
  held.addGauge();
  const NormalEquations eq = linearise(window_, held.factors(), {});
  const Eigen::MatrixXd sigma = solved(eq.H, Eigen::MatrixXd::Identity(eq.H.rows(), eq.H.cols()));
  const auto offsetOf = [&](FrameId id) {
    const auto place = std::find(eq.blocks.begin(), eq.blocks.end(), BlockKey{BlockKey::kPose, id});
    return eq.offsets[static_cast<std::size_t>(place - eq.blocks.begin())];
  };
  const WindowFrame& newest = window_.frames.back();
  const Eigen::Matrix<double, 6, 4> N_first = byGauge(window_.frame(first).T_w_b());
  Eigen::Matrix<double, 4, 6> gauge = Eigen::Matrix<double, 4, 6>::Zero();  // a left inverse of N_first
  gauge.block<1, 3>(3, 3) = window_.frame(first).T_w_b().R().row(2);
  gauge.topLeftCorner<3, 3>().setIdentity();
  gauge.topRightCorner<3, 3>() = -N_first.block<3, 1>(0, 3) * gauge.block<1, 3>(3, 3);
  ASSERT_LT((gauge * N_first - Eigen::Matrix4d::Identity()).norm(), 1e-12);
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(6, eq.H.rows());
  F.middleCols<6>(offsetOf(newest.id)).setIdentity();
  F.middleCols<6>(offsetOf(first)) -= byGauge(newest.T_w_b()) * gauge;
  const Eigen::MatrixXd expected = F * sigma * F.transpose();
  const Eigen::MatrixXd found = window.of(window_, newest).topLeftCorner<6, 6>();
  EXPECT_LT((found - expected).norm(), 1e-5 * expected.norm());
}

TEST_F(WindowCovarianceTest, ScaleIsKnownAsTheLongestDistanceIs) {
  WindowFactors factors(window_, kParams.factors);
  addAll(factors);
  const double sigma = covariance(factors.factors()).relativeScaleSigma(window_);
  factors.addGauge();
  const NormalEquations eq = linearise(window_, factors.factors(), {});
  const Eigen::MatrixXd covariance = solved(eq.H, Eigen::MatrixXd::Identity(eq.H.rows(), eq.H.cols()));
  const auto offsetOf = [&](const WindowFrame& frame) {
    const auto place = std::find(eq.blocks.begin(), eq.blocks.end(), BlockKey{BlockKey::kPose, frame.id});
    return eq.offsets[static_cast<std::size_t>(place - eq.blocks.begin())];
  };
  const Eigen::Vector3d oldest = window_.frames.front().T_w_b().p;
  const Eigen::Index from = offsetOf(window_.frames.front());
  double longest = 0, expected = 0;
  for (const WindowFrame& frame : window_.frames) {
    const Eigen::Vector3d way = frame.T_w_b().p - oldest;
    if (way.norm() <= longest) continue;
    longest = way.norm();
    const Eigen::Index at = offsetOf(frame);
    const Eigen::Matrix3d difference = covariance.block<3, 3>(at, at) + covariance.block<3, 3>(from, from) -
                                       covariance.block<3, 3>(at, from) - covariance.block<3, 3>(from, at);
    expected = std::sqrt(way.dot(difference * way)) / way.squaredNorm();
  }
  EXPECT_NEAR(sigma, expected, 1e-5 * expected);
}

TEST_F(WindowCovarianceTest, AtRestNoScaleIsKnown) {
  WindowFactors factors(window_, kParams.factors);
  addAll(factors);
  const WindowCovariance covariance = this->covariance(factors.factors());
  for (WindowFrame& frame : window_.frames) frame.pose = window_.frames.front().pose;
  EXPECT_EQ(covariance.relativeScaleSigma(window_), std::numeric_limits<double>::infinity());
}

TEST_F(WindowCovarianceTest, TheFirstPoseItselfHasNoneOfPositionAndYaw) {
  WindowFactors factors(window_, kParams.factors);
  addAll(factors);
  const WindowCovariance window = covariance(factors.factors());
  const WindowFrame& first = window_.frames[5];
  const StateCovariance exact = window.start(window_, first.id), P = window.of(window_, first);
  const Eigen::Matrix3d positions = exact.topLeftCorner<3, 3>();
  EXPECT_EQ(positions, Eigen::Matrix3d::Zero());
  EXPECT_LT((P - exact).norm(), 1e-6 * P.norm()) << "that is what the equations say";
  const Eigen::Matrix3d turn = first.T_w_b().R() * exact.block<3, 3>(3, 3) * first.T_w_b().R().transpose();
  EXPECT_LT(turn(2, 2), 1e-9 * turn(0, 0)) << "roll and pitch are as open as they are";
}

/// Nothing is lost when the oldest frame leaves: what the prior holds and the drift that is accumulated give the same
/// covariance as the window before.
TEST_F(WindowCovarianceTest, OutlivesTheFirstPose) {
  const FrameId first = window_.frames[0].id;
  WindowFactors factors(window_, kParams.factors);
  addAll(factors);
  const WindowCovariance before = covariance(factors.factors());
  before.start(window_, first);
  const StateCovariance expected = before.of(window_, window_.frames.back());
  ASSERT_GT(expected(0, 0), 0);

  before.holdNext(window_);
  std::vector<Factor> leaving, staying;
  for (const Factor& factor : factors.factors()) {
    const bool leaves = std::any_of(factor.blocks.begin(), factor.blocks.end(), [&](const BlockKey& key) {
      return isLandmark(key) || ((key.kind == BlockKey::kPose || key.kind == BlockKey::kMotion) && key.id == first);
    });
    (leaves ? leaving : staying).push_back(factor);
  }
  const auto prior = marginalise(window_, leaving, {{BlockKey::kPose, first}, {BlockKey::kMotion, first}});
  ASSERT_TRUE(prior);
  EXPECT_EQ(window_.drift.by_state.count({BlockKey::kPose, first}), 0u);
  staying.push_back(factorOf(*prior));
  window_.frames.pop_front();
  const WindowCovariance after = covariance(staying);
  ASSERT_TRUE(after.ok());
  const StateCovariance found = after.of(window_, window_.frames.back());
  EXPECT_LT((found - expected).norm(), 1e-4 * expected.norm());
  // and the accumulated drift is needed for that
  window_.drift = {};
  EXPECT_GT((covariance(staying).of(window_, window_.frames.back()) - expected).norm(), 0.01 * expected.norm());
}

TEST_F(WindowCovarianceTest, AFirstPoseThatIsNoKeyframeIsRememberedByTheOthers) {
  WindowFactors factors(window_, kParams.factors);
  addAll(factors);
  const WindowCovariance window = covariance(factors.factors());
  const FrameId first = window_.frames[6].id;
  window.start(window_, first);
  const StateCovariance expected = window.of(window_, window_.frames.back());
  window.forget(window_, first);
  EXPECT_EQ(window_.drift.by_state.count({BlockKey::kPose, first}), 0u);
  const StateCovariance found = window.of(window_, window_.frames.back());
  const double sigma = std::sqrt(expected(0, 0)), after = std::sqrt(found(0, 0));
  EXPECT_GT(after, 0.9 * sigma);
  EXPECT_LT(after, 5 * sigma) << "their errors are correlated, and that is not forgotten";
}

/// As after images that went dark: the states are less certain than they were when the drift was accumulated.
TEST_F(WindowCovarianceTest, NoVarianceIsNegativeWhereInformationIsLost) {
  WindowFactors factors(window_, kParams.factors);
  addAll(factors);
  const WindowCovariance window = covariance(factors.factors());
  window.start(window_, window_.frames[5].id);
  window_.drift.covariance *= 0.01;
  for (int steps = 0; steps < 2; ++steps) {
    for (const WindowFrame& frame : window_.frames) {
      const StateCovariance P = window.of(window_, frame);
      const Eigen::VectorXd own = symmetricEigen<Eigen::Dynamic>(P).values;
      EXPECT_GT(own.minCoeff(), -1e-9 * own.maxCoeff());
    }
    window.holdNext(window_);
  }
}

}  // namespace
}  // namespace lintel
