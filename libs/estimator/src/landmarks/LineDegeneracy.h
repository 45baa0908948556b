// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "landmarks/CameraPoses.h"
#include "lintel/estimator/EstimatorParams.h"
#include "lintel/geometry/PluckerLine.h"

namespace lintel {

/// How well a line is known: standard deviations from its 4x4 information in the tangent space of LineManifold.
struct LineUncertainty {
  double direction_rad = 0;  ///< worst direction error
  double distance_m = 0;     ///< worst displacement across the line, at the point `along_m` from its foot
};

/// `information`: J^T J of its observations; `along_m`: signed distance along d from the point nearest to the moment's
/// origin to the middle of what was seen. Unobserved directions give infinity.
LineUncertainty uncertaintyOf(const OrthonormalLine& line, const Eigen::Matrix4d& information, double along_m);

/// Standard deviation of the angle between a sighting's observation plane and a direction [rad].
double planeSigma(const CameraPoses& poses, const FactorParams& params, const LineSighting& sighting,
                  const Eigen::Vector3d& d_w);

/// The epipole test of two views ([Lim2021] eq. epipole): the newest camera and, of those that saw the line, the one
/// farthest from it. The angle between the line's plane in the newest one and the way between the two [rad]: zero when
/// the line's image passes the epipole, and when all cameras are in one place.
double epipoleAngle(const CameraPoses& poses, const LineTrack& track);

/// Whether a triangulated line whose sigmas are up to date is degenerate, and why; `depth_m`: of its middle in the
/// newest sighting.
LineVerdict judgeLine(const CameraPoses& poses, const DegeneracyParams& params, const LineTrack& track, double depth_m);

/// Whether a line is part of the problem: well-determined ones, and degenerate ones as `params.lines` says.
bool entersProblem(const LineTrack& track, const DegeneracyParams& params);

}  // namespace lintel
