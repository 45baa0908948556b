// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "TestFactors.h"
#include "lintel/factors/AxesImuFactor.h"
#include "lintel/factors/ImageObservations.h"
#include "lintel/factors/ImuFactor.h"
#include "lintel/factors/LineFactor.h"
#include "lintel/factors/Manifolds.h"
#include "lintel/factors/PointFactor.h"
#include "lintel/factors/StructuralFactor.h"
#include "lintel/factors/VanishingFactor.h"
#include "lintel/geometry/Frames.h"
#include "lintel/geometry/Rotation.h"
#include "lintel/inertial/ImuAxes.h"

namespace lintel {
namespace {

using testing::expectGradients, testing::kLineManifold, testing::kMotion, testing::kPoseManifold, testing::Scene;

RayObservation observation(double x, double y) {
  RayObservation o;
  o.ray = {x, y, 1};
  o.correction_jacobian = 0.01 * ObservationJacobian::Ones();
  o.correction_jacobian(0, 2) = -0.02;
  return o;
}

LineEnd lineEnd(double x, double y, double scale_px) {
  LineEnd end;
  static_cast<RayObservation&>(end) = observation(x, y);
  end.linearised_scale_px = scale_px;
  end.log_scale_jacobian << 0.002, 0.003, -0.001, 0.004, 0.2, 0.1;
  return end;
}

Camera eurocCamera() { return {752, 480, 458.654, 457.296, 367.215, 248.375, -0.28, 0.074, 2e-4, 1.8e-5}; }

TEST(PointFactor, HandComputed) {
  // Camera j stands 1 m to the right of the origin; the point is 2 m ahead of the origin, thus at x/z = -0.5.
  const PoseBlock right = toBlock(Pose{Eigen::Quaterniond::Identity(), {1, 0, 0}}), identity = toBlock(Pose{});
  const CorrectionBlock zero = CorrectionBlock::Zero();
  const PointBlock point(0, 0, 2, 1);
  const Camera camera{640, 480, 100, 100, 320, 240, 0, 0, 0, 0};
  PointFactor factor({280, 250}, camera, {}, Eigen::Vector3d::Zero(), 2);
  const double* blocks[] = {right.data(), identity.data(), zero.data(), point.data()};
  Eigen::Vector2d r;
  ASSERT_TRUE(factor.Evaluate(blocks, r.data(), nullptr));
  EXPECT_NEAR(r.x(), -5, 1e-12);  // seen at (270, 240)
  EXPECT_NEAR(r.y(), -5, 1e-12);
}

TEST(PointFactor, TimeOffsetMovesTheCamera) {
  // At 2 m/s to the right an offset of 50 ms is 0.1 m: 5 px at 2 m and a focal length of 100 px.
  const PoseBlock identity = toBlock(Pose{});
  CorrectionBlock correction = CorrectionBlock::Zero();
  correction[kTimeOffsetAt] = 0.05;
  const PointBlock point(0, 0, 2, 1);
  const Camera camera{640, 480, 100, 100, 320, 240, 0, 0, 0, 0};
  PointFactor factor({320, 240}, camera, {{2, 0, 0}, {0, 0, 0}}, Eigen::Vector3d::Zero(), 1);
  const double* blocks[] = {identity.data(), identity.data(), correction.data(), point.data()};
  Eigen::Vector2d r;
  ASSERT_TRUE(factor.Evaluate(blocks, r.data(), nullptr));
  EXPECT_NEAR(r.x(), -5, 1e-12);
  EXPECT_NEAR(r.y(), 0, 1e-12);
}

TEST(PointFactor, RowsOfARollingShutterHaveTheirOwnTimes) {
  // As above, by a readout that is 200 ms longer than what the sighting was moved by: its row, a quarter after the
  // middle one, was exposed 50 ms later.
  const PoseBlock identity = toBlock(Pose{});
  CorrectionBlock correction = CorrectionBlock::Zero();
  correction[kReadoutAt] = 0.21;
  const PointBlock point(0, 0, 2, 1);
  const Camera camera{640, 480, 100, 100, 320, 240, 0, 0, 0, 0};
  PointFactor factor({320, 240}, camera, {{2, 0, 0}, {0, 0, 0}}, Eigen::Vector3d::Zero(), 1, {0.25, 0.01});
  const double* blocks[] = {identity.data(), identity.data(), correction.data(), point.data()};
  Eigen::Vector2d r;
  ASSERT_TRUE(factor.Evaluate(blocks, r.data(), nullptr));
  EXPECT_NEAR(r.x(), -5, 1e-12);
  EXPECT_NEAR(r.y(), 0, 1e-12);
}

TEST(PointFactor, GradientsFromNearToInfinity) {
  const Scene s;
  const PointManifold manifold;
  const CorrectionBlock correction = (CorrectionBlock() << 1, -1, 0.5, 2, 0.01, -0.003, 0, 0.004).finished();
  const Pose T_w_c = poseFromBlock(s.T_w_bi.data()) * poseFromBlock(s.T_b_c.data());
  for (const double inverse_depth : {0.0, 0.02, 0.3, 2.0}) {
    PointBlock point;
    point << T_w_c.q * Eigen::Vector3d(0.2, -0.1, 1), inverse_depth;
    point.normalize();
    PointFactor factor({350, 260}, eurocCamera(), kMotion, T_w_c.p + Eigen::Vector3d(0.1, 0, 0), 0.7, {0.4, 0});
    expectGradients(factor, {&kPoseManifold, &kPoseManifold, nullptr, &manifold},
                    {s.T_w_bi.data(), s.T_b_c.data(), correction.data(), point.data()});
  }
}

TEST(LineFactor, HandComputed) {
  // A line parallel to x, 4 m ahead and 2 m down: seen as y = 0.5. Its moment is taken about (0, 0, 3).
  const Eigen::Vector3d origin(0, 0, 3);
  const LineBlock line = toBlock(toOrthonormal(movedOrigin(lineThrough({-1, 2, 4}, {1, 2, 4}), origin)));
  const PoseBlock identity = toBlock(Pose{});
  const CorrectionBlock zero = CorrectionBlock::Zero();
  LineFactor factor(lineEnd(-0.3, 0.5, 50), lineEnd(0.3, 0.6, 50), {}, origin, 0.5);
  const double* blocks[] = {identity.data(), identity.data(), zero.data(), line.data()};
  Eigen::Vector2d r;
  ASSERT_TRUE(factor.Evaluate(blocks, r.data(), nullptr));
  EXPECT_NEAR(std::abs(r[0]), 0, 1e-9);
  EXPECT_NEAR(std::abs(r[1]), 10, 1e-9);
}

TEST(LineFactor, GradientsFromFarToNearlyThroughTheCameraAndTheOrigin) {
  const Scene s;
  const Pose T_w_c = poseFromBlock(s.T_w_bi.data()) * poseFromBlock(s.T_b_c.data());
  for (const double distance : {0.05, 0.5, 3.0, 50.0}) {
    const Eigen::Vector3d p0 = T_w_c * Eigen::Vector3d(0.1 * distance, -0.2 * distance, distance);
    const Eigen::Vector3d p1 = T_w_c * Eigen::Vector3d(0.4 * distance, 0.1 * distance, 1.3 * distance);
    for (const double offset : {1e-3, 0.3, 2.0}) {
      const Eigen::Vector3d origin = p0 + offset * Eigen::Vector3d(0.3, -0.5, 0.8);
      const LineBlock line = toBlock(toOrthonormal(movedOrigin(lineThrough(p0, p1), origin)));
      LineFactor factor(lineEnd(0.12, -0.2, 300), lineEnd(0.3, 0.08, 290), kMotion, origin, 0.8);
      expectGradients(factor, {&kPoseManifold, &kPoseManifold, nullptr, &kLineManifold},
                      {s.T_w_bi.data(), s.T_b_c.data(), s.correction.data(), line.data()}, 1e-5);
    }
  }
}

TEST(LineFactor, RowsOfARollingShutterHaveTheirOwnTimes) {
  // A vertical edge 2 m away, at 2 m/s to the right: the readout is 200 ms longer than what the ends were moved by. The
  // upper one, a quarter before the middle row, was exposed 50 ms earlier (0.1 m, 5 px at a focal length of 100 px),
  // the lower one an eighth after it.
  const PoseBlock identity = toBlock(Pose{});
  CorrectionBlock correction = CorrectionBlock::Zero();
  correction[kReadoutAt] = 0.21;
  const LineBlock line = toBlock(toOrthonormal(lineThrough({0, -1, 2}, {0, 1, 2})));
  LineFactor factor(lineEnd(0, -0.5, 100), lineEnd(0, 0.5, 100), {{2, 0, 0}, {0, 0, 0}}, Eigen::Vector3d::Zero(), 1,
                    {-0.25, 0.01}, {0.125, 0.01});
  const double* blocks[] = {identity.data(), identity.data(), correction.data(), line.data()};
  Eigen::Vector2d r;
  ASSERT_TRUE(factor.Evaluate(blocks, r.data(), nullptr));
  EXPECT_NEAR(std::abs(r.x()), 5, 1e-9);
  EXPECT_NEAR(r.x() / r.y(), -2, 1e-9);
}

TEST(LineFactor, GradientsByTheReadout) {
  const Scene s;
  const CorrectionBlock correction = (CorrectionBlock() << 1, -1, 0.5, 2, 0.01, -0.003, 0.02, 0.004).finished();
  const Pose T_w_c = poseFromBlock(s.T_w_bi.data()) * poseFromBlock(s.T_b_c.data());
  const Eigen::Vector3d p0 = T_w_c * Eigen::Vector3d(0.2, -0.4, 2), p1 = T_w_c * Eigen::Vector3d(0.8, 0.2, 2.6);
  const LineBlock line = toBlock(toOrthonormal(movedOrigin(lineThrough(p0, p1), p0)));
  LineFactor factor(lineEnd(0.12, -0.2, 300), lineEnd(0.3, 0.08, 290), kMotion, p0, 0.8, {-0.3, 0.02}, {0.1, 0.02});
  expectGradients(factor, {&kPoseManifold, &kPoseManifold, nullptr, &kLineManifold},
                  {s.T_w_bi.data(), s.T_b_c.data(), correction.data(), line.data()}, 1e-5);
}

TEST(LineFactor, DerivativesOfALineThroughTheCameraAreBounded) {
  const PoseBlock identity = toBlock(Pose{});
  const CorrectionBlock zero = CorrectionBlock::Zero();
  for (const double distance_m : {1e-2, 1e-5, 1e-9}) {
    const LineBlock line = toBlock(toOrthonormal(lineThrough({-1, distance_m, 4}, {1, distance_m, -4})));
    LineFactor factor(lineEnd(-0.3, 0.5, 50), lineEnd(0.3, 0.6, 50), {}, Eigen::Vector3d::Zero(), 1);
    const double* blocks[] = {identity.data(), identity.data(), zero.data(), line.data()};
    Eigen::Vector2d r;
    Eigen::Matrix<double, 2, kPoseSize, Eigen::RowMajor> by_pose;
    double* jacobians[] = {by_pose.data(), nullptr, nullptr, nullptr};
    ASSERT_TRUE(factor.Evaluate(blocks, r.data(), jacobians));
    EXPECT_LT(by_pose.cwiseAbs().maxCoeff(), 50 / 0.05) << "focal length over the least distance";
  }
}

TEST(LineFactor, IsInPixelsOfTheCorrectedCamera) {
  // The distance of the observed pixels to the image of the line, near the correction about which the ends are
  // linearised, however large that is; of a short line, which hardly bends between its ends.
  const Camera camera = eurocCamera();
  const PoseBlock identity = toBlock(Pose{});
  for (const Eigen::Vector2d& at : {Eigen::Vector2d(100, 60), Eigen::Vector2d(400, 250), Eigen::Vector2d(700, 420)})
    for (const double angle : {0.0, 0.7, 1.5}) {
      const Eigen::Vector2d along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
      CorrectionBlock correction;
      correction << 22, 8.5, 11, -4, 0.253, -0.062, 0, 0;
      CorrectionBlock near;
      near << 20, 10, 10, -5, 0.25, -0.06, 0, 0;
      const Camera corrected = correctedCamera(camera, correction.data());
      // a line through the image of two points, seen 2 px beside it
      const auto ray = [&](const Eigen::Vector2d& px) { return corrected.normalise(px).homogeneous().eval(); };
      const LineBlock line = toBlock(toOrthonormal(lineThrough(ray(at - 4 * along), ray(at + 4 * along))));
      const auto [start, end] = makeLineEnds(camera, at - 4 * along + 2 * across, at + 4 * along + 2 * across, near);
      const double* blocks[] = {identity.data(), identity.data(), correction.data(), line.data()};
      Eigen::Vector2d r;
      ASSERT_TRUE(LineFactor(start, end, {}, Eigen::Vector3d::Zero(), 0.5).Evaluate(blocks, r.data(), nullptr));
      EXPECT_NEAR(std::abs(r[0]), 4, 0.05) << at.transpose() << " " << angle;
      EXPECT_NEAR(std::abs(r[1]), 4, 0.05) << at.transpose() << " " << angle;
    }
}

TEST(LineEnd, BelongsToTheLineThatFitsTheWholeEdge) {
  // The front end fits a straight line of the calibrated camera to an edge; through the true camera the edge is the
  // straight one. The ends under the true correction lie on it, to what the fit leaves of the bend, and not where the
  // pixels of the fit's ends are.
  const Camera truth = eurocCamera();
  Camera calibrated = truth;
  calibrated.lens[0] *= 1.1;
  CorrectionBlock correction = CorrectionBlock::Zero();
  correction[4] = truth.lens[0] - calibrated.lens[0];
  const Eigen::Vector2d from = truth.normalise({120, 40}), to = truth.normalise({640, 70});
  const int n = 200;
  Eigen::Matrix2d H = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  std::vector<double> x;
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector2d edge = from + (i + 0.5) / n * (to - from);
    const Eigen::Vector2d seen = calibrated.normalise(truth.project(edge.homogeneous()));
    const Eigen::Vector2d row(1, seen.x());
    H += row * row.transpose();
    b += row * seen.y();
    x.push_back(seen.x());
  }
  const Eigen::Vector2d line = H.inverse() * b;
  const auto pixel = [&](double at) { return calibrated.project(Eigen::Vector3d(at, line[0] + line[1] * at, 1)); };
  const Eigen::Vector2d start_px = pixel(x.front()), end_px = pixel(x.back());
  const auto [start, end] = makeLineEnds(calibrated, start_px, end_px, correction);
  const Eigen::Vector2d along = (to - from).normalized(), across(-along.y(), along.x());
  const auto error_px = [&](const Eigen::Vector2d& at) { return truth.fx * std::abs(across.dot(at - from)); };
  EXPECT_GT(error_px(truth.normalise(start_px)), 1) << "the fit's own end";
  EXPECT_LT(error_px(start.ray.head<2>()), 0.1);
  EXPECT_LT(error_px(end.ray.head<2>()), 0.1);
  // and to first order, about no correction
  const auto [linear_start, linear_end] = makeLineEnds(calibrated, start_px, end_px);
  EXPECT_LT(error_px(linear_start.corrected(correction.data()).head<2>()), 0.5);
  EXPECT_LT(error_px(linear_end.corrected(correction.data()).head<2>()), 0.5);
}

TEST(LineEnd, ScaleFollowsTheCorrection) {
  const Camera camera = eurocCamera();
  const Eigen::Vector2d start_px(80, 50), end_px(180, 130);
  const LineEnd end = makeLineEnds(camera, start_px, end_px).first;
  for (int k = 0; k < kIntrinsicsSize; ++k) {
    const double step = k < 4 ? 0.1 : 1e-3;
    const auto scale = [&](double by) {
      CorrectionBlock correction = CorrectionBlock::Zero();
      correction[k] = by;
      const Camera moved = correctedCamera(camera, correction.data());
      return makeLineEnds(moved, start_px, end_px).first.linearised_scale_px;
    };
    const double numeric = (scale(step) - scale(-step)) / (2 * step) / end.linearised_scale_px;
    // the line's own turn on the normalised plane is left out
    EXPECT_NEAR(end.log_scale_jacobian[k], numeric, 0.05 * std::abs(numeric) + 1e-6) << k;
  }
}

LineBlock lineAlong(const Eigen::Vector3d& d, const Eigen::Vector3d& p = {1, 2, 0.5}) {
  return toBlock(toOrthonormal(lineThrough(p, p + d)));
}

TEST(StructuralFactors, AreTheSineOfTheAngleWhateverTheSign) {
  const double angle = 0.3;
  const LineBlock i = lineAlong({1, 0, 0}), j = lineAlong({std::cos(angle), std::sin(angle), 0});
  const DirectionBlock along(1, 0, 0), against(-std::cos(angle), -std::sin(angle), 0);
  Eigen::Vector3d r;
  const double *pair[] = {i.data(), j.data()}, *parallel[] = {i.data(), along.data()},
               *turned[] = {i.data(), against.data()};
  ASSERT_TRUE(ParallelLinesFactor(50).Evaluate(pair, r.data(), nullptr));
  EXPECT_NEAR(r.norm(), 50 * std::sin(angle), 1e-12);
  ASSERT_TRUE(SharedDirectionFactor(50).Evaluate(parallel, r.data(), nullptr));
  EXPECT_NEAR(r.norm(), 0, 1e-12);
  ASSERT_TRUE(SharedDirectionFactor(50).Evaluate(turned, r.data(), nullptr));
  EXPECT_NEAR(r.norm(), 50 * std::sin(angle), 1e-12);
}

TEST(StructuralFactors, GradientsFromParallelToPerpendicularAndForLinesThroughTheOrigin) {
  const DirectionManifold direction_manifold;
  const Eigen::Vector3d axis = Eigen::Vector3d(0.2, 0.3, -0.9).normalized(), d(1, 0.1, 0.3);
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(1, 2, 0.5), Eigen::Vector3d(0, 0, 1e-5), Eigen::Vector3d(0, 90, 0)})
    for (const double angle : {0.0, 1e-6, 0.01, 1.0, 1.57, 3.1}) {
      const Eigen::Vector3d turned = Eigen::AngleAxisd(angle, axis) * d;
      const LineBlock i = lineAlong(d, p), j = lineAlong(turned);
      const DirectionBlock group = turned.normalized();
      expectGradients(SharedDirectionFactor(57), {&kLineManifold, &direction_manifold}, {i.data(), group.data()});
      expectGradients(ParallelLinesFactor(57), {&kLineManifold, &kLineManifold}, {i.data(), j.data()});
    }
}

