// SPDX-License-Identifier: BSD-3-Clause
#include <ceres/gradient_checker.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lintel/factors/ImageObservations.h"
#include "lintel/factors/ImuFactor.h"
#include "lintel/factors/LineFactor.h"
#include "lintel/factors/Manifolds.h"
#include "lintel/factors/PointFactor.h"
#include "lintel/factors/PriorFactors.h"
#include "lintel/factors/StructuralFactor.h"
#include "lintel/factors/VanishingFactor.h"
#include "lintel/geometry/Frames.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

const PoseManifold kPoseManifold;
const LineManifold kLineManifold;

/// Analytic against numeric Jacobians in the tangent spaces.
void expectGradients(const ceres::CostFunction& cost, const std::vector<const ceres::Manifold*>& manifolds,
                     const std::vector<const double*>& blocks, double tolerance = 1e-6) {
  ceres::NumericDiffOptions options;
  options.ridders_relative_initial_step_size = 1e-5;  // the default 1e-2 jumps over a line's own extent
  ceres::GradientChecker checker(&cost, &manifolds, options);
  ceres::GradientChecker::ProbeResults results;
  checker.Probe(blocks.data(), tolerance, &results);
  ASSERT_TRUE(results.return_value);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    // relative to the block's largest entry: a component that is exactly zero has no relative error of its own
    const Eigen::MatrixXd difference = results.local_jacobians[i] - results.local_numeric_jacobians[i];
    const double scale = std::max(1e-3, results.local_numeric_jacobians[i].cwiseAbs().maxCoeff());
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), tolerance * scale) << "block " << i << "\n" << results.error_log;
  }
}

RayObservation observation(double x, double y) {
  RayObservation o;
  o.ray = {x, y, 1};
  o.correction_jacobian = 0.01 * ObservationJacobian::Ones();
  o.correction_jacobian(0, 2) = -0.02;
  o.correction_jacobian.col(kTimeOffsetAt).setZero();
  return o;
}

LineEnd lineEnd(double x, double y, double scale_px) {
  LineEnd end;
  static_cast<RayObservation&>(end) = observation(x, y);
  end.linearised_scale_px = scale_px;
  end.log_scale_jacobian << 0.002, 0.003, -0.001, 0.004, 0.2, 0.1, 0;
  return end;
}

struct Scene {
  PoseBlock T_w_bi = toBlock(Pose{expRotation({0.1, -0.2, 0.3}), {0.5, 0.2, -0.1}});
  PoseBlock T_w_bj = toBlock(Pose{expRotation({0.15, -0.1, 0.4}), {0.9, 0.3, 0.1}});
  PoseBlock T_b_c = toBlock(Pose{expRotation({0.02, 0.01, 1.55}), {-0.02, -0.06, 0.01}});
  CorrectionBlock correction = 0.01 * CorrectionBlock::Ones();
};

Camera eurocCamera() { return {752, 480, 458.654, 457.296, 367.215, 248.375, -0.28, 0.074, 2e-4, 1.8e-5}; }

const FrameMotion kMotion{{0.5, -0.3, 0.8}, {0.3, -0.6, 0.2}};

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

