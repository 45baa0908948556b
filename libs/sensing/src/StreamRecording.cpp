// SPDX-License-Identifier: BSD-3-Clause
#include "StreamRecording.h"

#include <algorithm>

#include "ImageFile.h"
#include "lintel/core/ParamRange.h"

namespace lintel {
namespace {

/// Throws RecordingError.
std::shared_ptr<const GrayImage> readMask(const std::string& file, const Camera& camera) {
  if (file.empty()) return nullptr;
  GrayImage mask;
  try {
    mask = readGrayImage(file);
  } catch (const ImageFault& fault) {
    throw RecordingError(std::string(fault.what()) + ": give an image of the camera's size as mask");
  }
  if (mask.width != camera.width || mask.height != camera.height)
    throw RecordingError(file + ": the mask is " + std::to_string(mask.width) + "x" + std::to_string(mask.height) +
                         " pixels, the camera " + std::to_string(camera.width) + "x" + std::to_string(camera.height) +
                         ": give a mask of the camera's size");
  if (std::all_of(mask.pixels.begin(), mask.pixels.end(), [](std::uint8_t grey) { return grey == 0; }))
    throw RecordingError(file + ": the mask is black everywhere: make it white where the image is to be used");
  return std::make_shared<const GrayImage>(std::move(mask));
}

}  // namespace

StreamRecording::StreamRecording(std::unique_ptr<SensorStream> stream, const RecordingParams& params)
    : rig_(stream->rig()),
      expected_frames_(stream->countFrames(params)),
      runs_ahead_(params.frames_ahead > 0),
      log_(stream->openingWarnings()),
      producer_(std::move(stream), params),
      queue_(params.frames_ahead) {
  rig_.mask = readMask(params.mask, rig_.camera);
  checkAllowed("gravity_m_s2", params.gravity_m_s2, Range{1, 30});
  rig_.gravity_m_s2 = params.gravity_m_s2;
}

StreamRecording::~StreamRecording() {
  queue_.close();
  if (thread_.joinable()) thread_.join();
}

StreamRecording::ItemPtr StreamRecording::produce() {
  auto item = std::make_unique<Item>();
  try {
    item->step = producer_.next();
  } catch (...) {
    item->error = std::current_exception();
  }
  return item;
}

void StreamRecording::runAhead() {
  try {
    for (bool last = false; !last;) {
      ItemPtr item = produce();
      last = item->last();
      if (!queue_.push(std::move(item))) return;
    }
  } catch (...) {  // no memory for the item itself
    failure_ = std::current_exception();
    queue_.close();
  }
}

StreamRecording::ItemPtr StreamRecording::take() {
  if (!runs_ahead_) return produce();
  if (!thread_.joinable()) thread_ = std::thread([this] { runAhead(); });
  if (auto item = queue_.pop()) return std::move(*item);
  std::rethrow_exception(failure_);  // what else closes it while items are taken
}

std::optional<FrameWithImu> StreamRecording::next() {
  if (finished_) return std::nullopt;
  const ItemPtr item = take();
  finished_ = item->last();
  for (const Warning& warning : item->step.warnings) log_.add(warning);
  if (item->error) std::rethrow_exception(item->error);
  return std::move(item->step.frame);
}

}  // namespace lintel