TEST(VanishingFactor, IsTheAngleBetweenPlaneAndDirection) {
  // The plane of the image line y = 0.5 holds the x axis and (0, 0.5, 1).
  const PoseBlock identity = toBlock(Pose{});
  const CorrectionBlock zero = CorrectionBlock::Zero();
  VanishingFactor factor(observation(-0.3, 0.5), observation(0.3, 0.5), {}, 100);
  const double angle = 0.1;
  const Eigen::Vector3d normal = Eigen::Vector3d(0, 1, -0.5).normalized();
  for (const double sign : {1.0, -1.0}) {
    const DirectionBlock in_plane(1, 0, 0), off = std::cos(angle) * in_plane + sign * std::sin(angle) * normal;
    double r = 0;
    const double* blocks[] = {identity.data(), identity.data(), zero.data(), in_plane.data()};
    ASSERT_TRUE(factor.Evaluate(blocks, &r, nullptr));
    EXPECT_NEAR(r, 0, 1e-12);
    blocks[3] = off.data();
    ASSERT_TRUE(factor.Evaluate(blocks, &r, nullptr));
    EXPECT_NEAR(std::abs(r), 100 * std::sin(angle), 1e-9);
  }
}

TEST(VanishingFactor, GradientsForShortAndLongLines) {
  const Scene s;
  const DirectionManifold direction_manifold;
  const DirectionBlock direction = Eigen::Vector3d(0.5, -0.2, 0.8).normalized();
  for (const double length : {0.02, 0.3, 1.0}) {
    VanishingFactor factor(observation(0.12, -0.2), observation(0.12 + length, -0.2 + 0.5 * length), kMotion, 200);
    expectGradients(factor, {&kPoseManifold, &kPoseManifold, nullptr, &direction_manifold},
                    {s.T_w_bi.data(), s.T_b_c.data(), s.correction.data(), direction.data()}, 1e-5);
  }
}

