// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdlib>
#include <map>
#include <stdexcept>

#include "FaultEdits.h"
#include "FaultTable.h"
#include "ProgramMain.h"
#include "TinyEuroc.h"
#include "lintel/bench/BenchSuite.h"
#include "lintel/evaluation/Consistency.h"
#include "lintel/evaluation/TrajectoryFile.h"
#include "lintel/inertial/Preintegration.h"
#include "lintel/mapping/MapFile.h"
#include "lintel/pipeline/Configuration.h"
#include "lintel/sensing/Calibration.h"
#include "lintel/sensing/EurocToRawlog.h"

namespace lintel::test {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kFrames = 20;

std::string firstLineWithout(const std::string& folder, std::string text) {
  for (std::size_t at = 0; (at = text.find(folder)) != std::string::npos;) text.erase(at, folder.size());
  if (const std::size_t end = text.find('\n'); end != std::string::npos)
    text = "MORE THAN ONE LINE: " + text.substr(0, end);
  for (char& c : text)
    if (c == '|' || static_cast<unsigned char>(c) > 0x7e) c = '?';  // what the table has no place for
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

/// Whether two runs through a recording gave the same.
bool sameSteps(const std::vector<FrameWithImu>& a, const std::vector<FrameWithImu>& b) {
  const auto same_sample = [](const ImuSample& x, const ImuSample& y) {
    return x.t_ns == y.t_ns && x.gyro == y.gyro && x.accel == y.accel;
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](const FrameWithImu& x, const FrameWithImu& y) {
    return x.frame.t_ns == y.frame.t_ns && x.frame.image->pixels == y.frame.image->pixels &&
           std::equal(x.imu.begin(), x.imu.end(), y.imu.begin(), y.imu.end(), same_sample);
  });
}

/// What no reader may give, whatever it reads.
std::string garbageIn(const std::vector<FrameWithImu>& steps) {
  std::int64_t last_ns = 0, last_imu_ns = 0;
  for (const FrameWithImu& step : steps) {
    if (step.frame.t_ns <= last_ns) return "GARBAGE: frames out of order";
    last_ns = step.frame.t_ns;
    for (const ImuSample& sample : step.imu) {
      if (!sample.gyro.allFinite() || !sample.accel.allFinite()) return "GARBAGE: IMU sample not finite";
      if (sample.t_ns < last_imu_ns) return "GARBAGE: IMU samples out of order";
      last_imu_ns = sample.t_ns;
    }
  }
  return "";
}

/// The first poses of trajectory.tum.
StampedPoses fivePoses() {
  StampedPoses poses;
  for (std::int64_t i = 0; i < 5; ++i) poses.emplace_back(i * 1000000000 + 500000000, Pose{});
  return poses;
}

std::string covariancesOfFivePoses() {
  std::string text = "# timestamp and the upper triangle\n";
  for (int i = 0; i < 5; ++i) {
    text += std::to_string(i) + ".500000000";
    for (int r = 0; r < 6; ++r)
      for (int c = r; c < 6; ++c) text += r == c ? ",1.5e-4" : ",-2e-6";
    text += "\n";
  }
  return text;
}

/// A map with all sections.
LineMap wholeMap() {
  LineMap map;
  map.rig.camera = {752, 480, 458, 457, 367, 248, -0.28, 0.07, 2e-4, 2e-5};
  map.rig.camera.model = LensModel::kDoubleSphere;
  map.configuration = "a: 1\n", map.source = "monday";
  map.keyframes.resize(4);
  for (std::uint64_t i = 0; i < map.keyframes.size(); ++i)
    map.keyframes[i].id = 3 * i, map.keyframes[i].t_ns = static_cast<std::int64_t>(1000 + i);
  auto imu = std::make_shared<Preintegration>(ImuBias{}, ImuNoise{1e-3, 1e-4, 1e-5, 1e-6});
  imu->append({{5, {0, 0, 1}, {0, 0, 9.8}}, {1000005, {0, 1, 0}, {0, 0, 9.8}, true}});
  map.keyframes[1].imu = imu, map.keyframes[1].at_rest = true;
  map.points.push_back({4, {1, 2, 3}, 0.5, 1000, 1001, {{0, {10, 20}}, {3, {11, 20}}}});
  for (std::uint64_t i = 0; i < 3; ++i)
    map.lines.push_back({7 + i, {{1, 2, 3}, {4, 5, 6}}, 0.01, 0.02, 1000, 1001, i == 0, i == 1, false, int(i) - 1, {}});
  map.lines[0].observations = {{0, {1, 2}, {3, 4}}, {3, {5, 6}, {7, 8}}};
  map.lines[1].covariance.setConstant(0.25F);
  map.groups = {{"vertical", {0, 0, 1}, 0.01}, {"horizontal 1", {1, 0, 0}, 0.02}};
  map.camera_errors.assign(map.keyframes.size(), CameraErrors::Constant(0.25F));
  map.corners = {{{1, 2, 3}, 0.01, {7, 8}}};
  map.planes = {{"floor", {0, 0, 1}, -0.5, 0.003, {8, 9}, {4}}};
  for (int i = 0; i < 4; ++i) map.trajectory.emplace_back(1000 + i, Pose{});
  map.time_offset_s = -0.0031, map.recordings = {"monday", "tuesday"};
  map.pieces = {{0, 1000, 1001, 0, 0, 0}, {6, 1002, 1003, 2, 0, 1}};
  map.views.push_back({1, {1002, {{{1.5F, 2.25F}, 4, 0, {1, 2, 3, 4}}}}});
  return map;
}

void readFile(const fs::path& work, const std::string& form) {
  const std::string path = (work / form).string();
  Configuration configuration;
  if (form == "configuration.yaml") readConfiguration(path, configuration);
  if (form == "kalibr.yaml" || form == "vins.yaml") {
    const Calibration calibration = readCalibration({path});
    if (calibration.cameras.empty()) throw RecordingError(path + ": holds no camera");
    for (const CameraCalibration& camera : calibration.cameras) camera.make();
  }
  if (fs::path(form).extension() == ".lintel") readMap(path);
  if (form == "trajectory.tum") readTrajectory(path);
  if (form == "trajectory_covariance.csv") readCovariances(path, fivePoses());
  if (form == "suite.yaml") readSuite(path, work.string());
}

}  // namespace

