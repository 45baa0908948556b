// SPDX-License-Identifier: BSD-3-Clause
#include "RawlogImages.h"

#include <mrpt/obs/CObservationImage.h>

#include <filesystem>
#include <set>

#include "ImageFile.h"
#include "RawlogFile.h"
#include "TimeTicks.h"

namespace lintel {

namespace fs = std::filesystem;

namespace {

/// The neighbour *_Images that holds the image; empty if none does. Of several the alphabetically first: the choice
/// must not depend on the disk.
std::string findNeighbour(const fs::path& parent, const std::string& image_name) {
  const std::string suffix = "_Images";
  std::set<std::string> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(parent, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.size() < suffix.size() || name.compare(name.size() - suffix.size(), suffix.size(), suffix) != 0) continue;
    if (fs::exists(entry.path() / image_name, ignored)) found.insert(entry.path().string());
  }
  return found.empty() ? std::string() : *found.begin();
}

}  // namespace

std::string findImagesFolder(const std::string& rawlog_path, const std::string& image_name, const WarningSink& warn) {
  std::error_code ignored;
  const fs::path parent = fs::path(rawlog_path).parent_path(), stem = fs::path(rawlog_path).stem();
  // The names under which MRPT looks, in its order.
  const fs::path own = parent / (stem.string() + "_Images"),
                 others[] = {parent / (stem.string() + "_images"), parent / "Images"};
  if (fs::exists(own / image_name, ignored)) return own.string();
  for (const fs::path& other : others)
    if (fs::exists(other / image_name, ignored)) return other.string();
  std::string neighbour = findNeighbour(parent.empty() ? "." : parent, image_name);
  if (neighbour.empty()) {
    if (fs::is_directory(own, ignored)) return own.string();  // a single image may be missing
    throw RecordingError(rawlog_path + ": its external images are missing: put or link their folder at " +
                         own.string());
  }
  warn(Fault::Other, rawlog_path + ": images taken from " + neighbour + " because " + own.string() + " lacks them");
  return neighbour;
}

GrayImage decodeImage(const mrpt::obs::CObservationImage& observation, const std::string& folder) {
  if (observation.image.isExternallyStored())
    return readGrayImage((fs::path(folder) / observation.image.getExternalStorageFile()).string());
  if (observation.image.isEmpty()) throw ImageFault("image at " + secondsText(timeOf(observation)) + " is empty");
  const mrpt::img::CImage gray = observation.image.isColor()
                                     ? observation.image.grayscale()
                                     : mrpt::img::CImage(observation.image, mrpt::img::SHALLOW_COPY);
  GrayImage image;
  image.width = static_cast<int>(gray.getWidth());
  image.height = static_cast<int>(gray.getHeight());
  image.pixels.reserve(gray.getWidth() * gray.getHeight());
  for (int row = 0; row < image.height; ++row) {
    const auto* line = gray.ptrLine<std::uint8_t>(static_cast<unsigned>(row));
    image.pixels.insert(image.pixels.end(), line, line + image.width);
  }
  return image;
}

}  // namespace lintel