std::shared_ptr<Preintegration> somePreintegration(const ImuNoise& noise = {}) {
  auto preintegration = std::make_shared<Preintegration>(ImuBias{{0.01, 0.02, -0.01}, {0.05, 0, 0.1}}, noise);
  ImuBatch samples;
  for (int i = 0; i <= 20; ++i) {
    const double t = 0.005 * i;
    samples.push_back({1'400'000'000'000'000'000 + i * std::int64_t{5'000'000},
                       {0.5 * std::sin(9 * t), 0.4, -0.3 * std::cos(5 * t)},
                       {std::cos(7 * t), 2 * t, 9.8 + std::sin(20 * t)}});
  }
  preintegration->append(samples);
  return preintegration;
}

TEST(ImuFactor, IsZeroForTheIntegratedMotion) {
  const auto pre = somePreintegration();
  const Pose T_w_bi{expRotation({0.3, 0.1, -1}), {1, 2, 3}};
  const Eigen::Vector3d v_i(0.4, -0.2, 0.1);
  const double dt = pre->dt_s();
  const Pose T_w_bj{T_w_bi.q * pre->deltaR(),
                    T_w_bi.p + v_i * dt + 0.5 * gravityW() * dt * dt + T_w_bi.q * pre->deltaP()};
  MotionBlock motion_i, motion_j;
  motion_i << v_i, pre->bias().gyro, pre->bias().accel;
  motion_j << v_i + gravityW() * dt + T_w_bi.q * pre->deltaV(), pre->bias().gyro, pre->bias().accel;
  const PoseBlock pose_i = toBlock(T_w_bi), pose_j = toBlock(T_w_bj);
  const MeanBiasBlock mean(3, 4, 5);  // without correlated noise it does not count
  const double* blocks[] = {pose_i.data(), motion_i.data(), pose_j.data(), motion_j.data(), mean.data()};
  Eigen::Matrix<double, 15, 1> r;
  ASSERT_TRUE(ImuFactor(pre).Evaluate(blocks, r.data(), nullptr));
  EXPECT_LT(r.norm(), 1e-6);
}

