// SPDX-License-Identifier: BSD-3-Clause
#include "Parsers.h"

#include <exception>

#include "GrayPng.h"
#include "ImageFile.h"
#include "MapChecksums.h"
#include "TinyEuroc.h"
#include "lintel/bench/BenchSuite.h"
#include "lintel/evaluation/Consistency.h"
#include "lintel/evaluation/TrajectoryFile.h"
#include "lintel/mapping/MapFile.h"
#include "lintel/pipeline/Configuration.h"
#include "lintel/sensing/Calibration.h"
#include "lintel/testing/TempFolder.h"

namespace lintel::test {

namespace {

/// A folder with a small recording, made once.
const TempFolder& workFolder() {
  static const TempFolder kFolder;
  static const bool kMade = [] {
    TinyEuroc recording;
    recording.frames = 4;
    recording.imu_lead_s = 0.1;
    recording.write(kFolder / "flight");
    recording.write(kFolder / "changed");
    return true;
  }();
  static_cast<void>(kMade);
  return kFolder;
}

std::string fileWith(const std::string& name, const std::string& bytes) {
  std::string path = workFolder() / name;
  writeText(path, bytes);
  return path;
}

void readThrough(const std::string& path, bool calibrated) {
  RecordingParams params;
  params.frames_ahead = 0;
  if (calibrated)
    for (const char* sensor : {"cam0", "imu0"})
      params.calibration.push_back(workFolder() / (std::string("flight/mav0/") + sensor + "/sensor.yaml"));
  const auto recording = openRecording(path, params);
  for (int i = 0; i < 100 && recording->next(); ++i) {
  }
  recording->warnings();
}

/// One file of an EuRoC folder.
void folderWith(const std::string& file, const std::string& bytes) {
  const std::string path = workFolder() / ("changed/mav0/" + file), before = bytesOf(path);
  writeText(path, bytes);
  try {
    readThrough(workFolder() / "changed", false);
  } catch (const std::exception&) {
  }
  writeText(path, before);
}

void calibration(const std::string& bytes) {
  const Calibration calibration = readCalibration({fileWith("calibration.yaml", bytes)});
  for (const CameraCalibration& camera : calibration.cameras) camera.make();
}

/// Of the five poses that the seed has.
void covariance(const std::string& bytes) {
  StampedPoses poses;
  for (std::int64_t i = 0; i < 5; ++i) poses.emplace_back(i * 1000000000 + 500000000, Pose{});
  poses[1].second.q = Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5);
  const auto covariances = readCovariances(fileWith("covariance.csv", bytes), poses);
  evaluateConsistency(poses, covariances, poses);
}

void png(const std::string& bytes) {
  const std::vector<std::uint8_t> file(bytes.begin(), bytes.end());
  decodeGrayPng(file);
  isDamagedPng(file);
  decodeGrayImage(file, "image");
}

}  // namespace

const std::vector<Parser>& parsers() {
  static const std::vector<Parser> kParsers{
      {"euroc_imu", "folder/mav0/imu0/data.csv", [](const std::string& b) { folderWith("imu0/data.csv", b); }},
      {"euroc_images", "folder/mav0/cam0/data.csv", [](const std::string& b) { folderWith("cam0/data.csv", b); }},
      {"euroc_camera", "folder/mav0/cam0/sensor.yaml", [](const std::string& b) { folderWith("cam0/sensor.yaml", b); }},
      {"kalibr", "kalibr.yaml", calibration},
      {"vins", "vins.yaml", calibration},
      {"configuration", "configuration.yaml",
       [](const std::string& b) {
         Configuration configuration;
         readConfiguration(fileWith("configuration.yaml", b), configuration);
       }},
      {"trajectory", "trajectory.tum", [](const std::string& b) { readTrajectory(fileWith("trajectory.tum", b)); }},
      {"covariance", "trajectory_covariance.csv", covariance},
      {"map", "map.lintel", [](const std::string& b) { mapFromBytes(b, "map"); }},
      {"map_sections", "whole_map.lintel", [](const std::string& b) { mapFromBytes(withRightChecksums(b), "map"); }},
      {"suite", "suite.yaml",
       [](const std::string& b) { readSuite(fileWith("suite.yaml", b), workFolder().path().string()); }},
      {"rawlog", "plain.rawlog", [](const std::string& b) { readThrough(fileWith("fuzzed.rawlog", b), false); }},
      {"ros1", "ros1.bag", [](const std::string& b) { readThrough(fileWith("fuzzed.bag", b), true); }},
      {"sqlite", "ros2.db3", [](const std::string& b) { readThrough(fileWith("fuzzed.db3", b), true); }},
      {"mcap", "plain.mcap", [](const std::string& b) { readThrough(fileWith("fuzzed.mcap", b), true); }},
      {"png", "image.png", png}};
  return kParsers;
}

void feed(const Parser& parser, const std::string& bytes) {
  try {
    parser.parse(bytes);
  } catch (const std::exception&) {
  }
}

}  // namespace lintel::test
