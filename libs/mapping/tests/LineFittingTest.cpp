// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/LineFitting.h"

#include <gtest/gtest.h>

#include "Evidence.h"
#include "LineViews.h"
#include "TestMaterial.h"

namespace lintel {
namespace {

using namespace test;

class LineFittingTest : public testing::Test {
 protected:
  bool fit(LineRecord& line) const { return fitLine(KeyframeCameras(material_), params_, line); }
  double offset(const LineEstimate& line, const Eigen::Vector3d& p_w) const {
    return (p_w - line.middle_w).cross(line.direction_w).norm();
  }

  MapMaterial material_ = materialAlongX();
  LineFitParams params_;
  const Segment3 upright_{{0.8, -0.7, 4}, {0.9, 0.6, 4.1}};
};

TEST_F(LineFittingTest, ExactViewsGiveTheLineWithoutAStart) {
  LineRecord line = lineOf(material_, 1, upright_);
  ASSERT_TRUE(fit(line));
  EXPECT_LT(lineAngle(line.estimate.direction_w, upright_.direction()), 1e-6);
  EXPECT_LT(offset(line.estimate, upright_.start), 1e-6);
  EXPECT_LT((line.estimate.middle_w - upright_.midpoint()).norm(), 0.05) << "the middle of what was seen";
  EXPECT_NEAR(line.distance_m, 4.1, 0.1);
  EXPECT_LT(line.error_px, 1e-5);
}

TEST_F(LineFittingTest, ABadStartDoesNotMatter) {
  LineRecord line = lineOf(material_, 1, upright_);
  line.known = true;
  line.estimate.middle_w = {3, 2, 9};
  line.estimate.direction_w = Eigen::Vector3d::UnitX();
  ASSERT_TRUE(fit(line));
  EXPECT_LT(lineAngle(line.estimate.direction_w, upright_.direction()), 1e-6);
}

TEST_F(LineFittingTest, AViewOfSomethingElseIsAnOutlier) {
  LineRecord line = lineOf(material_, 1, upright_, 0, 4);
  line.views[2].start_px.x() += 30;
  line.views[2].end_px.x() += 30;
  ASSERT_TRUE(fit(line));
  EXPECT_LT(offset(line.estimate, upright_.midpoint()), 1e-3);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(line.views[i].inlier, i != 2);
  EXPECT_EQ(keyframesOf(line), 4);
}

TEST_F(LineFittingTest, OneKeyframeIsNoLine) {
  LineRecord line = lineOf(material_, 1, upright_, 2, 2);
  line.views.push_back(line.views[0]);
  EXPECT_FALSE(fit(line));
  EXPECT_FALSE(line.known);
}

TEST_F(LineFittingTest, SigmasSayWhatTheMotionLeavesOpen) {
  LineRecord across = lineOf(material_, 1, {{1, -0.7, 4}, {1, 0.7, 4}});
  LineRecord nearly = lineOf(material_, 2, {{0, 0.5, 4}, {2, 0.55, 4}});  // almost along the way flown
  LineRecord along = lineOf(material_, 3, {{0, 0.5, 4}, {2, 0.5, 4}});    // along it: the depth is open
  ASSERT_TRUE(fit(across));
  ASSERT_TRUE(fit(nearly));
  EXPECT_FALSE(fit(along));
  EXPECT_LT(across.estimate.sigmaPosition(0), 0.03);
  EXPECT_GT(nearly.estimate.sigmaPosition(0), 10 * across.estimate.sigmaPosition(0));
  EXPECT_GE(across.estimate.sigmaPosition(2), across.estimate.sigmaPosition(0)) << "far from the middle less is known";
}

TEST_F(LineFittingTest, SigmaOfTheDepthIsThatOfTheParallax) {
  // Two views 0.5 m apart of an upright line at depth z: sigma_z = z^2 sigma_px / (f 0.5) * sqrt(2) / sqrt(2 ends) …
  LineRecord line = lineOf(material_, 1, {{0.25, -1, 4}, {0.25, 1, 4}}, 0, 1);
  params_.systematic = 0;
  ASSERT_TRUE(fit(line));
  const double expected = 16.0 / (458 * 0.5);  // z^2 / (f b), times sqrt(2 views / 2 ends)
  EXPECT_NEAR(line.estimate.sigmaPosition(0), expected, 0.15 * expected);
}

TEST_F(LineFittingTest, GrazingViewsSayNothingAboutEnds) {
  LineRecord line = lineOf(material_, 1, {{0, 0.2, 2}, {0, 0.2, 30}});
  ASSERT_TRUE(fit(line));
  EXPECT_FALSE(viewStretch(KeyframeCameras(material_), line.estimate, line.views[0]))
      << "its far end is seen at less than three degrees";
}

}  // namespace
}  // namespace lintel
