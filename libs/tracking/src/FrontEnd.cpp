// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/tracking/FrontEnd.h"

#include <algorithm>
#include <opencv2/core/utility.hpp>
#include <stdexcept>
#include <string>

#include "GyroPrediction.h"
#include "ImageCheck.h"
#include "ImagePyramid.h"
#include "LineTracker.h"
#include "PointTracker.h"
#include "lintel/core/FrameRate.h"

namespace lintel {
namespace {

void checkParams(const Rig& rig, const FrontEndParams& params) {
  checkAllowed("camera width", rig.camera.width, Range{64, 20000});
  checkAllowed("camera height", rig.camera.height, Range{64, 20000});
  checkAllowed("camera fx", rig.camera.fx, Range{1, 1e6});
  checkAllowed("camera fy", rig.camera.fy, Range{1, 1e6});
  if (rig.mask && (rig.mask->width != rig.camera.width || rig.mask->height != rig.camera.height))
    throw std::invalid_argument("front end: the mask does not have the size of the rig's camera");
  checkAllowed("features", params.features, FrontEndParams::kFeatures);
  checkRanges(params, "tracking.");
  checkAllowed("tracking.lines.min_length_px", params.lines.min_length_px, Range{params.lines.keep_length_px, 10000});
  checkAllowed("tracking.lines.max_samples", params.lines.max_samples,
               Range{static_cast<double>(params.lines.min_samples), 100});
}

/// Numbers of frames that stand for a time, at the rate of the images.
FrontEndParams atRate(double rate_hz, FrontEndParams params) {
  for (int* frames : {&params.points.detect_every_n, &params.points.drift_frames, &params.lines.detect_every_n,
                      &params.lines.max_frames_without_detection})
    *frames = framesAtRate(*frames, rate_hz);
  return params;
}

void checkFrame(const Rig& rig, const Frame& frame) {
  const std::string at = "front end: frame " + std::to_string(frame.t_ns);
  if (!frame.image) throw std::invalid_argument(at + " has no image");
  const GrayImage& image = *frame.image;
  if (image.width != rig.camera.width || image.height != rig.camera.height ||
      image.pixels.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
    throw std::invalid_argument(at + " is " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                                ", the rig's camera is " + std::to_string(rig.camera.width) + "x" +
                                std::to_string(rig.camera.height));
}

}  // namespace

struct FrontEnd::Impl {
  Impl(const Rig& rig_in, const FrontEndParams& params)
      : rig(rig_in),
        pyramid(params.pyramid, std::max(params.points.window_px, params.lines.window_px)),
        gyro(rig, params.points.initial_gyro_bias_sigma),
        image_check(rig.camera),
        mask(rig),
        vehicle(rig.camera),
        points(rig, mask, params.points),
        lines(params.features != "points" ? makeLineTracker(rig, mask, params.lines) : nullptr) {}

  /// False when the image is left out.
  bool track(const Frame& frame, const ImuBatch& imu_since_last) {
    StageTimer total(statistics, "total");
    turn = CameraTurn();
    imu.insert(imu.end(), imu_since_last.begin(), imu_since_last.end());
    if (!isGood(frame, imu_since_last)) return false;
    {
      StageTimer timer(statistics, "pyramid");
      pyramid.push(*frame.image);
    }
    if (statistics.frames > 0 && !gyro.predict(imu, 1e-9 * static_cast<double>(frame.t_ns - tracked_t_ns)))
      ++statistics.frames_without_gyro;
    points.process(pyramid, gyro, statistics);
    if (points.turn()) turn = *points.turn(), turn.from_ns = tracked_t_ns, turn.to_ns = frame.t_ns;
    if (lines) lines->process(pyramid, gyro, points.motion(), statistics);
    leaveOutVehicle();
    tracked_t_ns = frame.t_ns;
    imu.clear();
    return true;
  }

  bool isGood(const Frame& frame, const ImuBatch& imu_since_last) {
    const ImageWorth worth = image_check.check(frame, imu_since_last, gyro.bias());
    statistics.images_without_contrast += worth == ImageWorth::kShowsNothing || worth == ImageWorth::kStaysDark;
    statistics.images_repeated += worth == ImageWorth::kRepeats;
    return worth == ImageWorth::kGood || worth == ImageWorth::kStaysDark;
  }

