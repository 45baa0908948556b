// SPDX-License-Identifier: BSD-3-Clause
#include "ImageFile.h"

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "SensorStream.h"

namespace lintel {

GrayImage readGrayImage(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw ImageFault(path + ": image file missing");
  cv::Mat decoded;
  try {
    decoded = cv::imread(path, cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception&) {
    decoded.release();
  }
  if (decoded.empty()) throw ImageFault(path + ": not a complete image");
  GrayImage image;
  image.width = decoded.cols;
  image.height = decoded.rows;
  image.pixels.reserve(decoded.total());
  for (int row = 0; row < decoded.rows; ++row)
    image.pixels.insert(image.pixels.end(), decoded.ptr(row), decoded.ptr(row) + decoded.cols);
  return image;
}

}  // namespace lintel
