// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "lintel/core/ThreadTime.h"

namespace lintel {

/// CPU time of one stage, a value per run of it [ms].
struct StageTimes {
  std::vector<float> ms;

  double mean() const;
  /// The value below which a share `q` in [0, 1] of the runs lies; 0 without runs.
  double quantile(double q) const;
  double sum() const;
};

/// Lifetimes of tracks that have ended: lifetimes[n] tracks were seen in n frames.
struct TrackLifetimes {
  std::map<int, std::int64_t> ended;

  void add(int frames) { ++ended[frames]; }
  std::int64_t count() const;
  /// Share of ended tracks seen in at least `frames` frames; 0 without tracks.
  double shareOfAtLeast(int frames) const;
  double median() const;
};

struct PointStatistics {
  std::int64_t tracked = 0;        ///< points carried over from the frame before, summed over frames
  std::int64_t detected = 0;       ///< new points
  std::int64_t lost_klt = 0;       ///< not found, or out of the image
  std::int64_t lost_backward = 0;  ///< forward-backward check
  std::int64_t lost_epipolar = 0;  ///< off the epipolar line
  std::int64_t lost_drift = 0;     ///< off the epipolar line over a longer baseline
  std::int64_t lost_crowded = 0;   ///< too close to an older point
  TrackLifetimes lifetimes;
};

struct LineStatistics {
  std::int64_t tracked = 0;           ///< lines carried over from the frame before, summed over frames
  std::int64_t tracked_detected = 0;  ///< of them seen by the detector, too
  std::int64_t created = 0;           ///< new identities
  std::int64_t detections = 0;        ///< segments of the detector, joined
  std::int64_t merged = 0;            ///< of them taken as parts of predicted lines
  std::int64_t flow_failed = 0;       ///< predictions without optical flow (by gyro and points nearby)
  std::int64_t lost_view = 0;         ///< left the image
  std::int64_t lost_edge = 0;         ///< no edge at the predicted place, or too short a part of it
  std::int64_t lost_jump = 0;         ///< moved differently from its surroundings: another edge
  std::int64_t lost_duplicate = 0;    ///< became the same as an older line
  std::int64_t lost_undetected = 0;   ///< not seen by the detector for too long
  std::int64_t lost_unconfirmed = 0;  ///< candidates that were gone before they got an identity
  std::int64_t lost_unmatched = 0;    ///< mode descriptor: no match
  TrackLifetimes lifetimes;           ///< in frames of the images' rate
};

/// What the front end has done so far. All but the times is deterministic.
struct FrontEndStatistics {
  std::int64_t frames = 0;
  std::int64_t frames_without_gyro = 0;
  std::int64_t images_without_contrast = 0;  ///< black, white or covered
  std::int64_t images_repeated = 0;          ///< the image before once more, while the camera turned: left out
  double vehicle_share = 0;                  ///< of the image, covered by what was found to move with the camera
  PointStatistics points;
  LineStatistics lines;
  std::map<std::string, StageTimes> stages;  ///< by name of the stage
};

/// Adds the CPU time of this thread from its construction to its end to a stage.
class StageTimer {
 public:
  StageTimer(FrontEndStatistics& statistics, const std::string& stage)
      : times_(statistics.stages[stage]), start_ms_(threadTimeMs()) {}
  ~StageTimer() { times_.ms.push_back(static_cast<float>(threadTimeMs() - start_ms_)); }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  StageTimes& times_;
  double start_ms_;
};

}  // namespace lintel
