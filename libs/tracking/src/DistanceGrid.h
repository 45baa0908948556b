// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <opencv2/core.hpp>
#include <vector>

namespace lintel {

/// Finds in constant time whether there is a point nearer than d.
class DistanceGrid {
 public:
  DistanceGrid(int width, int height, double distance_px)
      : distance_(static_cast<float>(std::max(distance_px, 1.0))),
        columns_(static_cast<int>(static_cast<float>(width) / distance_) + 1),
        rows_(static_cast<int>(static_cast<float>(height) / distance_) + 1),
        cells_(static_cast<std::size_t>(columns_ * rows_)) {}

  bool isFree(const cv::Point2f& p) const {
    const int cx = column(p), cy = row(p);
    for (int y = std::max(cy - 1, 0); y <= std::min(cy + 1, rows_ - 1); ++y)
      for (int x = std::max(cx - 1, 0); x <= std::min(cx + 1, columns_ - 1); ++x)
        for (const cv::Point2f& q : cells_[static_cast<std::size_t>(y * columns_ + x)])
          if ((p - q).dot(p - q) < distance_ * distance_) return false;
    return true;
  }

  void insert(const cv::Point2f& p) { cells_[static_cast<std::size_t>(row(p) * columns_ + column(p))].push_back(p); }

 private:
  int column(const cv::Point2f& p) const { return std::clamp(static_cast<int>(p.x / distance_), 0, columns_ - 1); }
  int row(const cv::Point2f& p) const { return std::clamp(static_cast<int>(p.y / distance_), 0, rows_ - 1); }

  float distance_;
  int columns_, rows_;
  std::vector<std::vector<cv::Point2f>> cells_;
};

}  // namespace lintel
