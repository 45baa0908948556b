// SPDX-License-Identifier: BSD-3-Clause
#include "CameraErrors.h"

#include <gtest/gtest.h>

#include "TestMaterial.h"
#include "lintel/mapping/LineFitting.h"

namespace lintel {
namespace {

using namespace test;
using Eigen::Vector3d;

class CameraErrorsTest : public testing::Test {
 protected:
  CameraErrorsTest() { line_ = fitted(material_); }

  LineRecord fitted(const MapMaterial& cameras) const {
    LineRecord line = lineOf(material_, 1, {{0.8, -0.7, 4}, {0.9, 0.6, 4.1}}, 0, 4);
    EXPECT_TRUE(fitLine(KeyframeCameras(cameras), {}, line));
    return line;
  }

  Eigen::Matrix4d covariance(const std::vector<CameraErrors>& errors) const {
    return covarianceByCameras(KeyframeCameras(material_), errors, line_);
  }

  MapMaterial material_ = materialAlongX();
  LineRecord line_;
};

TEST_F(CameraErrorsTest, NoneMakeNone) {
  EXPECT_TRUE(covariance({}).isZero());
  EXPECT_TRUE(covariance(std::vector<CameraErrors>(5, CameraErrors::Zero())).isZero());
}

TEST_F(CameraErrorsTest, ALineMovesWithItsCameras) {
  CameraErrors error = CameraErrors::Zero();
  const Vector3d shift(0.01, 0.002, -0.005);
  error.topRows<3>().colwise() = shift.cast<float>();
  const Eigen::Matrix4d C = covariance(std::vector<CameraErrors>(5, error));
  const Eigen::Vector2d across = tangentBasis(line_.estimate.direction_w).transpose() * shift;
  const Eigen::Matrix2d expected = across * across.transpose();
  EXPECT_LT((C.topLeftCorner<2, 2>() - expected).norm(), 1e-4 * expected.norm());
  EXPECT_LT((C.bottomRightCorner<2, 2>().norm()), 1e-10);
}

TEST_F(CameraErrorsTest, WhatCamerasHaveNotInCommonMovesALineAsAFitDoes) {
  // the second and the last camera are wrong: a line fitted with them is where the covariance says
  MapMaterial wrong = material_;
  std::vector<CameraErrors> errors(5, CameraErrors::Zero());
  for (const std::size_t k : {1u, 4u}) {
    const Vector3d shift(1e-4, -2e-4, 3e-4), turn(2e-5, 3e-5, -1e-5);
    errors[k].topRows<3>().colwise() = shift.cast<float>();
    errors[k].bottomRows<3>().colwise() = turn.cast<float>();
    Pose T_w_c = wrong.keyframes[k].T_w_b * wrong.rig.T_b_c;
    T_w_c.p += shift;
    T_w_c.q = expRotation(turn) * T_w_c.q;
    wrong.keyframes[k].T_w_b = T_w_c * wrong.rig.T_b_c.inverse();
  }
  const LineEstimate moved = fitted(wrong).estimate, &line = line_.estimate;
  const Eigen::Matrix<double, 3, 2> B = tangentBasis(line.direction_w);
  const double along = (line.middle_w - moved.middle_w).dot(line.direction_w);
  Eigen::Vector4d step;
  step << B.transpose() * (moved.middle_w + along * moved.direction_w - line.middle_w),
      B.transpose() * moved.direction_w;
  const Eigen::Matrix4d expected = step * step.transpose();
  EXPECT_LT((covariance(errors) - expected).norm(), 0.05 * expected.norm());
}

TEST(BodyErrors, WhatMovesTheTrajectoryAsAWholeIsNoError) {
  std::vector<Pose> poses;
  std::vector<std::int64_t> times;
  for (int k = 0; k < 6; ++k) {
    poses.push_back({expRotation({0.1 * k, 0.2, -0.1 * k}), {0.5 * k, 0.1 * k * k, std::sin(k)}});
    times.push_back(k * std::int64_t{100});
  }
  BodyErrors body(poses, times);
  const Vector3d shift(0.3, -0.2, 0.1), turn(1e-3, 2e-3, -3e-3);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    BodyErrors::Draws tangent;
    tangent.topRows<3>().colwise() = shift + turn.cross(poses[k].p);
    tangent.bottomRows<3>().colwise() = poses[k].R().transpose() * turn;
    body.set(k, tangent);
  }
  body.align();
  for (const CameraErrors& errors : body.ofCamera({}, BodyErrors::Draws::Zero())) EXPECT_LT(errors.norm(), 1e-6);
}

TEST(BodyErrors, BetweenTwoTheyAreInterpolated) {
  const std::vector<Pose> poses(3);
  BodyErrors body(poses, {0, 100, 400});
  body.set(0, BodyErrors::Draws::Constant(1));
  body.set(2, BodyErrors::Draws::Constant(5));
  body.interpolate({0, 2});
  EXPECT_NEAR(body.ofCamera({}, BodyErrors::Draws::Zero())[1](0, 0), 2, 1e-6);
}

/// Cameras whose drawn ways are `scale` times 1, -1, 1 … larger than the estimated one, and shifted.
MapMaterial scaledDraws(double scale) {
  MapMaterial material;
  for (int k = 0; k < 20; ++k) {
    RetiredKeyframe keyframe;
    keyframe.T_w_b.p = {std::sin(0.4 * k), 0.1 * k, 0.3 * std::cos(0.7 * k)};
    material.keyframes.push_back(keyframe);
    CameraErrors errors = CameraErrors::Zero();
    for (int n = 0; n < kErrorDraws; ++n)
      errors.col(n).head<3>() =
          ((n % 2 ? -scale : scale) * keyframe.T_w_b.p + Eigen::Vector3d(0.1, 0.2, n)).cast<float>();
    material.camera_errors.push_back(errors);
  }
  return material;
}

TEST(ScaleSigma, IsThatOfTheDrawnWays) {
  EXPECT_NEAR(scaleSigma(scaledDraws(0.02)), 0.02, 1e-6);
  EXPECT_NEAR(scaleSigma(scaledDraws(0)), 0, 1e-6);
  MapMaterial in_one_place = scaledDraws(0.02);
  for (RetiredKeyframe& keyframe : in_one_place.keyframes) keyframe.T_w_b.p.setZero();
  EXPECT_EQ(scaleSigma(in_one_place), 0);
  EXPECT_EQ(scaleSigma(MapMaterial{}), 0);
}

}  // namespace
}  // namespace lintel