FaultInputs::FaultInputs(const fs::path& folder) : folder_(folder) {
  fs::create_directories(folder_ / "whole");
  makeRecordings();
  makeOtherFiles();
}

void FaultInputs::makeRecordings() const {
  const fs::path whole = folder_ / "whole";
  TinyEuroc().write((whole / "folder").string());
  EurocToRawlogParams params;
  eurocToRawlog((whole / "folder").string(), (whole / "external.rawlog").string(), params);
  params.embed = true;
  eurocToRawlog((whole / "folder").string(), (whole / "embedded.rawlog").string(), params);
  const std::string command =
      "cd '" + whole.string() +
      "/folder' && /usr/bin/python3 '" LINTEL_SOURCE_DIR
      "/tests/recordings/make_bags' . ros1.bag lz4.bag ros2.db3 plain.mcap zstd_compressed.mcap "
      "> ../log 2>&1 && mv *.bag *.db3 *.mcap ..";
  if (std::system(command.c_str()) != 0) throw std::runtime_error("make_bags: " + bytesOf(whole / "log"));
}

void FaultInputs::makeOtherFiles() const {
  const fs::path whole = folder_ / "whole";
  writeText((whole / "configuration.yaml").string(), writeConfiguration({}));
  const Rig rig = openRecording((whole / "folder").string())->rig();
  for (const char* form : {"kalibr", "vins"})
    writeText((whole / (std::string(form) + ".yaml")).string(), writeCalibration(rig, 0.01, form));
  LineMap map;
  map.points.resize(3);
  map.lines.resize(2);
  map.keyframes.resize(2);
  for (std::uint64_t i = 0; i < map.points.size(); ++i) map.points[i].id = i;
  for (std::uint64_t i = 0; i < map.lines.size(); ++i) map.lines[i].id = i;
  for (std::uint64_t i = 0; i < map.keyframes.size(); ++i)
    map.keyframes[i].id = i, map.keyframes[i].t_ns = static_cast<std::int64_t>(1 + i);
  writeMap(map, (whole / "map.lintel").string());
  writeMap(wholeMap(), (whole / "whole_map.lintel").string());
  makeMapProgramInputs(whole);
  writeText((whole / "trajectory_covariance.csv").string(), covariancesOfFivePoses());
  std::string trajectory = "# t x y z qx qy qz qw\n";
  for (int i = 0; i < 20; ++i) trajectory += std::to_string(i) + ".5 1 2 " + std::to_string(i) + " 0 0 0 1\n";
  writeText((whole / "trajectory.tum").string(), trajectory);
  writeText((whole / "suite.yaml").string(),
            "title: Test\nrecordings:\n  - folder\n  - {name: made, sim: {scene: room, duration: 5}}\nconfigurations:\n"
            "  - {name: points, set: [features=points]}\n  - {name: lines}\nstarts_s: [0, 10]\n");
}

