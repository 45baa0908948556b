// SPDX-License-Identifier: BSD-3-Clause
#include "LineTracker.h"

#include "DescriptorLineTracker.h"
#include "FlowLineTracker.h"
#include "FourStepLineTracker.h"

namespace lintel {

LineObservation lineObservation(const LineCamera& camera, TrackId id, const ImageLine& line, double sigma_px,
                                int track_length, bool detected) {
  LineObservation observation;
  observation.id = id;
  observation.start_px = camera.toImage(line.start, line.axis);
  observation.end_px = camera.toImage(line.end, line.axis);
  observation.start = camera.rayOf(line.start, line.axis);
  observation.end = camera.rayOf(line.end, line.axis);
  observation.sigma_px = sigma_px;
  observation.track_length = track_length;
  observation.detected = detected;
  return observation;
}

std::unique_ptr<LineTracker> makeLineTracker(const Rig& rig, const ImageMask& mask, const LineTrackerParams& params) {
  if (params.mode == "descriptor") return std::make_unique<DescriptorLineTracker>(rig, mask, params);
  if (params.mode == "four_steps") return std::make_unique<FourStepLineTracker>(rig, mask, params);
  return std::make_unique<FlowLineTracker>(rig, mask, params);
}

}  // namespace lintel
