// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lintel/core/FrameTracks.h"
#include "lintel/estimator/WindowUpdate.h"

namespace lintel {

/// What the report of a run shows of one frame.
struct RunFrame {
  std::int64_t t_ns = 0;
  int points_tracked = 0, lines_tracked = 0;  ///< in the image
  bool in_window = false;                     ///< the figures below are there
  int points_used = 0, lines_used = 0, lines_degenerate = 0, lines_constrained = 0;
  int lines_through_epipole = 0, lines_direction_unknown = 0, lines_distance_unknown = 0;  ///< of the degenerate ones
  double speed_m_s = 0;
  bool at_rest = false, lost = false;
  ImuBias bias;
  std::optional<ImuBias> bias_sigma;  ///< about once a second
};

/// Collects a run frame by frame: about 200 bytes each.
class RunSeries {
 public:
  void add(const FrameTracks& tracks, const WindowUpdate& update) {
    RunFrame frame;
    frame.t_ns = update.t_ns;
    frame.points_tracked = static_cast<int>(tracks.points.size());
    frame.lines_tracked = static_cast<int>(tracks.lines.size());
    frame.in_window = update.status == EstimatorStatus::kTracking;
    frame.lost = update.status == EstimatorStatus::kLost;
    frame.points_used = update.points_used;
    frame.lines_used = update.lines_used;
    frame.lines_degenerate = update.lines_degenerate;
    frame.lines_constrained = update.lines_constrained;
    frame.lines_through_epipole = update.lines_through_epipole;
    frame.lines_direction_unknown = update.lines_direction_unknown;
    frame.lines_distance_unknown = update.lines_distance_unknown;
    frame.speed_m_s = update.v_w_b.norm();
    frame.at_rest = update.at_rest;
    frame.bias = update.bias;
    frame.bias_sigma = update.bias_sigma;
    frames_.push_back(frame);
  }
  const std::vector<RunFrame>& frames() const { return frames_; }

 private:
  std::vector<RunFrame> frames_;
};

}  // namespace lintel
