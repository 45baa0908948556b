// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/core/FrameTracks.h"

namespace lintel {

/// Two tracks that are probably of the same point, seen at different times.
struct PointJoin {
  TrackId a = 0, b = 0;
  int votes = 1;  ///< for it; of contradicting joins those with more count
};

}  // namespace lintel
