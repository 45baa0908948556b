// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/exporting/ColmapImages.h"

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "ColmapNames.h"
#include "lintel/core/AtomicFile.h"
#include "lintel/exporting/MapExport.h"

namespace lintel {
namespace {

void writePng(const GrayImage& image, const std::string& path) {
  const cv::Mat pixels(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.pixels.data()));
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(".png", pixels, bytes)) throw ExportError(path + ": cannot be encoded: choose another image");
  try {
    AtomicFile::writeWhole(path, std::string(bytes.begin(), bytes.end()));
  } catch (const FileWriteError& error) {
    throw ExportError(error.what());
  }
}

}  // namespace

std::size_t writeColmapImages(const LineMap& map, const std::string& folder,
                              const std::function<std::optional<Frame>()>& next,
                              const std::function<GrayImage(const GrayImage&)>& prepare) {
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  if (!std::filesystem::is_directory(folder)) throw ExportError(folder + ": cannot be made: choose another name");
  std::set<std::int64_t> wanted;
  for (const MapKeyframe& keyframe : map.keyframes) wanted.insert(keyframe.t_ns);
  std::size_t written = 0;
  while (written < wanted.size()) {
    const std::optional<Frame> frame = next();
    if (!frame) break;
    if (wanted.count(frame->t_ns) == 0) continue;
    const std::string path = (std::filesystem::path(folder) / colmapName(frame->t_ns)).string();
    writePng(prepare ? prepare(*frame->image) : *frame->image, path);
    ++written;
  }
  return written;
}

}  // namespace lintel
