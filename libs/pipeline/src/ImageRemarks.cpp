// SPDX-License-Identifier: BSD-3-Clause
#include "ImageRemarks.h"

#include <algorithm>

#include "lintel/core/Formatted.h"

namespace lintel {
namespace {

constexpr double kFaulty = 0.1;         ///< of the images
constexpr double kLeastFollowed = 0.7;  ///< images in which a point is followed, on average; 1 to 3 with much noise
constexpr double kAllOver = 0.5;        ///< of the image: more than a vehicle shows of itself

}  // namespace

std::string vehicleRemark(double share) {
  if (!(share > 0)) return {};
  return formatted(
      "%.0f %% of the image move with the camera (a part of the vehicle, a hand, the rim of the lens): left out "
      "since they were found, when the camera turned to and fro; look at mask.pgm beside the trajectory, where "
      "they are black: given as --mask it leaves them out from the first image on%s",
      std::max(1.0, 100 * share),
      share > kAllOver ? "; so much of it may be the pattern of an infrared projector: switch it off" : "");
}

std::string imagesRemark(const FrontEndStatistics& tracking) {
  std::string text;
  if (tracking.images_repeated > 0)
    text =
        std::to_string(tracking.images_repeated) +
        " images are the one before once more, though the camera turned (a camera that hangs, or images sent twice): "
        "left out";
  if (tracking.images_without_contrast > 0)
    text += (text.empty() ? "" : "; ") + std::to_string(tracking.images_without_contrast) +
            " images show nothing (black, white or covered)";
  return text;
}

std::string imageFault(const FrontEndStatistics& tracking) {
  const auto share = [&](std::int64_t count) {
    return tracking.frames > 0 ? static_cast<double>(count) / static_cast<double>(tracking.frames) : 0.0;
  };
  if (const double blank = share(tracking.images_without_contrast); blank > kFaulty) {
    return formatted("%.0f %% of the images show nothing (dark, covered or overexposed)", 100 * blank);
  }
  if (const double repeated = share(tracking.images_repeated); repeated > kFaulty) {
    return formatted("%.0f %% of the images repeat the one before although the IMU turns: the recorder lost images",
                     100 * repeated);
  }
  return {};
}

std::string textureFault(const PointStatistics& points) {
  if (static_cast<double>(points.tracked) >= kLeastFollowed * static_cast<double>(points.detected)) return {};
  return "most points that are found are lost in the next image: surfaces without texture, darkness, blur, or images "
         "that are not in order";
}

}  // namespace lintel
