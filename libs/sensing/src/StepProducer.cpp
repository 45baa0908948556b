// SPDX-License-Identifier: BSD-3-Clause
#include "StepProducer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "TimeTicks.h"
#include "lintel/core/ThreadTime.h"

namespace lintel {

namespace {

constexpr std::int64_t kLongestRepeat_ns = 1'000'000'000;

}  // namespace

FrameRange::FrameRange(const RecordingParams& params, std::int64_t first_ns)
    : from_ns(first_ns + std::llround(params.from_s * 1e9)),
      to_ns(params.to_s > 0 ? first_ns + std::llround(params.to_s * 1e9) : std::numeric_limits<std::int64_t>::max()) {}

StepProducer::StepProducer(std::unique_ptr<SensorStream> stream, const RecordingParams& params)
    : stream_(std::move(stream)),
      params_(params),
      imu_([this](std::int64_t needed_ns) { return stream_->nextImu(needed_ns, sink_); }),
      sink_([this](Fault fault, std::string text) { warn(fault, std::move(text)); }) {}

std::optional<FrameRef> StepProducer::nextInRange() {
  while (std::optional<FrameRef> ref = stream_->nextFrame(sink_)) {
    if (!range_) range_.emplace(params_, ref->t_ns);
    if (ref->t_ns > range_->to_ns) return std::nullopt;
    last_seen_ns_ = ref->t_ns;
    if (ref->t_ns >= range_->from_ns) return ref;
    imu_.skipTo(ref->t_ns);
  }
  return std::nullopt;
}

std::shared_ptr<const GrayImage> StepProducer::decode(const FrameRef& ref) {
  try {
    auto image = std::make_shared<const GrayImage>(ref.decode());
    const Camera& camera = stream_->rig().camera;
    if (image->width == camera.width && image->height == camera.height) return image;
    throw ImageFault("image at " + secondsText(ref.t_ns) + " is " + std::to_string(image->width) + "x" +
                     std::to_string(image->height) + " pixels, its calibration " + std::to_string(camera.width) + "x" +
                     std::to_string(camera.height));
  } catch (const ImageFault& fault) {
    if (unreadable_++ == 0) first_unreadable_ = fault.what();
    warn(Fault::Image, std::string(fault.what()) + ": frame skipped");
    return nullptr;
  }
}

/// Whether the image shows again, byte for byte, what the one before did: a driver or an encoder that had no new one. A
/// camera at rest has noise; where there is none, images are delivered again after a second. One of a single grey (a
/// lens that is covered) is none.
bool StepProducer::isRepeat(const FrameRef& ref, const std::shared_ptr<const GrayImage>& image) {
  const std::vector<std::uint8_t>& pixels = image->pixels;
  const bool same =
      shown_ && pixels == shown_->pixels &&
      std::any_of(pixels.begin(), pixels.end(), [&](std::uint8_t grey) { return grey != pixels.front(); });
  if (!same) shown_ns_ = ref.t_ns;
  shown_ = image;
  if (!same || ref.t_ns - shown_ns_ > kLongestRepeat_ns) return false;
  warn(Fault::ImageRepeat, "image at " + secondsText(ref.t_ns) + " shows the one before again: frame skipped");
  return true;
}

ImuBatch StepProducer::imuOf(std::int64_t t_ns) {
  ImuBatch batch = previous_ns_ ? imu_.between(*previous_ns_, t_ns) : imu_.before(t_ns);
  const auto bridged = std::find_if(batch.begin(), batch.end(), [](const ImuSample& s) { return s.bridged; });
  if (bridged != batch.end() && !bridging_)
    warn(Fault::ImuBridged,
         stream_->path() + ": the IMU has a drop-out at " + secondsText(bridged->t_ns) + ": bridged");
  bridging_ = !batch.empty() && batch.back().bridged;
  if (!batch.empty()) {
    ++with_imu_;
  } else if (previous_ns_) {
    warn(Fault::ImuGap, stream_->path() + ": the IMU does not cover " + secondsText(*previous_ns_) + " to " +
                            secondsText(t_ns) + ": frame delivered without IMU");
  }
  return batch;
}

Step StepProducer::next() {
  const double start_ms = threadTimeMs();
  Step step;
  while (const std::optional<FrameRef> ref = nextInRange()) {
    std::shared_ptr<const GrayImage> image = decode(*ref);
    if (!image || isRepeat(*ref, image)) continue;
    step.frame = FrameWithImu{{ref->t_ns, std::move(image)}, imuOf(ref->t_ns), threadTimeMs() - start_ms};
    previous_ns_ = ref->t_ns;
    ++delivered_;
    break;
  }
  if (!step.frame) checkEnd();
  step.warnings.swap(warnings_);
  return step;
}

void StepProducer::checkEnd() const {
  if (delivered_ > 1 && with_imu_ == 0)
    throw RecordingError(stream_->path() + ": images and IMU do not overlap in time: check their time stamps");
  if (delivered_ > 0) return;
  if (!range_) throw RecordingError(stream_->path() + ": no images: nothing to read");
  if (unreadable_ > 0)
    throw RecordingError(stream_->path() + ": none of " + std::to_string(unreadable_) +
                         " images can be used; the first: " + first_unreadable_);
  throw RecordingError(stream_->path() + ": no image between " + std::to_string(params_.from_s) + " s and " +
                       (params_.to_s > 0 ? std::to_string(params_.to_s) + " s" : std::string("the end")) +
                       " after the first: choose another range (last image seen at " + secondsText(last_seen_ns_) +
                       ")");
}

}  // namespace lintel
