// SPDX-License-Identifier: BSD-3-Clause
#include "BoxIndex.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace lintel {
namespace {

using Box = BoxIndex::Box;

std::vector<Box> someBoxes(std::size_t count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-10, 10), size(0, 2);
  const auto vector = [&](auto& distribution) {
    return Eigen::Vector3d(distribution(random), distribution(random), distribution(random));
  };
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d low = vector(place);
    boxes.emplace_back(low, low + vector(size));
  }
  return boxes;
}

TEST(BoxIndex, findsWhatALookAtAllBoxesFindsInTheirOrder) {
  const std::vector<Box> boxes = someBoxes(2000);
  const BoxIndex index(boxes);
  std::size_t found = 0;
  for (const Box& box : someBoxes(50)) {
    std::vector<std::size_t> expected;
    for (std::size_t i = 0; i < boxes.size(); ++i)
      if (boxes[i].intersects(box)) expected.push_back(i);
    EXPECT_EQ(index.touching(box), expected);
    found += expected.size();
  }
  EXPECT_GT(found, 50u);
}

TEST(BoxIndex, doesNotFindBoxesThatAreNotFinite) {
  std::vector<Box> boxes = someBoxes(2);
  boxes[0].max().x() = std::numeric_limits<double>::quiet_NaN();
  const double far_m = 1e300;
  const Box all(Eigen::Vector3d::Constant(-far_m), Eigen::Vector3d::Constant(far_m));
  EXPECT_EQ(BoxIndex(boxes).touching(all), std::vector<std::size_t>{1});
  EXPECT_TRUE(BoxIndex({}).touching(all).empty());
}

}  // namespace
}  // namespace lintel