TEST(ImuFactor, CorrelatedNoiseDecaysTowardsTheMeanBias) {
  ImuNoise noise;
  noise.accel_walk = 1e-6;
  noise.accel_correlated = 0.03;
  const auto pre = somePreintegration(noise);
  const double a = std::exp(-0.1 / kAccelCorrelation_s);
  ASSERT_NEAR(pre->dt_s(), 0.1, 1e-9);
  const PoseBlock pose = toBlock(Pose{});
  const MeanBiasBlock mean(0.2, -0.1, 0.3);
  MotionBlock motion_i = MotionBlock::Zero(), motion_j = MotionBlock::Zero();
  motion_i.segment<3>(kBiasAccelAt) = mean + Eigen::Vector3d(0.05, 0, -0.02);
  motion_j.segment<3>(kBiasAccelAt) = mean + a * Eigen::Vector3d(0.05, 0, -0.02);
  const double* blocks[] = {pose.data(), motion_i.data(), pose.data(), motion_j.data(), mean.data()};
  Eigen::Matrix<double, 15, 1> r;
  ASSERT_TRUE(ImuFactor(pre).Evaluate(blocks, r.data(), nullptr));
  EXPECT_LT(r.tail<3>().norm(), 1e-9);
  // in the long run by its standard deviation: what is new within the interval has the rest of the variance
  motion_j[kBiasAccelAt] += 0.03 * std::sqrt(1 - a * a);
  ASSERT_TRUE(ImuFactor(pre).Evaluate(blocks, r.data(), nullptr));
  EXPECT_NEAR(r[12], 1, 1e-6);
}

