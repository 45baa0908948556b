// SPDX-License-Identifier: BSD-3-Clause
#include "window/NoiseScale.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace lintel {
namespace {

/// Mean squares of `count` tracks with twelve degrees of freedom each, whose variances are scaled inverse chi-square
/// about `variance`.
std::vector<double> meanSquares(double variance, double freedom, int count, std::mt19937_64& engine) {
  constexpr double kDegrees = 12;
  std::chi_squared_distribution<double> own(freedom), residuals(kDegrees);
  std::vector<double> result;
  for (int i = 0; i < count; ++i) result.push_back(variance * freedom / own(engine) * residuals(engine) / kDegrees);
  return result;
}

double scaleOf(double true_scale, double freedom, int windows) {
  std::mt19937_64 engine(1);
  NoiseScale noise(freedom);
  for (int i = 0; i < windows; ++i) {
    auto seen = meanSquares(true_scale * true_scale / noise.scale() / noise.scale(), freedom, 40, engine);
    noise.add(seen);
  }
  return noise.scale();
}

TEST(NoiseScale, FindsTheScaleOfTheErrors) {
  for (const double freedom : {2.0, 4.0, 30.0})
    for (const double scale : {0.3, 1.0, 3.0})
      EXPECT_NEAR(scaleOf(scale, freedom, 500), scale, 0.06 * scale) << freedom;
}

TEST(NoiseScale, BeginsWithWhatIsConfigured) {
  EXPECT_EQ(NoiseScale(2).scale(), 1);
  EXPECT_LT(scaleOf(3, 4, 1), 1.3);
}

TEST(NoiseScale, FollowsAChangeWithinSeconds) {
  std::mt19937_64 engine(1);
  NoiseScale noise(4);
  for (const double scale : {0.5, 2.0})
    for (int i = 0; i < 200; ++i) {
      auto seen = meanSquares(scale * scale / noise.scale() / noise.scale(), 4, 40, engine);
      noise.add(seen);
    }
  EXPECT_NEAR(noise.scale(), 2, 0.2);
}

TEST(NoiseScale, AFifthOfTracksThatSlideDoNotDecide) {
  std::mt19937_64 engine(1);
  NoiseScale noise(4);
  for (int i = 0; i < 500; ++i) {
    auto seen = meanSquares(1 / noise.scale() / noise.scale(), 4, 40, engine);
    for (std::size_t k = 0; k < seen.size() / 5; ++k) seen[k] *= 400;
    noise.add(seen);
  }
  EXPECT_NEAR(noise.scale(), 1, 0.2);
}

TEST(NoiseScale, TooFewTracksSayNothing) {
  NoiseScale noise(4);
  for (int i = 0; i < 100; ++i) {
    std::vector<double> seen(4, 25);
    noise.add(seen);
  }
  EXPECT_EQ(noise.scale(), 1);
}

TEST(NoiseScale, TracksWithoutErrorsKeepALeastNoise) {
  NoiseScale noise(2);
  for (int i = 0; i < 1000; ++i) {
    std::vector<double> seen(30, 0);
    noise.add(seen);
  }
  EXPECT_NEAR(noise.scale(), 0.2, 1e-3);
}

TEST(NoiseScale, TracksAllAlikeAreTheirMeanSquare) {
  NoiseScale noise(std::numeric_limits<double>::infinity());
  for (int i = 0; i < 1000; ++i) {
    std::vector<double> seen(30, 4 / noise.scale() / noise.scale());
    noise.add(seen);
  }
  EXPECT_NEAR(noise.scale(), 2, 1e-3);
}

}  // namespace
}  // namespace lintel
