// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <deque>

#include "lintel/densification/Densifier.h"
#include "lintel/estimator/WindowUpdate.h"
#include "lintel/pipeline/StageClock.h"

namespace lintel {

/// Searches the images of keyframes for edges while the flight lasts, of those that come soon after another only the
/// first. Whether a frame becomes a keyframe is known when
/// the next one has been estimated; only the images of frames that wait for that are kept.
class EdgeStage {
 public:
  EdgeStage(const Rig& rig, const DensifyParams& params)
      : detector_(rig, params.segments), interval_ns_(std::llround(1e9 * params.interval_s)) {}

  /// Frames in the order of time. `clock` gets a value for every image searched.
  void add(const Frame& frame, const WindowUpdate& update, StageClock& clock);

  const ImageEdges& edges() const { return edges_; }

 private:
  void search(const Frame& frame, StageClock& clock);

  SegmentDetector detector_;
  std::int64_t interval_ns_;
  std::deque<Frame> waiting_;
  ImageEdges edges_;
};

}  // namespace lintel