  /// From the next frame on.
  void leaveOutVehicle() {
    StageTimer timer(statistics, "vehicle");
    std::vector<FollowedPoint> followed = points.followed();
    if (lines) {
      const std::vector<FollowedPoint> on_lines = lines->followed();
      followed.insert(followed.end(), on_lines.begin(), on_lines.end());
    }
    if (!vehicle.observe(followed)) return;
    mask.cover(vehicle.area());
    statistics.vehicle_share = vehicle.share();
  }

  Rig rig;
  ImagePyramid pyramid;
  GyroPrediction gyro;
  ImageCheck image_check;
  ImageMask mask;  ///< shared with the trackers
  VehicleParts vehicle;
  PointTracker points;
  std::unique_ptr<LineTracker> lines;  ///< null: points only
  FrontEndStatistics statistics;
  CameraTurn turn;
  std::int64_t last_t_ns = 0, tracked_t_ns = 0;
  ImuBatch imu;  ///< since the last image that was tracked
};

FrontEnd::FrontEnd(const Rig& rig, const FrontEndParams& params) {
  checkParams(rig, params);
  impl_ = std::make_unique<Impl>(rig, atRate(rig.camera_rate_hz, scaledTo(rig.camera, params)));
}
FrontEnd::~FrontEnd() = default;
FrontEnd::FrontEnd(FrontEnd&&) noexcept = default;
FrontEnd& FrontEnd::operator=(FrontEnd&&) noexcept = default;

FrameTracks FrontEnd::process(const Frame& frame, const ImuBatch& imu_since_last) {
  Impl& m = *impl_;
  checkFrame(m.rig, frame);
  if (m.statistics.frames > 0 && frame.t_ns <= m.last_t_ns)
    throw std::invalid_argument("FrontEnd: frame " + std::to_string(frame.t_ns) + " is not later than the one before");

  // A parallel section within another one runs on its caller's thread. For images of this size OpenCV's threads cost
  // more than they give (a tenth of the time), and the estimator has work for the other core.
  bool tracked = false;
  cv::parallel_for_(cv::Range(0, 1), [&](const cv::Range&) { tracked = m.track(frame, imu_since_last); });

  ++m.statistics.frames;
  m.last_t_ns = frame.t_ns;
  FrameTracks tracks;
  tracks.t_ns = frame.t_ns;
  if (!tracked) return tracks;
  tracks.points = m.points.points();
  if (m.lines) tracks.lines = m.lines->lines();
  return tracks;
}

std::shared_ptr<const GrayImage> FrontEnd::foundMask() const {
  const Impl& m = *impl_;
  if (m.vehicle.area().empty()) return nullptr;
  auto mask = std::make_shared<GrayImage>();
  mask->width = m.rig.camera.width;
  mask->height = m.rig.camera.height;
  for (int y = 0; y < mask->height; ++y)
    for (int x = 0; x < mask->width; ++x)
      mask->pixels.push_back(m.vehicle.area().at<unsigned char>(y, x) != 0 ? 0 : 255);
  if (m.rig.mask)
    for (std::size_t i = 0; i < mask->pixels.size(); ++i)
      mask->pixels[i] = std::min(mask->pixels[i], m.rig.mask->pixels[i]);
  return mask;
}

void FrontEnd::leaveOutVehicle(FrameTracks& tracks) const {
  const ImageMask& mask = impl_->mask;
  const auto isPoint = [&](const PointObservation& o) { return mask.covers(o.px); };
  const auto isLine = [&](const LineObservation& o) {
    return mask.covers(0.5 * (o.start_px + o.end_px)) || (mask.covers(o.start_px) && mask.covers(o.end_px));
  };
  tracks.points.erase(std::remove_if(tracks.points.begin(), tracks.points.end(), isPoint), tracks.points.end());
  tracks.lines.erase(std::remove_if(tracks.lines.begin(), tracks.lines.end(), isLine), tracks.lines.end());
}

CameraTurn FrontEnd::turn() const { return impl_->turn; }
const FrontEndStatistics& FrontEnd::statistics() const { return impl_->statistics; }

}  // namespace lintel
