// SPDX-License-Identifier: BSD-3-Clause
#include "BagStream.h"

#include "BagTopics.h"
#include "ByteReader.h"
#include "RosMessages.h"
#include "TimeTicks.h"

namespace lintel {
namespace {

/// A negative or absurd time is one that no stamp can have been meant to be.
bool isTime(std::int64_t t_ns) { return t_ns > 0; }

/// The samples of one topic; shared, as the functions that read it are copied.
class ImuTopic {
 public:
  ImuTopic(const Bag& bag, BagTopic topic, std::string path)
      : reader_(bag.read(topic.name)), topic_(std::move(topic)), path_(std::move(path)) {}

  std::optional<ImuSample> next(const WarningSink& warn) {
    while (std::optional<BagMessage> message = reader_->next()) {
      ++number_;
      const auto where = [this] { return path_ + ": " + topic_.name + ", message " + std::to_string(number_); };
      try {
        ImuSample sample = imuOf(*message, topic_.encoding);
        sample.t_ns = cutToTick(isTime(sample.t_ns) ? sample.t_ns : message->recorded_ns);
        if (gate_.admit(sample, where, warn)) return sample;
      } catch (const ByteReader::OutOfBytes&) {
        warn(Fault::ImuValue, where() + ": IMU sample is cut: skipped");
      }
    }
    return std::nullopt;
  }

 private:
  std::unique_ptr<BagReader> reader_;
  BagTopic topic_;
  std::string path_;
  std::size_t number_ = 0;
  ImuGate gate_;
};

}  // namespace

BagStream::BagStream(const std::string& path, const RecordingParams& params, const GivenCalibration& given)
    : path_(path),
      bag_(openBag(path)),
      images_(chooseImages(bag_->topics(), params.camera, given.cameraTopic(), path, warnings_)),
      imus_(chooseImu(bag_->topics(), params.imu, given.imuTopic(), path, warnings_)),
      rig_(given.rig([this] { return uncalibrated(); }, warnings_)),
      image_reader_(bag_->read(images_.name)),
      imu_(openImu(imus_.front())) {
  if (images_.rate_hz() > 0 && !given.cameraRate_hz()) rig_.camera_rate_hz = images_.rate_hz();
  if (imus_.front().rate_hz() > 0 && !given.imuRate_hz()) rig_.imu_rate_hz = imus_.front().rate_hz();
  checkOverlap();
  if (imus_.size() == 1) return;
  ImuJoiner joiner(imu_, openImu(imus_.back()));
  imu_ = [joiner](const WarningSink& warn) mutable { return joiner.next(warn); };
}

ImuSource BagStream::openImu(const BagTopic& topic) const {
  const auto source = std::make_shared<ImuTopic>(*bag_, topic, path_);
  return [source](const WarningSink& warn) { return source->next(warn); };
}

Rig BagStream::uncalibrated() const {
  throw RecordingError(path_ + ": a bag holds no calibration of camera and IMU: give it by --calibration " +
                       "camchain-imucam.yaml (Kalibr), or a file of OpenVINS or VINS");
}

void BagStream::checkOverlap() const {
  for (const BagTopic& imu : imus_)
    if (imu.count > 0 && images_.count > 0 && (imu.last_ns < images_.first_ns || images_.last_ns < imu.first_ns))
      throw RecordingError(path_ + ": " + images_.name + " and " + imu.name +
                           " do not overlap in time: name topics of one recording");
}

std::size_t BagStream::countFrames(const RecordingParams& params) const {
  return params.from_s > 0 || params.to_s > 0 ? 0 : images_.count;
}

std::optional<FrameRef> BagStream::nextFrame(const WarningSink& warn) {
  while (std::optional<BagMessage> message = image_reader_->next()) {
    std::int64_t t_ns = 0;
    try {
      t_ns = stampOf(*message, images_.encoding);
    } catch (const ByteReader::OutOfBytes&) {
      warn(Fault::Image,
           path_ + ": " + images_.name + " at " + secondsText(message->recorded_ns) + ": the message is cut: skipped");
      continue;
    }
    t_ns = cutToTick(isTime(t_ns) ? t_ns : message->recorded_ns);
    const auto where = [&] { return path_ + ": " + images_.name; };
    if (!image_gate_.admit(t_ns, where, warn)) continue;
    return FrameRef{t_ns, [message = std::move(*message), topic = images_,
                           name = where() + " at " + secondsText(t_ns)] { return imageOf(message, topic, name); }};
  }
  return std::nullopt;
}

std::optional<ImuSample> BagStream::nextImu(std::int64_t, const WarningSink& warn) { return imu_(warn); }

}  // namespace lintel
