// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "lintel/sensing/Recording.h"

namespace lintel {

/// How to write a recording as a rawlog.
struct EurocToRawlogParams {
  std::vector<std::string> cameras;  ///< folders below mav0, also the sensor labels; empty = every camN there is
  RecordingParams recording;         ///< calibration, sensors and tables of what is not an EuRoC folder
  bool embed = false;                ///< images into the rawlog; else as files in NAME_Images beside it
  bool copy = false;                 ///< copy external images; else link them (hard, else symbolic, else copied)
  int compress_level = 5;            ///< gzip 1 to 9; 0 = plain
  bool overwrite = false;            ///< replace an existing rawlog and its image folder
};

/// What has been written.
struct EurocToRawlogSummary {
  std::map<std::string, std::size_t> images;  ///< by sensor label
  std::size_t imu_samples = 0, groundtruth_poses = 0;
  std::int64_t first_ns = 0, last_ns = 0;  ///< of all observations
  std::string images_folder;               ///< empty when embedded
  std::size_t linked = 0, copied = 0;      ///< external images
  std::vector<std::string> warnings;       ///< faults of the folder, one line each
};

/// Called after every image with the images done and those there are.
using EurocToRawlogProgress = std::function<void(std::size_t done, std::size_t total)>;

/// Writes cameras, imu0 and, if there is one, the ground truth (state_groundtruth_estimate0) of an EuRoC folder (…/mav0
/// or its parent) in time order to `rawlog` (NAME.rawlog): CObservationImage with the calibration, CObservationIMU,
/// CObservationRobotPose labelled "groundtruth", and at the head a CObservationComment with the IMU's noise. Nothing
/// appears under the final names before all is written. Times are cut to the rawlog's 100 ns, as openRecording does
/// with a folder: both give the same stream. Throws RecordingError (input) or std::runtime_error (output).
/// Any other recording that openRecording() takes, and a folder with a calibration of its own in `params.recording`,
/// gives one camera, labelled cam0, and imu0; its images are decoded and stored as PNGs.
EurocToRawlogSummary eurocToRawlog(const std::string& folder, const std::string& rawlog,
                                   const EurocToRawlogParams& params = {}, const EurocToRawlogProgress& progress = {});

}  // namespace lintel
