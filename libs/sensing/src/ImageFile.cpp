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

GrayImage readGrayImage(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw ImageFault(path + ": image file missing");
  const std::vector<std::uint8_t> bytes = bytesOf(path);
  if (auto image = decodeGrayPng(bytes)) return std::move(*image);
  if (isDamagedPng(bytes)) throw ImageFault(path + ": not a complete image");
  cv::Mat decoded;
  try {
    if (!bytes.empty()) decoded = cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
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
