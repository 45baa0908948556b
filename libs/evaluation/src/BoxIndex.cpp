// SPDX-License-Identifier: BSD-3-Clause
#include "BoxIndex.h"

#include <algorithm>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <iterator>
#include <utility>

namespace lintel {

namespace {

namespace bg = boost::geometry;
using TreePoint = bg::model::point<double, 3, bg::cs::cartesian>;
using TreeBox = bg::model::box<TreePoint>;
using Entry = std::pair<TreeBox, std::size_t>;

TreeBox treeBox(const BoxIndex::Box& box) {
  const auto point = [](const Eigen::Vector3d& p) { return TreePoint(p.x(), p.y(), p.z()); };
  return {point(box.min()), point(box.max())};
}

std::vector<Entry> entriesOf(const std::vector<BoxIndex::Box>& boxes) {
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (boxes[i].min().allFinite() && boxes[i].max().allFinite()) entries.emplace_back(treeBox(boxes[i]), i);
  return entries;
}

}  // namespace

struct BoxIndex::Tree {
  bg::index::rtree<Entry, bg::index::quadratic<16>> boxes;
};

BoxIndex::BoxIndex(const std::vector<Box>& boxes) : tree_(std::make_unique<Tree>()) {
  tree_->boxes = decltype(tree_->boxes)(entriesOf(boxes));
}

BoxIndex::~BoxIndex() = default;
BoxIndex::BoxIndex(BoxIndex&&) noexcept = default;

std::vector<std::size_t> BoxIndex::touching(const Box& box) const {
  std::vector<Entry> found;
  tree_->boxes.query(bg::index::intersects(treeBox(box)), std::back_inserter(found));
  std::vector<std::size_t> places;
  places.reserve(found.size());
  for (const Entry& entry : found) places.push_back(entry.second);
  std::sort(places.begin(), places.end());
  return places;
}

BoxIndex::Box boxOf(const Segment3& segment) {
  return {segment.start.cwiseMin(segment.end), segment.start.cwiseMax(segment.end)};
}

BoxIndex::Box boxAroundMiddle(const Segment3& segment, double radius_m) {
  return {segment.midpoint().array() - radius_m, segment.midpoint().array() + radius_m};
}

}  // namespace lintel
