// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "lintel/sensing/Recording.h"
#include "lintel/testing/TempFolder.h"

namespace lintel::test {

/// A small EuRoC recording: 20 Hz images of 32x24 pixels, each different, 200 Hz IMU whose signals are linear in time,
/// ground truth, a rotated camera. Neither kind of stamp is a multiple of 100 ns, and IMU and images do not coincide.
struct TinyEuroc {
  static constexpr std::int64_t kFirst_ns = 1403636579763555584;  ///< first image
  static constexpr int kWidth = 32, kHeight = 24;

  int frames = 20;
  std::vector<std::string> cameras = {"cam0"};
  double imu_lead_s = 0.7;  ///< IMU before the first image
  bool groundtruth = true;

  /// Writes `root`/mav0.
  void write(const std::string& root) const;

  static std::int64_t frameStamp(int frame) { return kFirst_ns + frame * 50000000LL; }
  /// The signals at a time.
  static Eigen::Vector3d gyroAt(std::int64_t t_ns);
  static Eigen::Vector3d accelAt(std::int64_t t_ns);
};

void writeText(const std::string& path, const std::string& text);
/// Replaces the first `from`, which must be there.
void replaceInFile(const std::string& path, const std::string& from, const std::string& to);

/// All a recording gives. `error` is what next() threw in the end, else empty.
struct Everything {
  std::vector<FrameWithImu> steps;
  std::vector<std::string> warnings;
  std::string error;
};
Everything readAll(const std::string& path, const RecordingParams& params = {});
Everything readAll(Recording& recording);

/// What openRecording throws; empty if nothing.
std::string openingError(const std::string& path, const RecordingParams& params = {});

/// Fails the test unless both hold the same frames and IMU samples, bit by bit.
void expectSameSteps(const std::vector<FrameWithImu>& a, const std::vector<FrameWithImu>& b);
void expectSameRig(const Rig& a, const Rig& b);

}  // namespace lintel::test
