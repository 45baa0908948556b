// SPDX-License-Identifier: BSD-3-Clause
#include "ParamsCheck.h"

namespace lintel {

void checkParams(const EstimatorParams& params) {
  checkRanges(params, "estimator.");
  constexpr double kMost = 1e6;
  checkAllowed("estimator.initializer.max_frames", params.initializer.max_frames,
               Range{static_cast<double>(params.initializer.min_frames), kMost});
  checkAllowed("estimator.landmarks.max_depth_m", params.landmarks.max_depth_m,
               Range{params.landmarks.min_depth_m, kMost});
}

}  // namespace lintel
