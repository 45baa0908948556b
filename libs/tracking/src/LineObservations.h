// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ImageLine.h"
#include "lintel/core/FrameTracks.h"

namespace lintel {

inline LineObservation lineObservation(const LineCamera& camera, TrackId id, const ImageLine& line, double sigma_px,
                                       int track_length, bool detected) {
  LineObservation observation;
  observation.id = id;
  observation.start_px = camera.toImage(line.start);
  observation.end_px = camera.toImage(line.end);
  observation.start = line.start / camera.focal();
  observation.end = line.end / camera.focal();
  observation.sigma_px = sigma_px;
  observation.track_length = track_length;
  observation.detected = detected;
  return observation;
}

}  // namespace lintel
