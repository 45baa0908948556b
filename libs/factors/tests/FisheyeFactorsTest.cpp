// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "TestFactors.h"
#include "lintel/factors/ImageObservations.h"
#include "lintel/factors/LineFactor.h"
#include "lintel/factors/PointFactor.h"

namespace lintel {
namespace {

using testing::expectGradients, testing::kLineManifold, testing::kMotion, testing::kPoseManifold, testing::Scene;

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
  const CorrectionBlock correction = (CorrectionBlock() << 1, -1, 0.5, 2, 0.01, -0.003, 0, 0.004).finished();
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
      correction << 6.5, 4.5, 4, -2, 0.013, -0.006, 0, 0;
      near << 6, 5, 3.5, -2.5, 0.012, -0.006, 0, 0;
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

}  // namespace
}  // namespace lintel
