// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "ImageLine.h"
#include "lintel/tracking/FrontEndParams.h"

namespace lintel {

/// Predicted lines after the detections of the same frame have been taken in.
struct MergedLines {
  std::vector<ImageLine> lines;  ///< per prediction: it, extended by the detections that belong to it
  std::vector<int> detections;   ///< per prediction: how many those are; 0: the prediction has none
  std::vector<ImageLine> fresh;  ///< detections that belong to no prediction
};

/// Combines what optical flow predicts with what the detector sees. Identity is the prediction's: a line that the
/// detector split, cut or missed keeps its identity, and each detection belongs to one line at most [Lim2021].
class LineMerger {
 public:
  LineMerger(const LineCamera& camera, const LineTrackerParams& params) : camera_(camera), params_(params) {}

  /// All lines with the brighter side along their normal; edges of opposite contrast never merge.
  MergedLines merge(const std::vector<ImageLine>& predicted, const std::vector<ImageLine>& detected) const;

  /// 0: different lines; up to 1: the same line, side by side and parallel.
  double score(const ImageLine& predicted, const ImageLine& detected) const;

  /// Whether the two describe the same stretch of the same edge.
  bool duplicates(const ImageLine& a, const ImageLine& b) const;

 private:
  const LineCamera& camera_;
  LineTrackerParams params_;
};

}  // namespace lintel
