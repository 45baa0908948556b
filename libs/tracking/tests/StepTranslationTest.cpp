// SPDX-License-Identifier: BSD-3-Clause
#include "StepTranslation.h"

#include <gtest/gtest.h>

#include "lintel/geometry/Rotation.h"

namespace lintel {
namespace {

/// A camera among points on a grid at depths of 2 to 6 m.
class StepTranslationTest : public ::testing::Test {
 protected:
  StepTranslationTest() {
    for (int i = -4; i <= 4; ++i)
      for (int j = -3; j <= 3; ++j) points_.push_back({0.5 * i, 0.5 * j, 4 + 2 * std::sin(1.7 * i + j)});
  }

  /// Moves the camera by `t` (its new place seen from the old one), turned by `R`; ids from `first_id`.
  void step(const Eigen::Vector3d& t_c0, const Eigen::Quaterniond& R_c0_c1, TrackId first_id = 1) {
    std::vector<StepTranslation::Pair> pairs;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Eigen::Vector3d after = R_c0_c1.conjugate() * (points_[i] - t_c0);
      pairs.push_back({first_id + i, points_[i] / points_[i].z(), after / after.z()});
      points_[i] = after;
    }
    const Eigen::Vector3d t_c1 = R_c0_c1.conjugate() * -t_c0;
    const Eigen::Vector3d direction = t_c1.norm() > 0 ? t_c1.normalized() : Eigen::Vector3d(0, 0, 1);
    step_.update(pairs, R_c0_c1.conjugate(), Eigen::Vector3d(-direction));  // the sign is open: the wrong one
    true_t_c1_ = t_c1;
  }

  std::vector<Eigen::Vector3d> points_;
  StepTranslation step_{460};
  Eigen::Vector3d true_t_c1_{0, 0, 0};
};

TEST_F(StepTranslationTest, keepsItsUnitFromStepToStep) {
  const Eigen::Quaterniond R = expRotation(Eigen::Vector3d(0.01, -0.02, 0.03));
  step({0.10, 0.02, 0.05}, R);
  const double unit = step_.t_c1().norm() / true_t_c1_.norm();
  const int epoch = step_.epoch();
  for (const Eigen::Vector3d& t : {Eigen::Vector3d(0.05, 0, 0.02), Eigen::Vector3d(0, 0.2, -0.1),
                                   Eigen::Vector3d(-0.15, 0.05, 0.1), Eigen::Vector3d(0, 0, 0.12)}) {
    step(t, R);
    EXPECT_LT((step_.t_c1() - unit * true_t_c1_).norm(), 0.02 * unit * true_t_c1_.norm());
  }
  EXPECT_EQ(step_.epoch(), epoch);
}

TEST_F(StepTranslationTest, restIsNoTranslation) {
  step({0.1, 0, 0}, Eigen::Quaterniond::Identity());
  step({0, 0, 0}, expRotation(Eigen::Vector3d(0, 0.02, 0)));
  EXPECT_EQ(step_.t_c1().norm(), 0);
  EXPECT_GT(step_.typicalInverseDepth(), 0);
}

TEST_F(StepTranslationTest, startsAnewWhenAllPointsAreNew) {
  step({0.1, 0, 0}, Eigen::Quaterniond::Identity());
  const int epoch = step_.epoch();
  step({0.1, 0, 0}, Eigen::Quaterniond::Identity(), 1000);
  EXPECT_GT(step_.epoch(), epoch);
}

}  // namespace
}  // namespace lintel
