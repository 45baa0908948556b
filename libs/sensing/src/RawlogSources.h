// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "EurocFolder.h"
#include "EurocYaml.h"
#include "ImagePlacer.h"
#include "SensorStream.h"

namespace mrpt::obs {
class CObservation;
}

namespace lintel {

/// One sensor of an EuRoC folder as MRPT observations, in time order.
class RawlogSource {
 public:
  virtual ~RawlogSource() = default;

  /// Moves to the next observation; false at the end. Throws RecordingError.
  virtual bool advance(const WarningSink& warn) = 0;
  /// Time of the observation moved to, cut to ticks.
  virtual std::int64_t t_ns() const = 0;
  /// The observation moved to; null if it is left out with a warning.
  virtual std::shared_ptr<mrpt::obs::CObservation> make(const WarningSink& warn) = 0;
};

/// Images of `folder` (…/mav0/camN), labelled `label`; external ones are put to `placer`, embedded ones decoded if it
/// is null. `placer` must outlive the source.
std::unique_ptr<RawlogSource> makeImageSource(const std::string& folder, const std::string& label,
                                              const EurocCamera& camera, ImagePlacer* placer);

/// Samples of `folder` (…/mav0/imu0).
std::unique_ptr<RawlogSource> makeImuSource(const std::string& folder, const std::string& label, const EurocImu& imu);

/// Images of any recording, decoded: PNGs in `folder`, or embedded if that is empty.
std::unique_ptr<RawlogSource> makeImageSource(const std::shared_ptr<SensorStream>& stream, const std::string& label,
                                              const std::string& folder);

/// Samples of any recording, labelled imu0.
std::unique_ptr<RawlogSource> makeImuSource(const std::shared_ptr<SensorStream>& stream);

/// True poses of `csv` (EuRoC states), labelled "groundtruth".
std::unique_ptr<RawlogSource> makeGroundtruthSource(const std::string& csv);

/// A comment at `t_ns`.
std::shared_ptr<mrpt::obs::CObservation> makeComment(const std::string& text, std::int64_t t_ns);

}  // namespace lintel
