// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "landmarks/CameraPoses.h"
#include "lintel/estimator/EstimatorParams.h"

namespace lintel {

/// Groups of parallel lines: which degenerate lines get a direction from others ([Lim2021] structural constraint).
///
/// A line through the epipole lies in one plane with the motion; that it is parallel to it is an assumption. So a
/// group starts only when more lines support its direction than random lines would: lines whose own direction is
/// known, or many degenerate lines whose planes all contain it (the motion itself, the vertical). A line joins when all
/// its observation planes contain the direction, and leaves when its own observations determine its direction or its
/// planes disagree.
/// Sets LineTrack::group and the line's estimate, and SlidingWindow::directions.
void groupParallelLines(SlidingWindow& window, const EstimatorParams& params);

/// Misfit of a direction and a line: root mean square of the angles between direction and observation planes, in
/// standard deviations.
double directionMisfit(const CameraPoses& poses, const EstimatorParams& params, const LineTrack& track,
                       const Eigen::Vector3d& d_w);

}  // namespace lintel
