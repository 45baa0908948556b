// SPDX-License-Identifier: BSD-3-Clause
#include "RawlogStream.h"

#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>

#include "RawlogImages.h"

namespace lintel {
namespace {

/// How far images are read ahead in search of an IMU sample: a longer wait is a drop-out, and holding more images would
/// let memory grow.
constexpr std::int64_t kSearchAhead_ns = 1000000000;
/// IMU samples that may wait for an image: over an hour at 200 Hz. Older ones are given up.
constexpr std::size_t kMaxWaitingSamples = 1000000;

template <class T>
T popFront(std::deque<T>& queue) {
  T front = std::move(queue.front());
  queue.pop_front();
  return front;
}

}  // namespace

RawlogStream::RawlogStream(const std::string& path, const RecordingParams& params, const GivenCalibration& given)
    : path_(path), probe_(probeRawlog(path, params, given)), file_(path) {
  if (probe_.first_external_image.empty()) return;
  images_folder_ = findImagesFolder(path, probe_.first_external_image, [this](Fault fault, std::string text) {
    probe_.warnings.push_back({fault, std::move(text)});
  });
}

void RawlogStream::takeImage(const std::shared_ptr<mrpt::obs::CObservation>& observation, const WarningSink& warn) {
  const std::int64_t t_ns = timeOf(*observation);
  if (!image_gate_.admit(
          t_ns, [this] { return file_.where(); }, warn))
    return;
  auto image = std::dynamic_pointer_cast<mrpt::obs::CObservationImage>(observation);
  frames_.push_back(
      {t_ns, [image = std::move(image), folder = images_folder_] { return decodeImage(*image, folder); }});
}

void RawlogStream::takeImu(const std::shared_ptr<mrpt::obs::CObservation>& observation, const WarningSink& warn) {
  using namespace mrpt::obs;
  const auto& imu = dynamic_cast<const CObservationIMU&>(*observation);
  if (!isComplete(imu)) {
    warn(Fault::ImuValue, file_.where() + ": IMU sample lacks angular velocities or accelerations: skipped");
    return;
  }
  const ImuSample sample{timeOf(imu),
                         {imu.get(IMU_WX), imu.get(IMU_WY), imu.get(IMU_WZ)},
                         {imu.get(IMU_X_ACC), imu.get(IMU_Y_ACC), imu.get(IMU_Z_ACC)}};
  if (!imu_gate_.admit(
          sample, [this] { return file_.where(); }, warn))
    return;
  if (samples_.size() >= kMaxWaitingSamples) samples_.pop_front();
  samples_.push_back(sample);
}

bool RawlogStream::pull(const WarningSink& warn) {
  const auto observation = file_.next();
  if (!observation) return false;
  const bool image = observation->sensorLabel == probe_.camera_label &&
                     dynamic_cast<const mrpt::obs::CObservationImage*>(observation.get());
  const bool imu = observation->sensorLabel == probe_.imu_label &&
                   dynamic_cast<const mrpt::obs::CObservationIMU*>(observation.get());
  if (!image && !imu) return true;
  if (timeOf(*observation) < 0) {
    warn(image ? Fault::ImageStamp : Fault::ImuStamp, file_.where() + ": no time stamp: skipped");
    return true;
  }
  if (image) takeImage(observation, warn);
  if (imu) takeImu(observation, warn);
  return true;
}

std::optional<FrameRef> RawlogStream::nextFrame(const WarningSink& warn) {
  while (frames_.empty())
    if (!pull(warn)) return std::nullopt;
  return popFront(frames_);
}

std::optional<ImuSample> RawlogStream::nextImu(std::int64_t needed_ns, const WarningSink& warn) {
  while (samples_.empty()) {
    if (!frames_.empty() && frames_.back().t_ns > needed_ns + kSearchAhead_ns) return std::nullopt;
    if (!pull(warn)) return std::nullopt;
  }
  return popFront(samples_);
}

}  // namespace lintel
