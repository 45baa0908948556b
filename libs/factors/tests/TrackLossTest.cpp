// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/TrackLoss.h"

#include <gtest/gtest.h>

#include <limits>

namespace lintel {
namespace {

TEST(TrackLoss, ATrackAsGoodAsItsSigmaSaysHasTheWeightOne) {
  double weight;
  TrackLoss(4).cost(17, 20, 3, weight);
  EXPECT_DOUBLE_EQ(weight, 1);
  TrackLoss(4).cost(0, 20, 3, weight);
  EXPECT_DOUBLE_EQ(weight, 21.0 / 4);
  TrackLoss(4).cost(206, 20, 3, weight);
  EXPECT_DOUBLE_EQ(weight, 0.1);
}

TEST(TrackLoss, TheWeightIsTheCostsDerivative) {
  for (const double freedom : {0.5, 4.0, 100.0})
    for (const double squared : {0.1, 5.0, 80.0}) {
      double weight, unused;
      const TrackLoss loss(freedom);
      loss.cost(squared, 12, 4, weight);
      const double h = 1e-5, rise = loss.cost(squared + h, 12, 4, unused) - loss.cost(squared - h, 12, 4, unused);
      EXPECT_NEAR(rise / (2 * h), 0.5 * weight, 1e-8) << freedom << " " << squared;
    }
}

TEST(TrackLoss, OfInfiniteFreedomIsLeastSquares) {
  double weight;
  EXPECT_DOUBLE_EQ(TrackLoss(std::numeric_limits<double>::infinity()).cost(8, 12, 4, weight), 4);
  EXPECT_DOUBLE_EQ(weight, 1);
  EXPECT_NEAR(TrackLoss(1e9).cost(8, 12, 4, weight), 4, 1e-6);
  EXPECT_NEAR(weight, 1, 1e-6);
}

TEST(TrackLoss, ATrackWithoutRedundancyStillHasACost) {
  double weight;
  EXPECT_GT(TrackLoss(4).cost(2, 4, 4, weight), 0);
  EXPECT_DOUBLE_EQ(weight, 5.0 / 6);
}

}  // namespace
}  // namespace lintel
