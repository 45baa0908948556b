// SPDX-License-Identifier: BSD-3-Clause
#include "CornerDetector.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "DistanceGrid.h"

namespace lintel {
namespace {

constexpr int kBlock_px = 8;  ///< one candidate a block of 8 x 8 pixels, a fraction of the distance between points
constexpr float kFewCorners = 0.2f;  ///< of min_quality, where corners that reach it are too few for half of the points
constexpr double kBlank = 0.1;       ///< of the blocks, at least, show nothing but noise where corners are so few
constexpr float kAboveNoise = 5;  ///< times the best of those: noise alone reaches it in one block of several hundred

struct Candidate {
  int x, y;
  float response;
};

/// Of the pixels of half the resolution.
struct Candidates {
  std::vector<Candidate> maxima;  ///< strongest first
  float strongest = 0;
  float noise = 0;  ///< noise alone is hardly ever as strong, where the image has few corners
};

/// Sums of a row's derivative products over three columns, stored in xx[1 .. columns - 2].
struct RowSums {
  explicit RowSums(int columns) : xx(columns), xy(columns), yy(columns), pxx(columns), pxy(columns), pyy(columns) {}

  void set(const short* gx, const short* gy, int columns) {
    for (int x = 0; x < columns; ++x) {
      const float dx = gx[x], dy = gy[x];
      pxx[x] = dx * dx;
      pxy[x] = dx * dy;
      pyy[x] = dy * dy;
    }
    for (int x = 1; x < columns - 1; ++x) {
      xx[x] = pxx[x - 1] + pxx[x] + pxx[x + 1];
      xy[x] = pxy[x - 1] + pxy[x] + pxy[x + 1];
      yy[x] = pyy[x - 1] + pyy[x] + pyy[x + 1];
    }
  }

  std::vector<float> xx, xy, yy, pxx, pxy, pyy;
};

/// Smaller eigenvalue of the structure tensor over 3x3 pixels (Shi and Tomasi's response); 0 on the outermost pixels.
cv::Mat cornerResponse(const cv::Mat& image) {
  const int rows = image.rows, columns = image.cols;
  cv::Mat gx, gy;
  cv::Scharr(image, gx, CV_16S, 1, 0);
  cv::Scharr(image, gy, CV_16S, 0, 1);
  cv::Mat response(rows, columns, CV_32F, cv::Scalar(0));
  std::vector<RowSums> ring(3, RowSums(columns));
  for (int y = 0; y < rows; ++y) {
    ring[static_cast<std::size_t>(y % 3)].set(gx.ptr<short>(y), gy.ptr<short>(y), columns);
    if (y < 2) continue;
    float* out = response.ptr<float>(y - 1);
    const RowSums &a = ring[0], &b = ring[1], &c = ring[2];
    for (int x = 1; x < columns - 1; ++x) {
      const float xx = a.xx[x] + b.xx[x] + c.xx[x], yy = a.yy[x] + b.yy[x] + c.yy[x], xy = a.xy[x] + b.xy[x] + c.xy[x];
      const float half = 0.5f * (xx - yy);
      out[x] = 0.5f * (xx + yy) - std::sqrt(half * half + xy * xy);
    }
  }
  return response;
}

/// The strongest pixel of every block, when it is a local maximum.
Candidates blockMaxima(const cv::Mat& response, int border) {
  Candidates found;
  std::vector<float> of_blocks;
  for (int y0 = border; y0 < response.rows - border; y0 += kBlock_px)
    for (int x0 = border; x0 < response.cols - border; x0 += kBlock_px) {
      Candidate best{0, 0, 0};
      for (int y = y0; y < std::min(y0 + kBlock_px, response.rows - border); ++y) {
        const float* row = response.ptr<float>(y);
        for (int x = x0; x < std::min(x0 + kBlock_px, response.cols - border); ++x)
          if (row[x] > best.response) best = {x, y, row[x]};
      }
      if (best.y == 0) continue;
      of_blocks.push_back(best.response);
      bool maximum = true;
      for (int dy = -1; dy <= 1 && maximum; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          if (response.at<float>(best.y + dy, best.x + dx) > best.response) maximum = false;
      if (maximum) found.maxima.push_back(best);
    }
  if (of_blocks.empty()) return found;
  found.strongest = *std::max_element(of_blocks.begin(), of_blocks.end());
  const auto blank = of_blocks.begin() + static_cast<std::ptrdiff_t>(kBlank * static_cast<double>(of_blocks.size()));
  std::nth_element(of_blocks.begin(), blank, of_blocks.end());
  found.noise = kAboveNoise * *blank;
  std::sort(found.maxima.begin(), found.maxima.end(), [](const Candidate& a, const Candidate& b) {
    return a.response != b.response ? a.response > b.response : (a.y != b.y ? a.y < b.y : a.x < b.x);
  });
  return found;
}

}  // namespace

std::vector<cv::Point2f> CornerDetector::detect(const ImagePyramid& pyramid, const std::vector<cv::Point2f>& taken,
                                                int wanted) const {
  std::vector<cv::Point2f> found;
  if (wanted <= 0) return found;
  // Half resolution: a quarter of the work, less noise, and KLT follows the patch, not the pixel.
  const int level = std::min(1, pyramid.levels() - 1), scale = 1 << level;
  cv::Mat response = cornerResponse(pyramid.image(level));
  mask_.blacken(response, scale);
  const Candidates candidates = blockMaxima(response, params_.border_px / scale + 2);
  const cv::Size size = pyramid.image().size();
  DistanceGrid occupied(size.width, size.height, params_.min_distance_px);
  // Cells of the size that gives every point one; a cell's turn comes when no candidate is left in emptier cells.
  const double cell = std::sqrt(static_cast<double>(size.area()) / params_.max_points);
  const int columns = static_cast<int>(size.width / cell) + 1, rows = static_cast<int>(size.height / cell) + 1;
  std::vector<int> in_cell(static_cast<std::size_t>(columns * rows), 0);
  const auto countAt = [&](const cv::Point2f& p) -> int& {
    const int place = static_cast<int>(p.y / cell) * columns + static_cast<int>(p.x / cell);
    return in_cell[static_cast<std::size_t>(place)];
  };
  for (const cv::Point2f& p : taken) {
    occupied.insert(p);
    ++countAt(p);
  }
  const auto choose = [&](float least) {
    std::vector<cv::Point2f> left;
    for (const Candidate& c : candidates.maxima)
      if (c.response >= least) left.emplace_back(static_cast<float>(scale * c.x), static_cast<float>(scale * c.y));
    for (int turn = 0; !left.empty(); ++turn) {
      std::vector<cv::Point2f> later;
      for (const cv::Point2f& p : left) {
        if (!occupied.isFree(p)) continue;
        if (countAt(p) > turn) {
          later.push_back(p);
          continue;
        }
        occupied.insert(p);
        ++countAt(p);
        found.push_back(p);
        if (static_cast<int>(found.size()) == wanted) return;
      }
      left = std::move(later);
    }
  };
  const float usual = static_cast<float>(params_.min_quality) * candidates.strongest;
  choose(usual);
  // The corners of a lamp or a sheet of paper in a dim room are much stronger than all others.
  if (2 * (taken.size() + found.size()) < static_cast<std::size_t>(params_.max_points))
    choose(std::max(kFewCorners * usual, std::min(usual, candidates.noise)));
  return found;
}

}  // namespace lintel
