// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

namespace lintel {

/// Which things come near each other: a grid of cubes, things entered by some of their points. Results are in a fixed
/// order, whatever the order of entry within a thing.
class SpatialIndex {
 public:
  explicit SpatialIndex(double cell_m) : cell_m_(cell_m) {}

  void add(std::size_t thing, const Eigen::Vector3d& p_w);

  /// Hands on all pairs (a < b) of things with points in the same cube or in neighbouring ones, each once, a ascending.
  /// Points nearer than one cube are always found, farther than 3.5 cubes never. Of places seen again and again there
  /// are too many pairs to keep them.
  void eachPair(const std::function<void(std::size_t a, std::size_t b)>& take) const;

 private:
  struct Entry {
    std::int64_t x, y, z;
    std::size_t thing;
    bool operator<(const Entry& o) const;
  };
  double cell_m_;
  std::vector<Entry> entries_;
};

}  // namespace lintel
