// SPDX-License-Identifier: BSD-3-Clause
//
// tracking_figures RECORDING [key=value ...]: runs the front end on a recording and measures its results. With true
// poses: errors of points (PointErrors.h). With true edges, too (rendered recordings): identity switches of lines and
// calibration of their sigma_px (IdentityCheck.h). Keys: see setKey(); lines=0 tracks points only.
#include <time.h>

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <string>

#include "../ToolMain.h"
#include "IdentityCheck.h"
#include "PointErrors.h"
#include "TrueEdges.h"
#include "lintel/sensing/Recording.h"
#include "lintel/tracking/FrontEnd.h"

namespace lintel {
namespace {

double cpuSeconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);  // every thread of the process
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// How often each identity was seen: in all frames, and in every second one (the estimator's window).
struct Sightings {
  int frames = 0, window_frames = 0;
};

void printSummary(const FrontEndStatistics& s, const std::map<TrackId, Sightings>& sightings, double cpu_s) {
  std::size_t long_ones = 0;
  double sum = 0;
  for (const auto& [id, seen] : sightings) {
    long_ones += seen.window_frames >= 5;
    sum += seen.frames;
  }
  const auto frames = static_cast<double>(s.frames), n = static_cast<double>(sightings.size());
  std::printf("frames %d  cpu_ms %.2f  lines/frame %.1f  points/frame %.1f  identities %zu  share5 %.1f %%\n",
              static_cast<int>(s.frames), 1e3 * cpu_s / frames, sum / frames,
              static_cast<double>(s.points.tracked) / frames, sightings.size(),
              100.0 * static_cast<double>(long_ones) / n);
  std::printf("lines lost: view %ld edge %ld duplicate %ld undetected %ld jump %ld; flow failed %ld; detections %ld\n",
              long(s.lines.lost_view), long(s.lines.lost_edge), long(s.lines.lost_duplicate),
              long(s.lines.lost_undetected), long(s.lines.lost_jump), long(s.lines.flow_failed),
              long(s.lines.detections));
  std::printf("points lost: klt %ld backward %ld epipolar %ld drift %ld crowded %ld  median life %.0f  new %ld\n",
              long(s.points.lost_klt), long(s.points.lost_backward), long(s.points.lost_epipolar),
              long(s.points.lost_drift), long(s.points.lost_crowded), s.points.lifetimes.median(),
              long(s.points.detected));
  for (const auto& [name, times] : s.stages) std::printf("  %s %.2f", name.c_str(), times.sum() / frames);
  std::printf("  (wall ms a frame)\n");
}

void printTruth(const truth::IdentityCheck& check, bool list) {
  const auto ratios = check.sigmaRatios();
  std::printf("anchored %d  switched %d = %.2f %%  left %d = %.2f %%\n", check.anchored(), check.switched(),
              100.0 * check.switched() / std::max(1, check.anchored()), check.left(),
              100.0 * check.left() / std::max(1, check.anchored()));
  std::printf("sigma: %zu ends  error %.2f px  error/sigma typical %.2f  rms %.2f  beyond 3 sigma %.1f %%",
              ratios.count, ratios.error_px, ratios.typical, ratios.rms, 100 * ratios.beyond_3);
  std::printf("; within a track typical %.2f  rms %.2f\n", ratios.within_typical, ratios.within_rms);
  if (list) check.printSwitches(std::cout);
}

void setKey(const std::string& argument, FrontEndParams& params, RecordingParams& recording, bool& list) {
  const std::size_t equals = argument.find('=');
  const std::string key = argument.substr(0, equals), value = argument.substr(equals + 1);
  if (key == "mode")
    params.lines.mode = value;
  else if (key == "detector")
    params.lines.detector = value;
  else if (key == "lines")
    params.features = value == "1" ? "points_lines" : "points";
  else if (key == "to_s")
    recording.to_s = std::stod(value);
  else if (key == "switches")
    list = value == "1";
  else
    throw std::runtime_error("unknown key " + key);
}

int run(int argc, char** argv) {
  if (argc < 2)
    throw std::runtime_error(
        "usage: tracking_figures RECORDING [mode=flow|four_steps|descriptor] [detector=edge_drawing|lsd] [lines=0] "
        "[to_s=S] [switches=1]");
  const std::string path = argv[1];
  FrontEndParams params;
  RecordingParams recording_params;
  recording_params.frames_ahead = 0;
  bool list = false;
  for (int i = 2; i < argc; ++i) setKey(argv[i], params, recording_params, list);

  const auto recording = openRecording(path, recording_params);
  const truth::TruePoses poses(path);
  truth::PointErrors points(poses, recording->rig());
  std::unique_ptr<truth::TrueEdges> edges;
  std::unique_ptr<truth::IdentityCheck> check;
  if (std::filesystem::exists(path + "/mav0/lines0/visible.csv")) {
    edges = std::make_unique<truth::TrueEdges>(path, recording->rig(), poses);
    check = std::make_unique<truth::IdentityCheck>(*edges);
  }
  FrontEnd front_end(recording->rig(), params);
  std::map<TrackId, Sightings> sightings;
  double cpu_s = 0;
  for (int k = 0; auto step = recording->next(); ++k) {
    const double start = cpuSeconds();
    const FrameTracks tracks = front_end.process(step->frame, step->imu);
    cpu_s += cpuSeconds() - start;
    for (const LineObservation& line : tracks.lines) {
      ++sightings[line.id].frames;
      sightings[line.id].window_frames += k % 2 == 0;
    }
    points.add(tracks);
    if (check) check->add(tracks);
  }
  printSummary(front_end.statistics(), sightings, cpu_s);
  if (!poses.empty()) points.print();
  if (check) printTruth(*check, list);
  return 0;
}

}  // namespace
}  // namespace lintel

int main(int argc, char** argv) { return lintel::toolMain("tracking_figures", lintel::run, argc, argv); }
