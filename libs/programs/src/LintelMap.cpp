// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/programs/LintelMap.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "CommandLine.h"
#include "MapDensifying.h"
#include "MapMergingProgram.h"
#include "ProgramMain.h"
#include "RecordingOptions.h"
#include "StopSignals.h"
#include "lintel/exporting/ColmapImages.h"
#include "lintel/exporting/MapExport.h"
#include "lintel/exporting/Undistortion.h"
#include "lintel/mapping/MapFile.h"
#include "lintel/sensing/Recording.h"

namespace lintel {

namespace {

const std::map<std::string, LineStyle> kStyles{{"lines", LineStyle::kLines}, {"tubes", LineStyle::kTubes}};
const std::map<std::string, LineColour> kColours{{"kind", LineColour::kKind},
                                                 {"group", LineColour::kGroup},
                                                 {"uncertainty", LineColour::kUncertainty},
                                                 {"height", LineColour::kHeight}};
const std::map<std::string, MapLayer> kLayers{{"lines", MapLayer::kLines},
                                              {"points", MapLayer::kPoints},
                                              {"keyframes", MapLayer::kKeyframes},
                                              {"trajectory", MapLayer::kTrajectory}};

template <class Value>
std::vector<std::string> namesOf(const std::map<std::string, Value>& values) {
  std::vector<std::string> names;
  names.reserve(values.size());
  for (const auto& entry : values) names.push_back(entry.first);
  return names;
}

std::string extensionOf(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension.empty() ? extension : extension.substr(1);
}

class LintelMap {
 public:
  static constexpr const char* kName = "lintel-map";

  LintelMap(std::ostream& out, std::ostream& err) : out_(out), err_(err) { addOptions(); }

  int run(int argc, const char* const* argv) {
    if (const auto exit_code = line_.parse(argc, argv, out_, err_)) return *exit_code;
    for (const std::string& output : outputs_) {
      if (!viewerHint(extensionOf(output)).empty()) continue;
      throw UsageError("no form of export has the extension of " + output + "; take one of " + formats());
    }
    if (images_.empty() != images_of_.empty())
      throw UsageError("--images DIR and --recording INPUT belong together; give both");
    checkOutputs();
    const ExportParams params = exportParams();
    const LineMap read = readMap(input_), map = undistorted_ ? undistorted(read) : read;
    checkNotEmpty(read, params);
    const StopSignals stop;
    for (const std::string& output : outputs_) {
      checkNotStopped(stop, output);
      report(exportMap(map, output, params));
    }
    if (!images_of_.empty()) writeImages(read, stop);
    return 0;
  }

 private:
  static std::string formats() {
    std::string list;
    for (const std::string& extension : exportFormats()) list += (list.empty() ? "" : " ") + extension;
    return list;
  }

  static std::string examples() {
    return "Examples:\n"
           "  lintel-map map.lintel -o map.glb                       for f3d, Blender, browsers\n"
           "  lintel-map map.lintel -o map.ply                       tubes, as MeshLab shows no lines\n"
           "  lintel-map map.lintel -o map.png --colour height       a picture: above, first camera, side\n"
           "  lintel-map map.lintel -o map.csv --min-observations 5  a table of the well-seen lines\n"
           "  lintel-map map.lintel -o map.colmap --images images --recording flight.bag   for COLMAP\n"
           "  lintel-map map.lintel -o map.colmap --images images --recording flight.bag --undistorted   for "
           "splatting\n"
           "  lintel-map map.lintel -o map.obj --layers lines,trajectory --radius 0.01\n"
           "lintel-map densify MAP.lintel INPUT -o FILE.lintel searches the images for more lines: see lintel-map "
           "densify --help\n"
           "lintel-map merge A.lintel B.lintel -o C.lintel makes one map of several flights: see lintel-map merge "
           "--help";
  }

  void checkOutputs() const {
    if (overwrite_) return;
    for (const std::string& output : outputs_)
      if (std::filesystem::is_regular_file(output) || std::filesystem::is_directory(output))
        throw std::runtime_error(output + ": exists already; choose another name or add -w");
  }

  /// Before anything is written: an empty file would be taken for a map.
  void checkNotEmpty(const LineMap& map, const ExportParams& params) const {
    if (!images_.empty() && map.keyframes.empty())
      throw std::runtime_error(input_ + ": holds no keyframes, whose images would be written to " + images_ +
                               ": take a map of lintel-vio");
    for (const std::string& output : outputs_)
      if (const std::string missing = missingFor(map, output, params); !missing.empty())
        throw std::runtime_error(std::string(input_)
                                     .append(": holds no ")
                                     .append(missing)
                                     .append(", so ")
                                     .append(output)
                                     .append(" would be of no use: choose another form or --layers"));
  }

