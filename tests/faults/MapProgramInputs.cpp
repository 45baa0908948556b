// SPDX-License-Identifier: BSD-3-Clause
// Maps that lintel-map is to search again, merge or export, beside the recording of the first.
#include <algorithm>
#include <sstream>

#include "FaultTable.h"
#include "TinyEuroc.h"
#include "lintel/inertial/Preintegration.h"
#include "lintel/mapping/MapFile.h"
#include "lintel/programs/LintelMap.h"
#include "lintel/sensing/Recording.h"

namespace lintel::test {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kKeyframes = 10;  // every other image

LineMap flightMap(const Rig& rig, double shift_m) {
  LineMap map;
  map.rig = rig;
  map.source = "flight";
  for (std::uint64_t i = 0; i < kKeyframes; ++i) {
    MapKeyframe keyframe;
    keyframe.id = i;
    keyframe.t_ns = TinyEuroc::frameStamp(static_cast<int>(2 * i)) / 100 * 100;  // as readers round them
    keyframe.T_w_b.p.x() = shift_m + 0.1 * static_cast<double>(i);
    if (i > 0) {
      auto imu = std::make_shared<Preintegration>(ImuBias{}, rig.imu_noise);
      imu->append({{map.keyframes.back().t_ns, {0, 0, 0}, {0, 0, 9.81}}, {keyframe.t_ns, {0, 0, 0}, {0, 0, 9.81}}});
      keyframe.imu = imu;
    }
    map.trajectory.emplace_back(keyframe.t_ns, keyframe.T_w_b);
    map.keyframes.push_back(keyframe);
  }
  const std::int64_t first_ns = map.keyframes.front().t_ns, last_ns = map.keyframes.back().t_ns;
  map.points.push_back({4, {0, 0, 5}, 0.1, first_ns, last_ns, {{0, {16, 12}}, {9, {15, 12}}}});
  const Segment3 segment_w{{0.45, -0.8, 2}, {0.45, 0.8, 2}};  // across the way, which is along x
  map.lines.push_back({7, segment_w, 0.01, 0.02, first_ns, last_ns, false, false, false, -1, {}});
  for (const MapKeyframe& keyframe : map.keyframes) {
    const Pose T_c_w = (keyframe.T_w_b * rig.T_b_c).inverse();
    map.lines[0].observations.push_back(
        {keyframe.id, rig.camera.project(T_c_w * segment_w.start), rig.camera.project(T_c_w * segment_w.end)});
  }
  map.pieces = {{0, first_ns, last_ns, 0, 0, 0}};
  map.views.push_back({0, {first_ns, {{{16, 12}, 4, 0, {1, 2, 3, 4}}}}});
  return map;
}

std::vector<std::string> argumentsOf(const std::string& form) {
  if (form == "densify")  // images of 32 pixels know a line badly
    return {"densify", "flight.lintel",
            "folder",  "-q",
            "-o",      "made.lintel",
            "--set",   "map.max_sigma_m=1",
            "--set",   "map.max_relative_sigma=1",
            "--set",   "map.max_sigma_direction_rad=1"};
  if (form == "merge") return {"merge", "flight.lintel", "second.lintel", "-q", "-o", "made.lintel"};
  return {"flight.lintel", "-q", "-o", "made." + form.substr(form.find(' ') + 1)};
}

}  // namespace

bool isMapProgram(const std::string& form) {
  return form == "densify" || form == "merge" || form.rfind("export ", 0) == 0;
}

void makeMapProgramInputs(const fs::path& folder) {
  const Rig rig = openRecording((folder / "folder").string())->rig();
  writeMap(flightMap(rig, 0), (folder / "flight.lintel").string());
  writeMap(flightMap(rig, 0.5), (folder / "second.lintel").string());
}

Outcome runMapProgram(const fs::path& work, const std::string& form) {
  std::vector<std::string> arguments = argumentsOf(form);
  std::vector<const char*> argv{"lintel-map"};
  for (std::string& argument : arguments) {
    if (argument == "folder" || fs::path(argument).stem() == "made" || fs::path(argument).extension() == ".lintel")
      argument = (work / argument).string();
    argv.push_back(argument.c_str());
  }
  std::ostringstream out, err;
  const int exit_code = runLintelMap(static_cast<int>(argv.size()), argv.data(), out, err);
  const bool made = std::any_of(fs::directory_iterator(work), fs::directory_iterator{},
                                [](const auto& e) { return e.path().stem() == "made"; });
  std::string message = err.str();
  const std::string name = "lintel-map: ";
  if (message.rfind(name, 0) == 0) message.erase(0, name.size());
  if (!message.empty() && message.back() == '\n') message.pop_back();
  if (exit_code == 0) return {made ? "written" : "SILENT LOSS", message};
  return {made ? "GARBAGE: a file is left" : "refused", message};
}

}  // namespace lintel::test
