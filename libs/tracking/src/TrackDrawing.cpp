// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/tracking/TrackDrawing.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

namespace lintel {
namespace {

constexpr int kEnlarge = 2;  ///< so that neighbouring lines stay apart

/// Neighbouring identities get colours far apart (steps of the golden angle around the hue circle).
cv::Scalar colourOf(TrackId id) {
  const double hue = std::fmod(static_cast<double>(id) * 0.61803398875, 1.0) * 6;
  const auto channel = [&](double shift) {
    const double k = std::fmod(shift + hue, 6.0);
    return 255.0 * (1.0 - std::max(0.0, std::min({k, 4.0 - k, 1.0})));
  };
  return {channel(1), channel(3), channel(5)};
}

cv::Point drawn(const Eigen::Vector2d& px) {
  return {static_cast<int>(std::lround(kEnlarge * px.x())), static_cast<int>(std::lround(kEnlarge * px.y()))};
}

void drawLine(cv::Mat& canvas, const Camera& camera, const LineObservation& line) {
  constexpr int kPieces = 24;  // short enough to bend with the lens, and to be dashes
  const cv::Scalar colour = colourOf(line.id);
  for (int i = 0; i < kPieces; ++i) {
    if (!line.detected && i % 2 == 1) continue;
    const auto at = [&](int k) {
      return drawn(camera.project(line.start + (line.end - line.start) * k / double(kPieces)));
    };
    cv::line(canvas, at(i), at(i + 1), colour, 2, cv::LINE_AA);
  }
  cv::putText(canvas, std::to_string(line.id), drawn(0.5 * (line.start_px + line.end_px)), cv::FONT_HERSHEY_SIMPLEX,
              0.5, colour, 1, cv::LINE_AA);
}

}  // namespace

void drawTracks(const std::string& path, const Frame& frame, const Rig& rig, const FrameTracks& tracks) {
  const GrayImage& image = *frame.image;
  const cv::Mat gray(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.pixels.data()));
  cv::Mat canvas;
  cv::cvtColor(gray, canvas, cv::COLOR_GRAY2BGR);
  cv::resize(canvas, canvas, cv::Size(), kEnlarge, kEnlarge, cv::INTER_LINEAR);
  for (const PointObservation& point : tracks.points)
    cv::circle(canvas, drawn(point.px), point.track_length > 1 ? 4 : 2, colourOf(point.id), cv::FILLED, cv::LINE_AA);
  for (const LineObservation& line : tracks.lines) drawLine(canvas, rig.camera, line);

  const std::string unfinished = path + ".part.png";
  bool written = false;
  try {
    written = cv::imwrite(unfinished, canvas);
  } catch (const cv::Exception&) {
    written = false;
  }
  std::error_code failed;
  if (written) std::filesystem::rename(unfinished, path, failed);
  if (!written || failed) {
    std::remove(unfinished.c_str());
    throw std::runtime_error(path + ": the image could not be written");
  }
}

}  // namespace lintel
