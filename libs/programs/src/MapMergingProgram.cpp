// SPDX-License-Identifier: BSD-3-Clause
#include "MapMergingProgram.h"

#include <algorithm>
#include <filesystem>
#include <ostream>
#include <stdexcept>

#include "CommandLine.h"
#include "ProgramMain.h"
#include "StopSignals.h"
#include "lintel/core/AtomicFile.h"
#include "lintel/mapping/MapFile.h"
#include "lintel/pipeline/MapMerging.h"
#include "lintel/pipeline/Results.h"
#include "lintel/reporting/Progress.h"

namespace lintel {

namespace {

namespace fs = std::filesystem;

class MapMergingProgram {
 public:
  MapMergingProgram(std::ostream& out, std::ostream& err) : out_(out), err_(err) { addOptions(); }

  int run(int argc, const char* const* argv) {
    if (const auto exit_code = line_.parse(argc, argv, out_, err_)) return *exit_code;
    if (maps_.size() < 2) throw UsageError("merge takes two maps or more");
    refuseExisting(output_);
    for (std::size_t i = 0; i < maps_.size(); ++i) refuseExisting(trajectoryFile(i));
    MapMergingOptions options;
    if (!config_.empty()) readConfiguration(config_, options.configuration);
    for (const std::string& setting : settings_) setOption(setting, options.configuration);
    const StopSignals stop;
    LineMap map = namedMap(0);
    for (std::size_t i = 1; i < maps_.size(); ++i) map = merge(map, i, options, stop);
    for (std::size_t i = 0; i < map.recordings.size(); ++i) refuseExisting(trajectoryFile(i));
    writeMap(map, output_);
    writeTrajectories(map);
    return 0;
  }

 private:
  void addOptions() {
    line_.footer(
        "Examples:\n"
        "  lintel-map merge monday/map.lintel tuesday/map.lintel -o both.lintel   and both.1.tum, both.2.tum\n"
        "  lintel-map merge one.lintel two.lintel three.lintel -o all.lintel");
    line_.option("maps", maps_, "Native map files, as lintel-vio writes them; the frame is that of the first")
        .required()
        .type("MAP.lintel");
    line_
        .option("-o,--output", output_,
                "Map to write; beside it the trajectory of each recording, FILE.1.tum, FILE.2.tum and so on")
        .required()
        .type("FILE.lintel");
    line_
        .option("-c,--config", config_, "Configuration; `estimator.calibration`, `map`, `loops` and `refinement` count")
        .type("CONFIG.yaml");
    line_.option("--set", settings_, "Set one option, e.g. --set loops.min_points=20").type("KEY=VALUE").repeatable();
    line_.flag("-w,--overwrite", overwrite_, "Replace files that exist already");
    line_.flag("-q,--quiet", quiet_, "Print nothing");
  }

  /// A map that does not know the name of its recording is known by that of its file.
  LineMap namedMap(std::size_t i) const {
    LineMap map = readMap(maps_[i]);
    if (map.source.empty()) map.source = maps_[i];
    return map;
  }

  LineMap merge(const LineMap& map, std::size_t next, MapMergingOptions& options, const StopSignals& stop) {
    Progress searching(err_, progressStyleFor(err_, quiet_), "searching common places", "%", 100);
    Progress refining(err_, progressStyleFor(err_, quiet_), "adjusting both", "%", 100);
    options.searching = [&](double share) {
      searching.update(static_cast<std::size_t>(100 * share));
      return !stop.asked();
    };
    options.refining = [&](double share) {
      searching.clear();
      refining.update(static_cast<std::size_t>(100 * share));
      return share >= 1 || !stop.asked();
    };
    MapMerging merging = mergeMaps(map, namedMap(next), options);
    searching.clear();
    refining.clear();
    if (stop.asked()) throw Stopped("stopped by " + stop.name() + " before " + output_, stop.exitCode());
    if (!merging.refusal.empty())
      throw std::runtime_error(maps_[next - 1] + " and " + maps_[next] + ": " + merging.refusal +
                               "; merge maps of flights that see the same places from the same side");
    report(merging);
    return std::move(merging.map);
  }

  void report(const MapMerging& merging) const {
    if (quiet_) return;
    const auto common = std::count_if(merging.pairs.begin(), merging.pairs.end(),
                                      [](const PlacePair& pair) { return pair.refusal.empty(); });
    const auto apart = std::count_if(merging.map.pieces.begin(), merging.map.pieces.end(),
                                     [](const MapPiece& piece) { return piece.world != 0; });
    out_ << output_ << ": " << merging.map.recordings.size() << " recordings, " << common
         << " pairs of images show the same place, " << merging.refinement.joined << " points were seen in both; "
         << merging.map.lines.size() << " lines\n";
    if (apart > 0)
      out_ << "  " << apart << " pieces have no place in common with the others and keep their own frame\n";
  }

  std::string trajectoryFile(std::size_t recording) const {
    return fs::path(output_).replace_extension("." + std::to_string(recording + 1) + ".tum").string();
  }

  /// Before anything is written: nothing is left half done.
  void refuseExisting(const std::string& path) const {
    if (!overwrite_ && fs::exists(path))
      throw std::runtime_error(path + ": exists already; choose another name or add -w");
  }

  void writeTrajectories(const LineMap& map) const {
    for (std::size_t i = 0; i < map.recordings.size(); ++i) {
      std::vector<OdometryPose> poses;
      for (const auto& [t_ns, T_w_b] : trajectoryOf(map, static_cast<int>(i))) poses.push_back({t_ns, T_w_b});
      AtomicFile::writeWhole(trajectoryFile(i), trajectoryText(poses));
      if (!quiet_) out_ << trajectoryFile(i) << ": trajectory of " << map.recordings[i] << "\n";
    }
  }

  std::ostream& out_;
  std::ostream& err_;
  CommandLine line_{"lintel-map merge", "Merges maps of flights through the same place into one."};
  std::vector<std::string> maps_, settings_;
  std::string output_, config_;
  bool overwrite_ = false, quiet_ = false;
};

}  // namespace

int mergeFromCommandLine(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  return MapMergingProgram(out, err).run(argc, argv);
}

}  // namespace lintel
