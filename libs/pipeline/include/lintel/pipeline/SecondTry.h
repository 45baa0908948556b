// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/pipeline/Odometry.h"

namespace lintel {

/// Whether a run has no pose, and stamps that were corrected before the start: the offset that was found may be wrong.
bool mayHaveWrongClock(const OdometryResult& result);

/// For the same recording once more, its stamps as they are.
Configuration asStamped(Configuration configuration);

/// Whether the result with the stamps as they are is the better one: it has poses.
bool hasPoses(const OdometryResult& second, const OdometryResult& first);

/// Whether a run has poses for less than half of its frames because no start knew the scale well enough: the motion is
/// too gentle for its IMU.
bool lacksScale(const OdometryResult& result);

/// For the same recording once more. A start may be less sure of the scale: the refinement has the whole recording to
/// find it.
Configuration secondTryOf(Configuration configuration);

/// Whether the second try's result is the better one: it is refined, no check fails, and it has poses for more frames.
bool isBetter(const OdometryResult& second, const OdometryResult& first);

/// Why a second try's result is not to be trusted either.
std::string verdictOfSecondTry(const OdometryResult& second);

}  // namespace lintel
