// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/exporting/MapExport.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>

#include "Writers.h"
#include "lintel/core/AtomicFile.h"

namespace lintel {

namespace {

using Layers = std::set<MapLayer>;
const Layers kAll{MapLayer::kLines, MapLayer::kPoints, MapLayer::kKeyframes, MapLayer::kTrajectory};
const Layers kNoPoints{MapLayer::kLines, MapLayer::kKeyframes, MapLayer::kTrajectory};
const Layers kNoTrajectory{MapLayer::kLines, MapLayer::kPoints, MapLayer::kKeyframes};
const Layers kPointsAndKeyframes{MapLayer::kPoints, MapLayer::kKeyframes};
const Layers kOnlyTrajectory{MapLayer::kTrajectory};
const Layers kOnlyLines{MapLayer::kLines};

/// A form of export with the defaults under which its usual viewer shows lines.
struct Format {
  const char* extension;
  OutputFiles (*write)(const Drawing&, const std::string&);
  LineStyle style;
  Layers layers;
  bool data;  // for programs rather than for the eye: nothing is left out
  const char* viewer;
  bool of_keyframes = false;  // of no use without them and their camera, whatever its layers
  bool folder = false;        // of files with fixed names
};

const std::vector<Format>& formats() {
  static const std::vector<Format> all{
      {"glb", glbFiles, LineStyle::kLines, kAll, false,
       "f3d --point-size=2 --line-width=2 FILE or a browser's glTF viewer"},
      {"gltf", gltfFiles, LineStyle::kLines, kAll, false,
       "f3d --point-size=2 --line-width=2 FILE or a browser's glTF viewer"},
      {"obj", objFiles, LineStyle::kTubes, kOnlyLines, false, "meshlab FILE or Blender (import Wavefront)"},
      {"ply", plyFiles, LineStyle::kTubes, kOnlyLines, false, "meshlab FILE or CloudCompare"},
      {"3Dscene", sceneFiles, LineStyle::kLines, kAll, false, "SceneViewer3D FILE"},
      {"simplemap", simplemapFiles, LineStyle::kLines, kNoTrajectory, true,
       "MRPT's and MOLA's tools for view-based maps, e.g. observations2map", true},
      {"colmap", colmapFiles, LineStyle::kLines, kPointsAndKeyframes, true,
       "colmap gui --import_path FILE, and what reads COLMAP's models", true, true},
      {"colmaptxt", colmapTextFiles, LineStyle::kLines, kPointsAndKeyframes, true,
       "colmap gui --import_path FILE, and what reads COLMAP's models as text", true, true},
      {"tum", tumFiles, LineStyle::kLines, kOnlyTrajectory, true, "evaluation tools, e.g. evo_traj tum FILE"},
      {"kitti", kittiFiles, LineStyle::kLines, kOnlyTrajectory, true, "evaluation tools, e.g. evo_traj kitti FILE"},
      {"euroc", eurocFiles, LineStyle::kLines, kOnlyTrajectory, true, "evaluation tools, e.g. evo_traj euroc FILE"},
      {"dae", daeFiles, LineStyle::kLines, kNoPoints, false, "a Collada reader, e.g. f3d FILE"},
      {"x3d", x3dFiles, LineStyle::kLines, kNoPoints, false, "an X3D viewer or Blender (import X3D)"},
      {"csv", csvFiles, LineStyle::kLines, kOnlyLines, true, "any table program"},
      {"json", jsonFiles, LineStyle::kLines, kAll, true, "any program that reads JSON"},
      {"dxf", dxfFiles, LineStyle::kLines, kNoPoints, true, "LibreCAD, FreeCAD, AutoCAD or CloudCompare"},
      {"png", pngFiles, LineStyle::kLines, kNoPoints, false, "any picture viewer"},
      {"html", htmlFiles, LineStyle::kLines, kAll, false, "any browser; it needs no network"},
  };
  return all;
}

std::string lowerCase(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

const Format* findFormat(const std::string& extension) {
  for (const Format& format : formats()) {
    if (lowerCase(format.extension) == lowerCase(extension)) return &format;
  }
  return nullptr;
}

std::string listOfFormats() {
  std::string list;
  for (const Format& format : formats()) list += (list.empty() ? "" : " ") + std::string(format.extension);
  return list;
}

void check(const ExportParams& params) {
  if (!(params.radius_m >= 0) || std::isinf(params.radius_m))
    throw ExportError("the tubes' radius must be a length in metres");
  if (!(params.min_length_m >= 0)) throw ExportError("the least length of lines must be a length in metres");
  if (std::isnan(params.max_sigma_m)) throw ExportError("the greatest sigma of lines must be a length in metres");
}

/// The form of a file and what of it `params` leaves open. Throws ExportError.
const Format& formatFor(const std::string& path, ExportParams& params) {
  std::string extension = std::filesystem::path(path).extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  const Format* format = findFormat(extension);
  if (!format)
    throw ExportError("cannot write " + path + ": no export has the extension '" + extension + "'; take one of " +
                      listOfFormats());
  if (!params.style) params.style = format->style;
  if (!params.layers) params.layers = format->layers;
  return *format;
}

void makeFolder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directory(path, error);
  if (!std::filesystem::is_directory(path)) throw ExportError(path + ": cannot be made: choose another name");
}

/// All files or none: the ones beside first, as the main one refers to them.
void writeAll(const OutputFiles& files) {
  try {
    std::vector<std::unique_ptr<AtomicFile>> open;
    for (const OutputFile& file : files) {
      open.push_back(std::make_unique<AtomicFile>(file.path));
      open.back()->write(file.bytes);
      open.back()->flush();
    }
    for (auto file = open.rbegin(); file != open.rend(); ++file) (*file)->commit();
  } catch (const FileWriteError& error) {
    throw ExportError(error.what());
  }
}

}  // namespace

std::vector<std::string> exportFormats() {
  std::vector<std::string> extensions;
  for (const Format& format : formats()) extensions.emplace_back(format.extension);
  return extensions;
}

std::string viewerHint(const std::string& extension) {
  const Format* format = findFormat(extension);
  return format ? format->viewer : "";
}

std::string missingFor(const LineMap& map, const std::string& path, const ExportParams& params) {
  ExportParams complete = params;
  const Format& format = formatFor(path, complete);
  if (format.of_keyframes && map.keyframes.empty()) return "keyframes";
  if (format.of_keyframes) return map.rig.camera.fx > 0 && map.rig.camera.width > 0 ? "" : "calibrated camera";
  const auto has = [&](MapLayer layer) {
    return layer == MapLayer::kLines       ? !map.lines.empty()
           : layer == MapLayer::kPoints    ? !map.points.empty()
           : layer == MapLayer::kKeyframes ? !map.keyframes.empty()
                                           : !map.trajectory.empty();
  };
  const std::map<MapLayer, const char*> names{{MapLayer::kLines, "lines"},
                                              {MapLayer::kPoints, "points"},
                                              {MapLayer::kKeyframes, "keyframes"},
                                              {MapLayer::kTrajectory, "trajectory"}};
  std::string missing;
  for (const MapLayer layer : *complete.layers) {
    if (has(layer)) return "";
    const char* between = missing.empty() ? "" : layer == *complete.layers->rbegin() ? " and no " : ", no ";
    missing += between + std::string(names.at(layer));
  }
  return missing;
}

ExportSummary exportMap(const LineMap& map, const std::string& path, const ExportParams& params) {
  check(params);
  ExportParams complete = params;
  const Format& format = formatFor(path, complete);
  const Drawing drawing = makeDrawing(map, complete, format.data);
  const OutputFiles files = format.write(drawing, path);
  if (format.folder) makeFolder(path);
  writeAll(files);
  ExportSummary summary = drawing.summary;
  if (format.folder) summary.files.push_back(path);
  for (const OutputFile& file : files) summary.files.push_back(file.path);
  return summary;
}

}  // namespace lintel
