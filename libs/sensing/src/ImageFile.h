// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lintel/core/Frame.h"

namespace cv {
class Mat;
}

namespace lintel {

/// Decodes an image file to 8-bit grey. Throws ImageFault when it is missing, cut or no image.
GrayImage readGrayImage(const std::string& path);

/// The same of a file's bytes. `name`: for the message.
GrayImage decodeGrayImage(const std::vector<std::uint8_t>& bytes, const std::string& name);

/// Copies an 8-bit grey image of OpenCV.
GrayImage grayImageOf(const cv::Mat& grey);

}  // namespace lintel
