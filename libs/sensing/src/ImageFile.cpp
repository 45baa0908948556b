// SPDX-License-Identifier: BSD-3-Clause
#include "ImageFile.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "GrayPng.h"
#include "SensorStream.h"

namespace lintel {

namespace {

std::vector<std::uint8_t> bytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::vector<std::uint8_t> bytes(file ? static_cast<std::size_t>(std::max<std::streamoff>(0, file.tellg())) : 0);
  file.seekg(0);
  if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()))) bytes.clear();
  return bytes;
}

}  // namespace

GrayImage grayImageOf(const cv::Mat& grey) {
  GrayImage image;
  image.width = grey.cols;
  image.height = grey.rows;
  image.pixels.reserve(grey.total());
  for (int row = 0; row < grey.rows; ++row)
    image.pixels.insert(image.pixels.end(), grey.ptr(row), grey.ptr(row) + grey.cols);
  return image;
}

GrayImage decodeGrayImage(const std::vector<std::uint8_t>& bytes, const std::string& name) {
  if (auto image = decodeGrayPng(bytes)) return std::move(*image);
  if (isDamagedPng(bytes)) throw ImageFault(name + ": not a complete image");
  cv::Mat decoded;
  try {
    if (!bytes.empty()) decoded = cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception&) {
    decoded.release();
  }
  if (decoded.empty()) throw ImageFault(name + ": not a complete image");
  return grayImageOf(decoded);
}

GrayImage readGrayImage(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw ImageFault(path + ": image file missing");
  if (!std::filesystem::is_regular_file(path, ignored)) throw ImageFault(path + ": no file");
  return decodeGrayImage(bytesOf(path), path);
}

}  // namespace lintel