TEST(PointFactor, GradientsFromNearToInfinity) {
  const Scene s;
  const PointManifold manifold;
  const CorrectionBlock correction = (CorrectionBlock() << 1, -1, 0.5, 2, 0.01, -0.003, 0.004).finished();
  const Pose T_w_c = poseFromBlock(s.T_w_bi.data()) * poseFromBlock(s.T_b_c.data());
  for (const double inverse_depth : {0.0, 0.02, 0.3, 2.0}) {
    PointBlock point;
    point << T_w_c.q * Eigen::Vector3d(0.2, -0.1, 1), inverse_depth;
    point.normalize();
    PointFactor factor({350, 260}, eurocCamera(), kMotion, T_w_c.p + Eigen::Vector3d(0.1, 0, 0), 0.7);
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

TEST(LineFactor, IsInPixelsOfTheCorrectedCamera) {
  // The distance of the observed pixels to the image of the line, near the correction about which the ends are
  // linearised, however large that is.
  const Camera camera = eurocCamera();
  const PoseBlock identity = toBlock(Pose{});
  for (const Eigen::Vector2d& at : {Eigen::Vector2d(100, 60), Eigen::Vector2d(400, 250), Eigen::Vector2d(700, 420)})
    for (const double angle : {0.0, 0.7, 1.5}) {
      const Eigen::Vector2d along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
      CorrectionBlock correction;
      correction << 22, 8.5, 11, -4, 0.253, -0.062, 0;
      CorrectionBlock near;
      near << 20, 10, 10, -5, 0.25, -0.06, 0;
      const Camera corrected = correctedCamera(camera, correction.data());
      // a line through the image of two points, seen 2 px beside it
      const auto ray = [&](const Eigen::Vector2d& px) { return corrected.normalise(px).homogeneous().eval(); };
      const LineBlock line = toBlock(toOrthonormal(lineThrough(ray(at - 20 * along), ray(at + 20 * along))));
      const auto [start, end] = makeLineEnds(camera, at - 20 * along + 2 * across, at + 20 * along + 2 * across, near);
      const double* blocks[] = {identity.data(), identity.data(), correction.data(), line.data()};
      Eigen::Vector2d r;
      ASSERT_TRUE(LineFactor(start, end, {}, Eigen::Vector3d::Zero(), 0.5).Evaluate(blocks, r.data(), nullptr));
      EXPECT_NEAR(std::abs(r[0]), 4, 0.05) << at.transpose() << " " << angle;
      EXPECT_NEAR(std::abs(r[1]), 4, 0.05) << at.transpose() << " " << angle;
    }
}

TEST(LineEnd, ScaleFollowsTheCorrection) {
  const Camera camera = eurocCamera();
  const Eigen::Vector2d start_px(80, 50), end_px(180, 130);
  const LineEnd end = makeLineEnds(camera, start_px, end_px).first;
  for (int k = 0; k < kTimeOffsetAt; ++k) {
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

Camera fisheye(LensModel model = LensModel::kEquidistant) {
  Camera camera{752, 480, 259.7, 259.4, 372.3, 243.1, {0.0034824, 0.000715, -0.0020532, 0.00020294}, model};
  if (model == LensModel::kDoubleSphere) camera.lens = {-0.1755, 0.5929};
  if (model == LensModel::kExtendedUnified) camera.lens = {0.63, 1.04};
  return camera;
}

// Near the axis, far to the side, and behind the plane of the lens.
const Eigen::Vector2d kFisheyePixels[] = {{380, 250}, {80, 60}, {740, 240}, {5, 5}};

TEST(PointFactor, GradientsThroughFisheyes) {
  const Scene s;
  const PointManifold manifold;
  const CorrectionBlock correction = (CorrectionBlock() << 1, -1, 0.5, 2, 0.01, -0.003, 0.004).finished();
  const Pose T_w_c = poseFromBlock(s.T_w_bi.data()) * poseFromBlock(s.T_b_c.data());
  for (const LensModel model : {LensModel::kEquidistant, LensModel::kDoubleSphere, LensModel::kExtendedUnified})
    for (const Eigen::Vector2d& px : kFisheyePixels) {
      PointBlock point;
      point << T_w_c.q * fisheye(model).ray(px), 0.3;
      point.normalize();
      PointFactor factor(px, fisheye(model), kMotion, T_w_c.p + Eigen::Vector3d(0.1, 0, 0), 0.7);
      expectGradients(factor, {&kPoseManifold, &kPoseManifold, nullptr, &manifold},
                      {s.T_w_bi.data(), s.T_b_c.data(), correction.data(), point.data()}, 1e-5);
    }
}

TEST(MakeObservation, TheRayOfAFisheyeFollowsTheCorrection) {
  for (const LensModel model : {LensModel::kEquidistant, LensModel::kDoubleSphere, LensModel::kExtendedUnified})
    for (const Eigen::Vector2d& px : kFisheyePixels) {
      const RayObservation o = makeObservation(fisheye(model), px);
      for (int k = 0; k < kIntrinsicsSize; ++k) {
        CorrectionBlock correction = CorrectionBlock::Zero();
        correction[k] = k < 4 ? 0.1 : 1e-6;
        const Eigen::Vector3d exact = correctedCamera(fisheye(model), correction.data()).ray(px);
        EXPECT_LT((o.corrected(correction.data()) - exact).norm(), 1e-3 * (exact - o.ray).norm() + 1e-9)
            << k << " " << px.transpose();
      }
    }
}

TEST(LineFactor, GradientsThroughAFisheye) {
  const Scene s;
  const Camera camera = fisheye();
  const Pose T_w_c = poseFromBlock(s.T_w_bi.data()) * poseFromBlock(s.T_b_c.data());
  for (const Eigen::Vector2d& px : kFisheyePixels) {
    const Eigen::Vector2d end_px = px + Eigen::Vector2d(px.x() < 400 ? 90 : -90, 60);
    const Eigen::Vector3d p0 = T_w_c * (3 * camera.ray(px)), p1 = T_w_c * (2 * camera.ray(end_px));
    const Eigen::Vector3d origin = p0 + Eigen::Vector3d(0.1, -0.2, 0.3);
    const LineBlock line = toBlock(toOrthonormal(movedOrigin(lineThrough(p0, p1), origin)));
    const auto [start, end] = makeLineEnds(camera, px + Eigen::Vector2d(1, 1), end_px + Eigen::Vector2d(0, 2));
    expectGradients(LineFactor(start, end, kMotion, origin, 0.8),
                    {&kPoseManifold, &kPoseManifold, nullptr, &kLineManifold},
                    {s.T_w_bi.data(), s.T_b_c.data(), s.correction.data(), line.data()}, 1e-4);
  }
}

TEST(LineFactor, IsInPixelsOfTheCorrectedFisheye) {
  const Camera camera = fisheye();
  const PoseBlock identity = toBlock(Pose{});
  for (const Eigen::Vector2d& at : {Eigen::Vector2d(380, 250), Eigen::Vector2d(80, 60), Eigen::Vector2d(700, 240)})
    for (const double angle : {0.0, 0.7, 1.5}) {
      const Eigen::Vector2d along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
      CorrectionBlock correction, near;
      correction << 6.5, 4.5, 4, -2, 0.013, -0.006, 0;
      near << 6, 5, 3.5, -2.5, 0.012, -0.006, 0;
      const Camera corrected = correctedCamera(camera, correction.data());
      const Eigen::Vector2d from = at - 3 * along, to = at + 3 * along;  // short: nearly straight in the image
      const LineBlock line = toBlock(toOrthonormal(lineThrough(corrected.ray(from), corrected.ray(to))));
      const auto [start, end] = makeLineEnds(camera, from + 2 * across, to + 2 * across, near);
      const double* blocks[] = {identity.data(), identity.data(), correction.data(), line.data()};
      Eigen::Vector2d r;
      ASSERT_TRUE(LineFactor(start, end, {}, Eigen::Vector3d::Zero(), 0.5).Evaluate(blocks, r.data(), nullptr));
      EXPECT_NEAR(std::abs(r[0]), 4, 0.05) << at.transpose() << " " << angle;
      EXPECT_NEAR(std::abs(r[1]), 4, 0.05) << at.transpose() << " " << angle;
    }
}

TEST(LineEnd, ScaleThroughAFisheyeFollowsTheCorrection) {
  const Camera camera = fisheye();
  for (const Eigen::Vector2d& start_px : kFisheyePixels) {
    const Eigen::Vector2d end_px = start_px + Eigen::Vector2d(start_px.x() < 400 ? 60 : -60, 50);
    const LineEnd end = makeLineEnds(camera, start_px, end_px).first;
    for (int k = 0; k < kIntrinsicsSize; ++k) {
      const double step = k < 4 ? 0.1 : 1e-4;
      const auto scale = [&](double by) {
        CorrectionBlock correction = CorrectionBlock::Zero();
        correction[k] = by;
        return makeLineEnds(correctedCamera(camera, correction.data()), start_px, end_px).first.linearised_scale_px;
      };
      const double numeric = (scale(step) - scale(-step)) / (2 * step) / end.linearised_scale_px;
      EXPECT_NEAR(end.log_scale_jacobian[k], numeric, 0.01 * std::abs(numeric) + 1e-4)
          << k << " " << start_px.transpose();
    }
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

std::shared_ptr<Preintegration> somePreintegration() {
  auto preintegration = std::make_shared<Preintegration>(ImuBias{{0.01, 0.02, -0.01}, {0.05, 0, 0.1}}, ImuNoise{});
  ImuBatch samples;
  for (int i = 0; i <= 20; ++i) {
    const double t = 0.005 * i;
    samples.push_back({1400000000000000000 + i * 5000000,
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
  const double* blocks[] = {pose_i.data(), motion_i.data(), pose_j.data(), motion_j.data()};
  Eigen::Matrix<double, 15, 1> r;
  ASSERT_TRUE(ImuFactor(pre).Evaluate(blocks, r.data(), nullptr));
  EXPECT_LT(r.norm(), 1e-6);
}

TEST(ImuFactor, Gradients) {
  const auto pre = somePreintegration();
  const PoseBlock pose_i = toBlock(Pose{expRotation({0.3, 0.1, -1}), {1, 2, 3}});
  const PoseBlock pose_j = toBlock(Pose{expRotation({0.32, 0.13, -1.05}), {1.04, 2, 3.02}});
  MotionBlock motion_i, motion_j;
  motion_i << 0.4, -0.2, 0.1, 0.02, 0.01, -0.03, 0.1, 0.05, 0.2;
  motion_j << 0.5, -0.1, 0.1, 0.021, 0.012, -0.03, 0.12, 0.05, 0.21;
  expectGradients(ImuFactor(pre), {&kPoseManifold, nullptr, &kPoseManifold, nullptr},
                  {pose_i.data(), motion_i.data(), pose_j.data(), motion_j.data()}, 1e-5);
}

TEST(PriorFactor, GradientsFarFromTheLinearisation) {
  std::srand(3);
  const Scene s;
  const LineBlock line0 = toBlock(OrthonormalLine{expRotation({0.3, 0.2, 0.1}), 0.4});
  const LineBlock line = toBlock(OrthonormalLine{expRotation({0.1, 0.4, -0.2}), 0.6});
  PriorFactor factor({{std::make_shared<PoseManifold>(), s.T_w_bi}, {std::make_shared<LineManifold>(), line0}},
                     Eigen::MatrixXd::Random(8, 10), Eigen::VectorXd::Random(8));
  expectGradients(factor, {&kPoseManifold, &kLineManifold}, {s.T_w_bj.data(), line.data()});
}

TEST(BlockPrior, WeighsBySigmaAndLeavesInfiniteOnesFree) {
  const Eigen::Vector3d x0(1, 2, 3), x(2, 4, 6);
  const auto prior = makeBlockPrior(std::make_shared<VectorManifold>(3), x0,
                                    Eigen::Vector3d(0.5, std::numeric_limits<double>::infinity(), 3));
  const double* blocks[] = {x.data()};
  Eigen::Vector3d r;
  ASSERT_TRUE(prior->Evaluate(blocks, r.data(), nullptr));
  EXPECT_TRUE(r.isApprox(Eigen::Vector3d(2, 0, 1)));
}

/// A prior over two poses, a motion and the extrinsics, away from its linearisation, with A = N (I - G G^+): blind to
/// the gauge where it was linearised, as marginalisation leaves it.
struct GaugeFreePrior {
  std::vector<Pose> poses_0{{expRotation({0.1, -0.2, 0.3}), {0.5, 0.2, -0.1}},
                            {expRotation({0.2, 0.1, -1.3}), {2, -1, 0.4}}};
  MotionBlock motion_0 = MotionBlock::LinSpaced(-0.4, 0.5);
  PoseBlock extrinsics_0 = toBlock(Pose{expRotation({0.02, 0.01, 1.55}), {-0.02, -0.06, 0.01}});
  std::unique_ptr<PriorFactor> factor;

  GaugeFreePrior() {
    const auto pose = std::make_shared<PoseManifold>();
    std::vector<PriorBlock> blocks{{pose, toBlock(poses_0[0]), GaugeAction::kPose},
                                   {pose, toBlock(poses_0[1]), GaugeAction::kPose},
                                   {std::make_shared<VectorManifold>(kMotionSize), motion_0, GaugeAction::kMotion},
                                   {pose, extrinsics_0}};
    constexpr int n = 3 * kPoseTangent + kMotionSize;
    Eigen::MatrixXd A(8, n), G = Eigen::MatrixXd::Zero(n, 4);
    for (int i = 0; i < 8; ++i)
      for (int k = 0; k < n; ++k) A(i, k) = std::sin(1 + 3.7 * i + 1.3 * k * k);
    for (int k = 0; k < 2; ++k) {
      G.block<3, 3>(6 * k, 0).setIdentity();
      G.block<3, 1>(6 * k, 3) = Eigen::Vector3d::UnitZ().cross(poses_0[k].p);
      G.block<3, 1>(6 * k + 3, 3) = poses_0[k].q.conjugate() * Eigen::Vector3d::UnitZ();
    }
    G.block<3, 1>(12, 3) = Eigen::Vector3d::UnitZ().cross(velocityOf(motion_0.data()));
    A -= A * G * (G.transpose() * G).inverse() * G.transpose();
    factor = std::make_unique<PriorFactor>(std::move(blocks), A, Eigen::VectorXd::LinSpaced(8, -1, 1));
  }
};

struct PriorState {
  PoseBlock first, second, extrinsics;
  MotionBlock motion;
  std::vector<const double*> blocks() const { return {first.data(), second.data(), motion.data(), extrinsics.data()}; }
};

/// The linearisation point moved by much (the world) and by little (each block by itself).
PriorState displaced(const GaugeFreePrior& prior, const Pose& world, double little) {
  const auto moved = [&](const Pose& pose, double by) {
    return toBlock(world * pose *
                   Pose{expRotation(by * Eigen::Vector3d(0.3, -0.2, 0.5)), by * Eigen::Vector3d(1, 2, -1)});
  };
  PriorState state{moved(prior.poses_0[0], little), moved(prior.poses_0[1], -little), prior.extrinsics_0,
                   prior.motion_0};
  state.motion.segment<3>(kVelocityAt) = world.q * (velocityOf(prior.motion_0.data()) + Eigen::Vector3d(little, 0, 0));
  state.motion[kBiasGyroAt] += little;
  return state;
}

const Pose kOtherWorld{Eigen::Quaterniond(Eigen::AngleAxisd(2.1, Eigen::Vector3d::UnitZ())), {30, -20, 5}};

TEST(PriorFactor, DoesNotChangeWhenTheWorldMoves) {
  const GaugeFreePrior prior;
  const PriorState here = displaced(prior, Pose{}, 0.05), there = displaced(prior, kOtherWorld, 0.05);
  Eigen::VectorXd r_here(8), r_there(8), r_0(8);
  ASSERT_TRUE(prior.factor->Evaluate(here.blocks().data(), r_here.data(), nullptr));
  ASSERT_TRUE(prior.factor->Evaluate(there.blocks().data(), r_there.data(), nullptr));
  EXPECT_LT((r_here - r_there).norm(), 1e-9);
  const PriorState at_0 = displaced(prior, Pose{}, 0);
  ASSERT_TRUE(prior.factor->Evaluate(at_0.blocks().data(), r_0.data(), nullptr));
  EXPECT_GT((r_here - r_0).norm(), 0.01) << "it is not blind to the rest";
}

TEST(PriorFactor, GradientsInAnotherWorld) {
  const GaugeFreePrior prior;
  for (const double little : {0.0, 0.05, 0.4}) {
    const PriorState state = displaced(prior, kOtherWorld, little);
    expectGradients(*prior.factor, {&kPoseManifold, &kPoseManifold, nullptr, &kPoseManifold}, state.blocks(), 1e-5);
  }
}

TEST(PriorFactor, PlainKnowledgeOfAPoseIsAbsolute) {
  const auto prior =
      makeBlockPrior(std::make_shared<PoseManifold>(), toBlock(Pose{}), Eigen::VectorXd::Constant(6, 0.1));
  const PoseBlock moved = toBlock(Pose{Eigen::Quaterniond::Identity(), {1, 0, 0}});
  const double* blocks[] = {moved.data()};
  Eigen::VectorXd r(6);
  ASSERT_TRUE(prior->Evaluate(blocks, r.data(), nullptr));
  EXPECT_NEAR(r[0], 10, 1e-12);
  EXPECT_LT(prior->anchor(), 0);
}

}  // namespace
}  // namespace lintel
