// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "SensorStream.h"
#include "lintel/core/Frame.h"

namespace mrpt::obs {
class CObservationImage;
}

namespace lintel {

/// The folder of a rawlog's external images, NAME_Images beside NAME.rawlog. After rawlog-edit --cut -o OTHER.rawlog
/// the images stay in the folder of the uncut rawlog: if its own folder lacks `image_name`, the neighbours *_Images are
/// searched for it and the choice is noted. Throws RecordingError when no folder holds it.
std::string findImagesFolder(const std::string& rawlog_path, const std::string& image_name, const WarningSink& warn);

/// The image of an observation, from its file in `folder` or embedded. Throws ImageFault.
GrayImage decodeImage(const mrpt::obs::CObservationImage& observation, const std::string& folder);

}  // namespace lintel
