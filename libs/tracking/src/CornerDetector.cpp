// SPDX-License-Identifier: BSD-3-Clause
#include "CornerDetector.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "DistanceGrid.h"

namespace lintel {
namespace {

constexpr int kBlock_px = 8;  ///< one candidate a block

struct Candidate {
  int x, y;
  float response;
};

/// The strongest pixel of every block, when it is a local maximum.
std::vector<Candidate> blockMaxima(const cv::Mat& response, int border, float threshold) {
  std::vector<Candidate> candidates;
  for (int y0 = border; y0 < response.rows - border; y0 += kBlock_px)
    for (int x0 = border; x0 < response.cols - border; x0 += kBlock_px) {
      Candidate best{0, 0, threshold};
      for (int y = y0; y < std::min(y0 + kBlock_px, response.rows - border); ++y) {
        const float* row = response.ptr<float>(y);
        for (int x = x0; x < std::min(x0 + kBlock_px, response.cols - border); ++x)
          if (row[x] > best.response) best = {x, y, row[x]};
      }
      if (best.y == 0) continue;
      bool maximum = true;
      for (int dy = -1; dy <= 1 && maximum; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          if (response.at<float>(best.y + dy, best.x + dx) > best.response) maximum = false;
      if (maximum) candidates.push_back(best);
    }
  return candidates;
}

}  // namespace

std::vector<cv::Point2f> CornerDetector::detect(const cv::Mat& image, const std::vector<cv::Point2f>& taken,
                                                int wanted) const {
  std::vector<cv::Point2f> found;
  if (wanted <= 0) return found;
  cv::Mat response;
  cv::cornerMinEigenVal(image, response, 3, 3);
  double strongest = 0;
  cv::minMaxLoc(response, nullptr, &strongest);
  const int border = std::max(params_.border_px + 1, 2);
  std::vector<Candidate> candidates =
      blockMaxima(response, border, static_cast<float>(params_.min_quality * strongest));
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.response != b.response ? a.response > b.response : (a.y != b.y ? a.y < b.y : a.x < b.x);
  });

  DistanceGrid occupied(image.cols, image.rows, params_.min_distance_px);
  // Cells of the size that gives every point one; a cell's turn comes when no candidate is left in emptier cells.
  const double cell = std::sqrt(static_cast<double>(image.cols) * image.rows / params_.max_points);
  const int columns = static_cast<int>(image.cols / cell) + 1, rows = static_cast<int>(image.rows / cell) + 1;
  std::vector<int> in_cell(static_cast<std::size_t>(columns * rows), 0);
  const auto cellOf = [&](float x, float y) {
    return static_cast<std::size_t>(static_cast<int>(y / cell) * columns + static_cast<int>(x / cell));
  };
  for (const cv::Point2f& p : taken) {
    occupied.insert(p);
    ++in_cell[cellOf(p.x, p.y)];
  }
  for (int turn = 0; !candidates.empty() && static_cast<int>(found.size()) < wanted; ++turn) {
    std::vector<Candidate> later;
    for (const Candidate& c : candidates) {
      const cv::Point2f p(static_cast<float>(c.x), static_cast<float>(c.y));
      if (!occupied.isFree(p)) continue;
      int& count = in_cell[cellOf(p.x, p.y)];
      if (count > turn) {
        later.push_back(c);
        continue;
      }
      if (static_cast<int>(found.size()) >= wanted) break;
      occupied.insert(p);
      ++count;
      found.push_back(p);
    }
    candidates = std::move(later);
  }
  return found;
}

}  // namespace lintel
