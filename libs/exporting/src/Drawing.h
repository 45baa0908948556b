// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "Colours.h"
#include "DrawnStructure.h"
#include "lintel/exporting/MapExport.h"

namespace lintel {

struct DrawnSegment {
  Eigen::Vector3d start, end;  ///< world [m]; finite, and different as floats too
  Rgb colour;
  const MapLine* line = nullptr;  ///< none for a keyframe's or the trajectory's strokes
};

struct DrawnPoint {
  Eigen::Vector3d p;  ///< world [m], finite
  Rgb colour;
  const MapPoint* point = nullptr;
};

/// A named part of a drawing: segments or points.
struct DrawnPart {
  std::string
      name;  ///< "Lines vertical", "Lines no group", "Points", "Keyframes", "Trajectory": the same in every form
  MapLayer layer = MapLayer::kLines;
  int group = -1;  ///< of lines
  std::vector<DrawnSegment> segments;
  std::vector<DrawnPoint> points;
};

/// A map made ready to be drawn: selected, coloured, finite. Refers to the map, which must outlive it.
struct Drawing {
  const LineMap* map = nullptr;
  std::vector<DrawnPart> parts;        ///< lines by ascending group, then points, keyframes, trajectory; no empty ones
  std::vector<MapKeyframe> keyframes;  ///< drawn ones, with the poses at which their images were taken, without IMU
  std::vector<const MapLine*> lines;   ///< drawn ones, ascending id
  DrawnStructure structure;
  LineStyle style = LineStyle::kLines;
  LineColour colour = LineColour::kKind;
  double radius_m = 0.01;                           ///< of lines' tubes
  double frustum_m = 0.2;                           ///< depth of a keyframe's frustum
  Eigen::AlignedBox3d core;                         ///< of the 2 to 98 % of what is drawn; never empty
  std::vector<std::pair<std::string, Rgb>> legend;  ///< what the lines' colours mean
  ExportSummary summary;                            ///< without files

  /// Of a stroke's tube: keyframes and the trajectory are thinner, so that they do not hide the lines.
  double radiusOf(const DrawnSegment& s) const { return s.line ? radius_m : 0.3 * radius_m; }
};

/// Whether a pose is one: a rotation, and a place that viewers can count with.
bool drawable(const Pose& T);

/// Strokes of a camera's frustum of the given depth, in the world: kFrustumStrokes, the first from the eye; none if not
/// finite.
constexpr std::size_t kFrustumStrokes = 8;
std::vector<DrawnSegment> frustumSegments(const Rig& rig, const Pose& T_w_b, double depth_m, Rgb colour);

/// `params` must have style and layers set. Without `far_points` those far from the lines are left out and counted.
Drawing makeDrawing(const LineMap& map, const ExportParams& params, bool far_points);

}  // namespace lintel