const Eigen::Vector3d kMean_f(0.4, 0.1, 9.7);

TEST(ImuFactor, Gradients) {
  ImuNoise noise;
  noise.accel_correlated = 0.03;
  const auto pre = somePreintegration(noise);
  const PoseBlock pose_i = toBlock(Pose{expRotation({0.3, 0.1, -1}), {1, 2, 3}});
  const PoseBlock pose_j = toBlock(Pose{expRotation({0.32, 0.13, -1.05}), {1.04, 2, 3.02}});
  MotionBlock motion_i, motion_j;
  motion_i << 0.4, -0.2, 0.1, 0.02, 0.01, -0.03, 0.1, 0.05, 0.2;
  motion_j << 0.5, -0.1, 0.1, 0.021, 0.012, -0.03, 0.12, 0.05, 0.21;
  const MeanBiasBlock mean(0.08, 0.02, 0.15);
  expectGradients(ImuFactor(pre), {&kPoseManifold, nullptr, &kPoseManifold, nullptr, nullptr},
                  {pose_i.data(), motion_i.data(), pose_j.data(), motion_j.data(), mean.data()}, 1e-5);
  AxesBlock axes;
  axes << 0.01, -0.02, 0, 0.05, -0.01, 0.03, 0, 0.02, 0.004, 0.01, -0.02, 0.005, 0.01, -0.01, 0.02;
  expectGradients(AxesImuFactor(pre, kMean_f), {&kPoseManifold, nullptr, &kPoseManifold, nullptr, nullptr, nullptr},
                  {pose_i.data(), motion_i.data(), pose_j.data(), motion_j.data(), mean.data(), axes.data()}, 1e-5);
}