  void addOptions() {
    line_.footer(examples());
    line_.option("map", input_, "The native map file, as lintel-vio writes it").required().type("MAP.lintel");
    line_
        .option("-o,--output", outputs_,
                "File to write (several -o give several); its extension chooses the form: " + formats())
        .required()
        .type("FILE.EXT")
        .repeatable();
    line_.option("--as", style_, "Draw lines as strokes or as tubes; default by the form: tubes for obj and ply")
        .oneOf(namesOf(kStyles));
    line_.option("--radius", params_.radius_m, "Radius of tubes [m]; default by the map's extent").positive();
    line_.option("--colour,--color", colour_, "What a line's colour says").oneOf(namesOf(kColours)).showDefault();
    line_.option("--min-observations", params_.min_observations, "Leave out lines and points seen in fewer keyframes")
        .notNegative();
    line_.option("--min-length", params_.min_length_m, "Leave out shorter lines [m]").notNegative();
    line_
        .option("--max-sigma", params_.max_sigma_m,
                "Leave out lines and points with a greater standard deviation of position [m]")
        .notNegative();
    line_
        .option("--layers", layers_,
                "What to show, with commas between: lines,points,keyframes,trajectory; default by the form")
        .separatedBy(',')
        .oneWord()
        .oneOf(namesOf(kLayers))
        .type("LAYERS");
    line_.option("--images", images_, "Write the images of the keyframes to this folder, under COLMAP's names")
        .type("DIR");
    line_.option("--recording", images_of_, "With --images: the recording of the map").type("INPUT");
    line_.flag("--undistorted", undistorted_,
               "As a pinhole camera without distortion would have seen it: camera, observations, images");
    addRecordingOptions(line_, recording_params_);
    line_.flag("-w,--overwrite", overwrite_, "Replace files that exist already");
    line_.flag("-q,--quiet", quiet_, "Print nothing");
  }

  /// A file that is begun is finished: it takes seconds at most.
  static void checkNotStopped(const StopSignals& stop, const std::string& next) {
    if (stop.asked()) throw Stopped("stopped by " + stop.name() + " before " + next, stop.exitCode());
  }

  void writeImages(const LineMap& map, const StopSignals& stop) {
    const auto recording = openRecording(images_of_, recording_params_);
    const auto next = [&]() -> std::optional<Frame> {
      checkNotStopped(stop, "the last images");
      auto step = recording->next();
      if (!step) return std::nullopt;
      return step->frame;
    };
    std::function<GrayImage(const GrayImage&)> prepare;
    if (undistorted_) prepare = ImageUndistorter(map.rig.camera, pinholeOf(map.rig.camera));
    const std::size_t written = writeColmapImages(map, images_, next, prepare);
    if (written < map.keyframes.size())
      throw std::runtime_error(images_of_ + ": has images of " + std::to_string(written) + " of " +
                               std::to_string(map.keyframes.size()) + " keyframes: give the recording of this map");
    if (!quiet_) out_ << images_ << ": " << written << " images of keyframes\n";
  }

  ExportParams exportParams() const {
    ExportParams params = params_;
    if (!style_.empty()) params.style = kStyles.at(style_);
    params.colour = kColours.at(colour_);
    if (!layers_.empty()) params.layers.emplace();
    for (const std::string& layer : layers_) params.layers->insert(kLayers.at(layer));
    return params;
  }

  void report(const ExportSummary& summary) {
    if (summary.dropped > 0) {
      err_ << kName << ": " << summary.files.front() << ": left out " << summary.dropped
           << " lines, points or poses without finite numbers or length\n";
    }
    if (quiet_) return;
    const std::string& file = summary.files.front();
    out_ << file << ": " << summary.lines << " lines";
    if (summary.points > 0) out_ << ", " << summary.points << " points";
    if (summary.far_points > 0) out_ << " (and " << summary.far_points << " far off that are not drawn)";
    if (summary.keyframes > 0) out_ << ", " << summary.keyframes << " keyframes";
    if (summary.trajectory > 0) out_ << ", " << summary.trajectory << " poses";
    if (summary.filtered > 0) out_ << "; " << summary.filtered << " lines left out by the filters";
    std::string hint = viewerHint(extensionOf(file));
    const std::size_t place = hint.find("FILE");
    if (place != std::string::npos) hint.replace(place, 4, file);
    out_ << "\n  open it with " << hint << "\n";
  }

  std::ostream& out_;
  std::ostream& err_;
  CommandLine line_{kName, "Writes a line map in a form that other programs open."};
  RecordingParams recording_params_;
  std::string input_, images_, images_of_, style_, colour_ = "kind";
  std::vector<std::string> outputs_, layers_;
  ExportParams params_;
  bool overwrite_ = false, quiet_ = false, undistorted_ = false;
};

}  // namespace

int runLintelMap(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  return programMain(LintelMap::kName, err, [&] {
    if (argc > 1 && std::string(argv[1]) == "densify") return densifyFromCommandLine(argc - 1, argv + 1, out, err);
    if (argc > 1 && std::string(argv[1]) == "merge") return mergeFromCommandLine(argc - 1, argv + 1, out, err);
    return LintelMap(out, err).run(argc, argv);
  });
}

}  // namespace lintel
