// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "lintel/geometry/Camera.h"

namespace lintel {

/// A camera as calibration files name it.
struct CameraDescription {
  std::string projection = "pinhole";
  std::string distortion = "none";   ///< Kalibr's, EuRoC's, ROS' or VINS' name of the model
  std::vector<double> intrinsics;    ///< fx fy cx cy [px]; before them those of a lens that is a projection
  std::vector<double> coefficients;  ///< of the distortion, in the model's order
  double width = 0, height = 0;      ///< [px], whole numbers
  std::string intrinsics_key = "intrinsics", projection_key = "camera_model", distortion_key = "distortion_model",
              coefficients_key = "distortion_coefficients", size_key = "resolution";  ///< for messages
};

/// The camera that a description stands for: the one place that knows which models there are. Throws RecordingError
/// naming `where` and the key when the model is not supported or no lens can have these values.
Camera makeCamera(const CameraDescription& description, const std::string& where);

}  // namespace lintel
