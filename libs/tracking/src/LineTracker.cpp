// SPDX-License-Identifier: BSD-3-Clause
#include "LineTracker.h"

#include "DescriptorLineTracker.h"
#include "FlowLineTracker.h"

namespace lintel {

std::unique_ptr<LineTracker> makeLineTracker(const Rig& rig, const LineTrackerParams& params) {
  if (params.mode == "descriptor") return std::make_unique<DescriptorLineTracker>(rig, params);
  return std::make_unique<FlowLineTracker>(rig, params);
}

}  // namespace lintel