TEST(AxesImuFactor, IsTheImuFactorOfCorrectedSamples) {
  const auto pre = somePreintegration();
  const PoseBlock pose_i = toBlock(Pose{expRotation({0.3, 0.1, -1}), {1, 2, 3}});
  const PoseBlock pose_j = toBlock(Pose{expRotation({0.32, 0.13, -1.05}), {1.04, 2, 3.02}});
  MotionBlock motion;
  motion << 0.4, -0.2, 0.1, pre->bias().gyro, pre->bias().accel;
  const MeanBiasBlock mean(0.08, 0.02, 0.15);
  ImuAxes axes{Eigen::Matrix3d::Zero(), kMean_f};
  axes.A << 0.01, -0.02, 0, 0.05, -0.01, 0.03, 0, 0.02, 0.004;
  const auto difference = [&] {
    const AxesBlock block = toBlock(axes);
    const double* blocks[] = {pose_i.data(), motion.data(), pose_j.data(), motion.data(), mean.data(), block.data()};
    Eigen::Matrix<double, 15, 1> r, corrected;
    const ImuFactor as_measured(pre), right(std::make_shared<Preintegration>(withAxes(*pre, axes)));
    EXPECT_TRUE(AxesImuFactor(pre, kMean_f).Evaluate(blocks, r.data(), nullptr));
    EXPECT_TRUE(right.Evaluate(blocks, corrected.data(), nullptr));
    // of other weights: the covariance depends on the samples
    r.head<9>() = as_measured.sqrtInformation().inverse() * r.head<9>();
    corrected.head<9>() = right.sqrtInformation().inverse() * corrected.head<9>();
    return (r - corrected).norm() / r.norm();
  };
  EXPECT_LT(difference(), 1e-9) << "linear in A";
  axes.A.setZero();
  axes.G.diagonal() << 0.02, -0.01, 0.01;
  axes.G(0, 2) = axes.G(2, 0) = 0.02;
  EXPECT_LT(difference(), 1e-3) << "to first order in G";
}

TEST(AxesBlock, HoldsBothSensors) {
  ImuAxes axes;
  axes.A << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  axes.G << 10, 13, 14, 13, 11, 15, 14, 15, 12;
  const AxesBlock block = toBlock(axes);
  for (int i = 0; i < kAxesSize; ++i) EXPECT_EQ(block[i], i + 1);
  const ImuAxes same = axesFromBlock(block.data(), kMean_f);
  EXPECT_EQ(same.A, axes.A);
  EXPECT_EQ(same.G, axes.G);
  EXPECT_EQ(same.mean_f, kMean_f);
}

}  // namespace
}  // namespace lintel
