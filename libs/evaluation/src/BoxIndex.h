// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "lintel/geometry/Segment.h"

namespace lintel {

/// Which of many boxes (axes of the world, [m]) touch another: a map of a large building has 200,000 lines.
class BoxIndex {
 public:
  using Box = Eigen::AlignedBox3d;

  /// Boxes that are not finite are never found.
  explicit BoxIndex(const std::vector<Box>& boxes);
  ~BoxIndex();
  BoxIndex(BoxIndex&&) noexcept;

  /// Places in `boxes`, ascending, of those that touch `box`.
  std::vector<std::size_t> touching(const Box& box) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

/// Around a segment.
BoxIndex::Box boxOf(const Segment3& segment);

/// Around all points that are at most `radius_m` from the middle of a segment.
BoxIndex::Box boxAroundMiddle(const Segment3& segment, double radius_m);

}  // namespace lintel
