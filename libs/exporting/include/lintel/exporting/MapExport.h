// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "lintel/mapping/LineMap.h"

namespace lintel {

/// A map cannot be exported: one line naming the file, what is wrong and the remedy.
class ExportError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class LineStyle { kLines, kTubes };                         ///< one pixel wide, or four-sided tubes of triangles
enum class LineColour { kKind, kGroup, kUncertainty, kHeight };  ///< what a line's colour means
enum class MapLayer { kLines, kPoints, kKeyframes, kTrajectory };

/// How a map is exported. What is left empty is chosen for the file's form, such that its usual viewer shows lines.
struct ExportParams {
  std::optional<LineStyle> style;
  double radius_m = 0;  ///< of tubes; 0 = by the map's extent
  LineColour colour = LineColour::kKind;
  int min_observations = 0;  ///< lines and points seen in fewer keyframes are left out
  double min_length_m = 0;   ///< shorter lines are left out
  double max_sigma_m = std::numeric_limits<double>::infinity();  ///< lines, points less certain across are left out
  std::optional<std::set<MapLayer>> layers;
};

/// What an export holds.
struct ExportSummary {
  std::size_t lines = 0, points = 0, keyframes = 0, trajectory = 0;
  std::size_t filtered = 0;        ///< lines left out by min_observations, min_length_m, max_sigma_m
  std::size_t dropped = 0;         ///< lines, points, poses left out as they are not finite or too short to be drawn
  std::size_t far_points = 0;      ///< points left out of a drawing as they are far from all lines
  std::vector<std::string> files;  ///< written; the first is the one to open
};

/// File name extensions that exportMap accepts, without the dot.
std::vector<std::string> exportFormats();

/// How a file of this extension is looked at, one line without a stop ("" for an unknown one).
std::string viewerHint(const std::string& extension);

/// What a map would need for an export to `path` that is of use, in words ("keyframes"); "" if it has it. Filters do
/// not count.
std::string missingFor(const LineMap& map, const std::string& path, const ExportParams& params = {});

/// Writes `map` to `path` in the form that its extension names (case does not matter). Each file appears whole or not
/// at all; the same map and parameters give the same bytes. World coordinates [m], z up; forms defined y-up
/// (glb, gltf, dae, x3d) carry them below one node that turns them upright. Throws ExportError.
ExportSummary exportMap(const LineMap& map, const std::string& path, const ExportParams& params = {});

}  // namespace lintel
