// SPDX-License-Identifier: BSD-3-Clause
#include "EurocStream.h"

#include "EurocYaml.h"
#include "ImageFile.h"

namespace lintel {
namespace {

void ignoreFault(Fault, const std::string&) {}

}  // namespace

EurocStream::EurocStream(const std::string& path, const RecordingParams& params, const GivenCalibration& given)
    : mav0_(findMav0(path)),
      camera_folder_(mav0_ + "/" + (params.camera.empty() ? "cam0" : params.camera)),
      imu_folder_(mav0_ + "/" + (params.imu.empty() ? "imu0" : params.imu)),
      rig_(given.rig(
          [this] {
            return rigOf(loadEurocCamera(camera_folder_ + "/sensor.yaml"), loadEurocImu(imu_folder_ + "/sensor.yaml"));
          },
          warnings_)),
      images_(camera_folder_),
      imu_(imu_folder_) {
  checkOverlap();
}

void EurocStream::checkOverlap() const {
  const auto first_image = EurocImageList(camera_folder_).next(ignoreFault);
  if (!first_image) throw RecordingError(camera_folder_ + "/data.csv: lists no images: nothing to read");
  EurocImuList samples(imu_folder_);
  std::optional<ImuSample> last = samples.next(ignoreFault);
  if (!last) throw RecordingError(imu_folder_ + "/data.csv: holds no samples: the IMU is needed");
  // Reads on only until the IMU reaches the first image; a late start shows when the stream is read.
  while (last && last->t_ns < first_image->t_ns) last = samples.next(ignoreFault);
  if (!last)
    throw RecordingError(
        mav0_ +
        ": images and IMU do not overlap in time (the IMU ends before the first image): check their time stamps");
}

std::size_t EurocStream::countFrames(const RecordingParams& params) const {
  EurocImageList list(camera_folder_);
  std::optional<ImageEntry> entry = list.next(ignoreFault);
  if (!entry) return 0;
  const FrameRange range(params, entry->t_ns);
  std::size_t count = 0;
  for (; entry && entry->t_ns <= range.to_ns; entry = list.next(ignoreFault)) count += entry->t_ns >= range.from_ns;
  return count;
}

std::optional<FrameRef> EurocStream::nextFrame(const WarningSink& warn) {
  std::optional<ImageEntry> entry = images_.next(warn);
  if (!entry) return std::nullopt;
  return FrameRef{entry->t_ns, [path = std::move(entry->path)] { return readGrayImage(path); }};
}

std::optional<ImuSample> EurocStream::nextImu(std::int64_t, const WarningSink& warn) { return imu_.next(warn); }

}  // namespace lintel
