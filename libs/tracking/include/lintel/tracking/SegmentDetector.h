// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "lintel/core/Frame.h"
#include "lintel/core/ParamRange.h"
#include "lintel/core/Rig.h"

namespace lintel {

/// A straight edge in an image. Walking from start to end, with x to the right and y down, its brighter side is on the
/// right hand.
struct EdgeSegment {
  Eigen::Vector2f start_px = Eigen::Vector2f::Zero(), end_px = Eigen::Vector2f::Zero();  ///< raw (distorted) pixels
  float sigma_px = 1;          ///< standard deviation of an end's distance from the edge
  float dark = 0, bright = 0;  ///< mean grey levels of its sides
};

/// How single images are searched for straight edges.
struct SegmentParams {
  int gradient_threshold = 12;  ///< Sobel response that an edge must have
  double min_length_px = 20;

  template <class F>
  void fields(F&& field) {
    field("gradient_threshold", gradient_threshold, Range{1, 255});
    field("min_length_px", min_length_px, ReferencePixels{10, 10000});
  }
};

/// Finds the straight edges of single images, faint and short ones too, at full and at half resolution. Tracking needs
/// few that are found again; this is for a map that shall have all.
class SegmentDetector {
 public:
  /// Throws std::invalid_argument, naming the parameter, when one is out of range.
  SegmentDetector(const Rig& rig, const SegmentParams& params);
  ~SegmentDetector();
  SegmentDetector(SegmentDetector&&) noexcept;

  /// Longer ones first, no edge twice.
  std::vector<EdgeSegment> detect(const GrayImage& image);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lintel
