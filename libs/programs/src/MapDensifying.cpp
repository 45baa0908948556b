// SPDX-License-Identifier: BSD-3-Clause
#include "MapDensifying.h"

#include <filesystem>
#include <optional>
#include <ostream>
#include <stdexcept>

#include "CommandLine.h"
#include "ProgramMain.h"
#include "RecordingOptions.h"
#include "StopSignals.h"
#include "lintel/core/Formatted.h"
#include "lintel/evaluation/TrajectoryFile.h"
#include "lintel/mapping/MapFile.h"
#include "lintel/pipeline/MapDensification.h"
#include "lintel/reporting/Progress.h"

namespace lintel {

namespace {

class MapDensifying {
 public:
  MapDensifying(std::ostream& out, std::ostream& err) : out_(out), err_(err) { addOptions(); }

  int run(int argc, const char* const* argv) {
    if (const auto exit_code = line_.parse(argc, argv, out_, err_)) return *exit_code;
    if (!overwrite_ && std::filesystem::exists(output_))
      throw std::runtime_error(output_ + ": exists already; choose another name or add -w");
    MapDensificationOptions options;
    if (!config_.empty()) readConfiguration(config_, options.configuration);
    for (const std::string& setting : settings_) setOption(setting, options.configuration);
    options.threads = threads_;
    const LineMap map = readMap(map_);
    if (!poses_.empty()) options.poses = readTrajectory(poses_);
    const auto recording = openRecording(input_, recording_params_);
    const StopSignals stop;
    const MapDensification result = search(map, *recording, options, stop);
    if (stop.asked()) throw Stopped("stopped by " + stop.name() + " before " + output_, stop.exitCode());
    checkImages(map, result);
    if (result.map.lines.empty())
      throw std::runtime_error(map_ + ": no line is known from its observations, and none was found in " +
                               std::to_string(result.report.images) + " images of " + input_ + ": nothing is written");
    writeMap(result.map, output_);
    report(map, result);
    return 0;
  }

 private:
  void addOptions() {
    line_.footer(
        "Examples:\n"
        "  lintel-map densify out/map.lintel flight.bag -o whole.lintel\n"
        "  lintel-map densify out/map.lintel flight.bag -o whole.lintel --poses better.tum   with poses of another "
        "system\n"
        "  lintel-map densify out/map.lintel flight.bag -o faint.lintel --set "
        "densification.segments.gradient_threshold=6");
    line_.option("map", map_, "The native map file, as lintel-vio writes it").required().type("MAP.lintel");
    line_.option("recording", input_, "The recording of the map").required().type("INPUT");
    line_.option("-o,--output", output_, "Map to write").required().type("FILE.lintel");
    line_
        .option(
            "--poses", poses_,
            "Poses of the IMU when the images were taken, under their stamps (TUM or EuRoC state CSV), in the place of "
            "the map's: points and lines are estimated anew with them")
        .type("FILE");
    line_.option("-c,--config", config_, "Configuration; `map` and `densification` count").type("CONFIG.yaml");
    line_.option("--set", settings_, "Set one option, e.g. --set densification.views=40")
        .type("KEY=VALUE")
        .repeatable();
    line_.option("--threads", threads_, "Threads; the result is the same").range(1, 64).showDefault();
    addRecordingOptions(line_, recording_params_);
    line_.flag("-w,--overwrite", overwrite_, "Replace a file that exists already");
    line_.flag("-q,--quiet", quiet_, "Print nothing");
  }

  MapDensification search(const LineMap& map, Recording& recording, MapDensificationOptions& options,
                          const StopSignals& stop) {
    Progress reading(err_, progressStyleFor(err_, quiet_), "reading images", "frames", recording.expectedFrames());
    std::optional<Progress> searching;
    options.cancelled = [&stop] { return stop.asked(); };
    options.reading = [&](std::size_t frames, std::size_t) { reading.update(frames); };
    options.searching = [&](double share) {
      if (!searching) {
        reading.clear();
        searching.emplace(err_, progressStyleFor(err_, quiet_), "searching lines", "%", 100);
      }
      searching->update(static_cast<std::size_t>(100 * share));
      return true;
    };
    try {
      MapDensification result = densifyMap(map, recording, options);
      reading.clear();
      if (searching) searching->clear();
      if (!result.refusal.empty()) throw std::runtime_error(map_ + ": " + result.refusal);
      return result;
    } catch (const PosesError& error) {
      throw std::runtime_error(poses_ + ": " + error.what());
    }
  }

  void checkImages(const LineMap& map, const MapDensification& result) const {
    if (result.report.images == 0)
      throw std::runtime_error(input_ + ": has no image at the time of a keyframe: give the recording of this map");
    if (result.keyframes_without_image > 0)
      err_ << "lintel-map: warning: " << input_ << " has no image for " << result.keyframes_without_image
           << " keyframes of the map\n";
    if (result.keyframes_without_pose > 0)
      err_ << "lintel-map: warning: " << poses_ << " has no pose for " << result.keyframes_without_pose << " of "
           << map.keyframes.size() << " keyframes: these are left out\n";
  }

  void report(const LineMap& before, const MapDensification& result) const {
    if (quiet_) return;
    const auto length = [](const LineMap& map) {
      double sum_m = 0;
      for (const MapLine& line : map.lines) sum_m += line.segment_w.length();
      return sum_m;
    };
    const std::string text =
        formatted("%zu lines of %.0f m, before %zu of %.0f m; %zu images searched\n", result.map.lines.size(),
                  length(result.map), before.lines.size(), length(before), result.report.images);
    out_ << output_ << ": " << text << "  open it with lintel-map " << output_ << " -o map.glb\n";
  }

  std::ostream& out_;
  std::ostream& err_;
  CommandLine line_{"lintel-map densify", "Searches the images of a map's keyframes for lines that it does not have."};
  RecordingParams recording_params_;
  std::string map_, input_, output_, poses_, config_;
  std::vector<std::string> settings_;
  int threads_ = 2;
  bool overwrite_ = false, quiet_ = false;
};

}  // namespace

int densifyFromCommandLine(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  return MapDensifying(out, err).run(argc, argv);
}

}  // namespace lintel
