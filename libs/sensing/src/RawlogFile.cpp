// SPDX-License-Identifier: BSD-3-Clause
#include "RawlogFile.h"

#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationStereoImages.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <cstring>

#include "GzStream.h"
#include "RawlogTime.h"
#include "lintel/sensing/Recording.h"

namespace lintel {
namespace {

/// Null at a clean end; anything thrown means damage.
mrpt::serialization::CSerializable::Ptr readObject(GzInput& stream) {
  auto archive = mrpt::serialization::archiveFrom(stream);
  const std::uint64_t begin = stream.bytesRead();
  try {
    return archive.ReadObject();
  } catch (const mrpt::serialization::CExceptionEOF&) {
    if (stream.bytesRead() != begin || stream.damaged()) throw;
    return nullptr;
  }
}

/// MRPT reads flags byte by byte into bools: a damaged byte must become one before anybody looks at it.
void repairFlags(mrpt::obs::CObservation& observation) {
  const auto imu = dynamic_cast<mrpt::obs::CObservationIMU*>(&observation);
  if (imu == nullptr) return;
  unsigned char bytes[sizeof imu->dataIsPresent];
  std::memcpy(bytes, imu->dataIsPresent.data(), sizeof bytes);
  for (std::size_t i = 0; i < sizeof bytes; ++i) imu->dataIsPresent[i] = bytes[i] != 0;
}

std::shared_ptr<mrpt::obs::CObservation> leftOf(const mrpt::obs::CObservationStereoImages& pair) {
  auto left = mrpt::obs::CObservationImage::Create();
  left->sensorLabel = pair.sensorLabel;
  left->timestamp = pair.timestamp;
  left->cameraParams = pair.leftCamera;
  left->cameraPose = mrpt::poses::CPose3D(pair.cameraPose);
  left->image = pair.imageLeft;
  return left;
}

}  // namespace

RawlogFile::RawlogFile(const std::string& path) : path_(path), stream_(std::make_unique<GzInput>(path)) {}

RawlogFile::~RawlogFile() = default;

std::string RawlogFile::where() const { return path_ + ": entry " + std::to_string(entries_ > 0 ? entries_ - 1 : 0); }

std::shared_ptr<mrpt::obs::CObservation> RawlogFile::next() {
  const auto observation = nextAsRead();
  if (observation) repairFlags(*observation);
  const auto* pair = dynamic_cast<const mrpt::obs::CObservationStereoImages*>(observation.get());
  return pair ? leftOf(*pair) : observation;
}

std::shared_ptr<mrpt::obs::CObservation> RawlogFile::nextAsRead() {
  while (pending_.empty()) {
    mrpt::serialization::CSerializable::Ptr object;
    try {
      object = readObject(*stream_);
    } catch (const std::exception&) {  // its text is a stack trace
      if (entries_ == 0) throw RecordingError(path_ + ": not a rawlog, or its beginning is damaged: make it anew");
      throw RecordingError(path_ + ": cut or damaged after " + std::to_string(entries_) +
                           " entries: make it anew or repair it with rawlog-edit --cut --to-index");
    }
    if (!object) return nullptr;
    ++entries_;
    if (auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object)) return observation;
    if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object))
      pending_.assign(frame->begin(), frame->end());
  }
  auto observation = pending_.front();
  pending_.pop_front();
  return observation;
}

void writeObservation(GzOutput& file, const mrpt::obs::CObservation& observation) {
  try {
    mrpt::serialization::archiveFrom(file) << observation;
  } catch (const std::exception&) {
    file.check();  // MRPT has wrapped what we threw into a stack trace
    throw;
  }
}

std::int64_t timeOf(const mrpt::obs::CObservation& observation) { return fromRawlogTime(observation.timestamp); }

}  // namespace lintel
