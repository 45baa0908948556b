// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "ImageLine.h"
#include "lintel/tracking/FrontEndParams.h"

namespace lintel {

/// Matches segments of two frames by LBD descriptors, gated by geometry.
class LineMatcher {
 public:
  LineMatcher(const LineCamera& camera, const LineTrackerParams& params);
  ~LineMatcher();

  /// One descriptor (a row of bytes) per line.
  cv::Mat describe(const cv::Mat& image, const std::vector<ImageLine>& lines) const;

  /// For every line of `to` the one of `from` it continues, each used once. `expected` are the lines of `from` where
  /// they should be seen now.
  std::vector<std::optional<std::size_t>> match(const std::vector<ImageLine>& expected, const cv::Mat& from_descriptors,
                                                const std::vector<ImageLine>& to, const cv::Mat& to_descriptors) const;

  /// Bits that differ between two descriptors, of 256.
  static int distance(const cv::Mat& descriptor, const cv::Mat& other);

 private:
  struct Engine;
  const LineCamera& camera_;
  LineTrackerParams params_;
  std::unique_ptr<Engine> engine_;
};

}  // namespace lintel
