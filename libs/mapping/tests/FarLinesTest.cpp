// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/FarLines.h"

#include <gtest/gtest.h>

#include "LineJudgement.h"
#include "TestMaterial.h"
#include "lintel/mapping/LineFitting.h"

namespace lintel {
namespace {

using namespace test;

/// Posts of one height 40 m away, seen from five places 5 m apart, with edges of these standard deviations.
class FarLinesTest : public ::testing::Test {
 protected:
  void addPosts(const std::vector<float>& sigmas_px) {
    for (const float sigma_px : sigmas_px) {
      const double x = 4.0 + 2.0 * static_cast<double>(material_.lines.size());
      LineRecord line = lineOf(material_, material_.lines.size(), {{x, -5, 40}, {x, 6, 40}});
      for (LineView& view : line.views) view.sigma_px = sigma_px;
      ASSERT_TRUE(fitLine(KeyframeCameras(material_), LineFitParams(), line));
      material_.lines.push_back(line);
    }
  }

  std::vector<LineState> states(const MapParams& params) const {
    const KeyframeCameras cameras(material_);
    std::vector<LineState> result;
    for (const LineRecord& line : material_.lines) result.push_back(judgeMapLine(params, cameras, line).state);
    return result;
  }

  static constexpr LineState kIn = LineState::kKnown, kOut = LineState::kDegenerate;
  MapMaterial material_ = materialAlongX(5, 5);
  MapParams params_;
};

TEST_F(FarLinesTest, HalfOfWhatIsKnownToTwoPerCentOfItsDistanceIsInTheMap) {
  addPosts({2, 0.9F, 1.5F, 1.2F, 30, 1.8F});
  EXPECT_EQ(states(params_), std::vector<LineState>(6, kOut));
  const MapParams raised = withFarLines(params_, material_, 0.5);
  EXPECT_EQ(states(raised), std::vector<LineState>({kOut, kIn, kIn, kIn, kOut, kOut}));
  EXPECT_LE(raised.max_far_sigma, params_.max_relative_sigma);
}

TEST_F(FarLinesTest, WhereHalfIsKnownWellTheLimitsStay) {
  addPosts({0.3F, 1.5F, 0.2F});
  EXPECT_EQ(states(params_), std::vector<LineState>({kIn, kOut, kIn}));
  EXPECT_EQ(withFarLines(params_, material_, 0.5).max_far_sigma, params_.max_far_sigma);
}

TEST_F(FarLinesTest, LinesOfAMapStayInIt) {
  addPosts({2, 0.9F, 1.5F, 1.2F});
  EXPECT_EQ(states(withFarLines(params_, material_, kShareOfOwnLines)), std::vector<LineState>(4, kIn));
}

TEST_F(FarLinesTest, NoShareNoChange) {
  addPosts({2, 1.2F});
  EXPECT_EQ(withFarLines(params_, material_, 0).max_far_sigma, params_.max_far_sigma);
  material_.lines.clear();
  EXPECT_EQ(withFarLines(params_, material_, 1).max_far_sigma, params_.max_far_sigma);
}

}  // namespace
}  // namespace lintel