Outcome FaultInputs::readRecording(const fs::path& work, const std::string& name, bool calibrated,
                                   bool fewer_listed) const {
  RecordingParams params;
  params.frames_ahead = 0;
  if (calibrated)
    for (const char* sensor : {"cam0", "imu0"})
      params.calibration.push_back((folder_ / "whole/folder/mav0" / sensor / "sensor.yaml").string());
  const auto recording = openRecording((work / name).string(), params);
  const Everything all = readAll(*recording);
  Outcome outcome;
  if (!all.warnings.empty()) outcome.message = all.warnings.front();
  if (!all.error.empty()) outcome.message = all.error;
  const std::string count = std::to_string(all.steps.size()) + " of " + std::to_string(kFrames) + " frames";
  const bool complete = all.steps.size() == kFrames;
  outcome.text = !all.error.empty() ? "ends after " + count : complete ? "all frames" : count;
  if (const std::string garbage = garbageIn(all.steps); !garbage.empty()) outcome.text = garbage;
  static const std::vector<FrameWithImu> kWhole = readAll((folder_ / "whole/folder").string()).steps;
  if (!all.error.empty() || !all.warnings.empty()) return outcome;
  if (!complete && !fewer_listed) outcome.text += ", SILENT LOSS";
  if (complete && !sameSteps(all.steps, kWhole)) outcome.text += ", other values";
  return outcome;
}

Outcome FaultInputs::outcomeOf(const FaultRow& fault) const {
  const fs::path work = folder_ / "work";
  fs::remove_all(work);
  fs::create_directories(work);
  const auto copy = [&](const std::string& name) {
    if (fs::exists(folder_ / "whole" / name))
      fs::copy(folder_ / "whole" / name, work / name, fs::copy_options::recursive);
  };
  copy(fault.form);
  if (fault.form == "external.rawlog") copy("external_Images");
  if (isMapProgram(fault.form))
    for (const char* name : {"folder", "flight.lintel", "second.lintel"}) copy(name);
  const std::string extension = fs::path(fault.form).extension().string();
  const bool bag = extension == ".bag" || extension == ".db3" || extension == ".mcap";
  const bool recording = bag || fault.form == "folder" || extension == ".rawlog";
  applyEdits(fault.form == "folder" ? work / "folder/mav0" : work, fault.edits);
  Outcome outcome{"read", ""};
  try {
    if (isMapProgram(fault.form))
      outcome = runMapProgram(work, fault.form);
    else if (recording)
      outcome = readRecording(work, fault.form, bag, fault.kind == "frames that were not recorded");
    else
      readFile(work, fault.form);
  } catch (const std::exception& error) {
    outcome = {"refused", error.what()};
  }
  outcome.message = oneLine(firstLineWithout(work.string() + "/", outcome.message));
  return outcome;
}

}  // namespace lintel::test
