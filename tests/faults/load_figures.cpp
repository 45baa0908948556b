// SPDX-License-Identifier: BSD-3-Clause
// load_figures RECORDING [refine]: memory and CPU time of a long recording, a line of JSON for every minute of it
// (long_run).
#include <malloc.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "../ToolMain.h"
#include "lintel/mapping/MapMaterial.h"
#include "lintel/pipeline/Odometry.h"
#include "lintel/pipeline/RunStatistics.h"
#include "lintel/sensing/Recording.h"

namespace lintel {
namespace {

struct Minute {
  double resident_mb = 0, map_mb = 0;
  std::size_t frames = 0;
};

double residentMb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmRSS:", 0) == 0) return std::stod(line.substr(6)) / 1024;
  return 0;
}

/// What the allocator takes for a block of so many bytes.
std::size_t blockBytes(std::size_t bytes) {
  void* block = std::malloc(bytes);
  const std::size_t taken = bytes == 0 ? 0 : malloc_usable_size(block);
  std::free(block);
  return taken;
}

/// What the map keeps of what leaves the window with this frame (MapBuilder), in bytes of the allocator's blocks,
/// without what its vectors of keyframes, points and lines have in reserve.
std::size_t mapBytes(const WindowUpdate& update) {
  std::size_t bytes = update.hasPose() ? sizeof(std::pair<std::int64_t, Pose>) + sizeof(OdometryPose) : 0;
  for (const RetiredKeyframe& keyframe : update.keyframes) {
    bytes += sizeof keyframe;
    if (keyframe.imu)
      bytes += blockBytes(sizeof *keyframe.imu + 2 * sizeof(void*)) +  // with its shared counts
               blockBytes(keyframe.imu->samples().capacity() * sizeof(ImuSample));
  }
  for (const RetiredPoint& point : update.points)
    bytes += sizeof(PointRecord) + blockBytes(point.sightings.size() * sizeof(PointView));
  for (const RetiredLine& line : update.lines)
    bytes += sizeof(LineRecord) + blockBytes(line.sightings.size() * sizeof(LineView));
  return bytes;
}

double medianMs(const OdometryStatistics& s, std::size_t from, std::size_t to) {
  std::vector<double> ms;
  for (std::size_t i = from; i < to; ++i) ms.push_back(s.decoding.ms()[i] + s.tracking.ms()[i] + s.estimation.ms()[i]);
  if (ms.empty()) return 0;
  std::nth_element(ms.begin(), ms.begin() + static_cast<std::ptrdiff_t>(ms.size() / 2), ms.end());
  return ms[ms.size() / 2];
}

void run(const std::string& path, bool refine) {
  auto recording = openRecording(path, {});
  Configuration configuration;
  configuration.refinement.enabled = refine;
  std::vector<Minute> minutes;
  std::int64_t first_ns = 0;
  std::size_t map_bytes = 0;
  RunOptions options;
  options.observer = [&](const Frame& frame, const FrameTracks&, const WindowUpdate& update, std::size_t done) {
    map_bytes += mapBytes(update);
    if (done == 1) first_ns = frame.t_ns;
    const auto minute = static_cast<std::size_t>((frame.t_ns - first_ns) / 60000000000);
    if (minute >= minutes.size()) {
      if (!minutes.empty())
        std::fprintf(stderr, "minute %zu: %.1f MB, map %.1f MB\n", minute, minutes.back().resident_mb,
                     minutes.back().map_mb);
      minutes.resize(minute + 1);
    }
    Minute& now = minutes[minute];
    now.frames = done;
    now.map_mb = static_cast<double>(map_bytes) / (1 << 20);
    if (done % 20 != 0) return;
    now.resident_mb = std::max(now.resident_mb, residentMb());
  };
  const OdometryResult result = runOdometry(*recording, configuration, options);
  std::size_t from = 0;
  for (std::size_t i = 0; i < minutes.size(); ++i) {
    const Minute& m = minutes[i];
    std::printf("{\"minute\": %zu, \"frames\": %zu, \"resident_mb\": %.1f, \"map_mb\": %.1f, \"median_ms\": %.3f}\n",
                i + 1, m.frames - from, m.resident_mb, m.map_mb, medianMs(result.statistics, from, m.frames));
    from = m.frames;
  }
  std::printf(
      "{\"poses\": %zu, \"keyframes\": %zu, \"resets\": %zu, \"points\": %zu, \"lines\": %zu, \"peak_mb\": %.1f, "
      "\"refinement_s\": %.1f, \"loops_s\": %.1f, \"error\": \"%s\"}\n",
      result.trajectory.size(), result.statistics.keyframes, result.statistics.resets, result.map.points.size(),
      result.map.lines.size(), peakMemoryMb(), 1e-3 * result.statistics.refinement.sumMs(),
      1e-3 * result.statistics.loops.sumMs(), result.error.c_str());
}

int runTool(int argc, char** argv) {
  if (argc < 2) throw std::runtime_error("usage: load_figures RECORDING [refine]");
  run(argv[1], argc > 2 && std::string(argv[2]) == "refine");
  return 0;
}

}  // namespace
}  // namespace lintel

int main(int argc, char** argv) { return lintel::toolMain("load_figures", lintel::runTool, argc, argv); }
