// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "lintel/tracking/FrontEndStatistics.h"

namespace lintel {

/// What tracking found to move with the camera: `share` of the image. Empty: nothing.
std::string vehicleRemark(double share);

/// Images that show nothing of the scene, or nothing new, and what they may come from. Empty: none.
std::string imagesRemark(const FrontEndStatistics& tracking);

/// What is wrong with more than a tenth of the images: a likely cause where a run fails. Empty: nothing.
std::string imageFault(const FrontEndStatistics& tracking);

/// Whether most points are lost at once, another likely cause: where the gyroscope leads the tracker right.
std::string textureFault(const PointStatistics& points);

}  // namespace lintel
