// SPDX-License-Identifier: BSD-3-Clause
#include "solver/SightingRows.h"

#include <gtest/gtest.h>

namespace lintel {
namespace {

TEST(SightingRows, ProductsAreThoseOfTheMatrices) {
  std::vector<SightingRows> A, B;
  std::vector<CameraRows> J;
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(kSightingColumns, kSightingColumns);
  for (int i = 0; i < 5; ++i) {
    A.emplace_back(SightingRows::Random());
    B.emplace_back(SightingRows::Random());
    J.emplace_back(CameraRows::Random());
    expected += A.back().transpose() * B.back();
  }
  SightingProducts products;
  multiplySightings(A, J, B, products);
  for (int r = 0; r < kResidualColumn; ++r)
    for (int c = r; c < kSightingColumns; ++c) EXPECT_NEAR(products.all(r, c), expected(r, c), 1e-14) << r << " " << c;
  ASSERT_EQ(products.by_camera.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_TRUE(products.by_camera[i].isApprox(J[i].transpose() * B[i], 1e-14)) << i;
  multiplySightings({}, {}, {}, products);
  EXPECT_TRUE(products.all.isZero(0));
  EXPECT_TRUE(products.by_camera.empty());
}

}  // namespace
}  // namespace lintel
