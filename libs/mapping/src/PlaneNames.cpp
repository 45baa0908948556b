// SPDX-License-Identifier: BSD-3-Clause
#include "PlaneNames.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <unordered_map>

namespace lintel {

namespace {

constexpr double kUpright = 0.0524;                        // sine of 3 degrees
constexpr double kSameWall_m = 0.03;                       // between a wall and another piece of it
constexpr double kBehind_m = 0.1;                          // the plane: what is less far is in it
constexpr double kMostBehind = 0.02;                       // share of the map that may be behind a wall, by mistake
constexpr double kLeastWidth_m = 2, kLeastHeight_m = 1.5;  // of floors and walls

/// Everything that the map shows, as places.
std::vector<Eigen::Vector3d> placesOf(const LineMap& map) {
  std::vector<Eigen::Vector3d> places;
  for (const MapLine& line : map.lines) places.insert(places.end(), {line.segment_w.start, line.segment_w.end});
  for (const MapPoint& point : map.points) places.push_back(point.p_w);
  return places;
}

bool nothingIsBehind(const std::vector<Eigen::Vector3d>& places, const MapPlane& plane) {
  const auto behind = std::count_if(places.begin(), places.end(), [&](const Eigen::Vector3d& p) {
    return plane.normal_w.dot(p) - plane.offset_m < -kBehind_m;
  });
  return static_cast<double>(behind) <= kMostBehind * static_cast<double>(places.size());
}

/// How large it is along two directions in it.
Eigen::Vector2d extentOf(const std::vector<Segment3>& lines, const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
  Eigen::Array2d low = Eigen::Array2d::Constant(1e300), high = -low;
  for (const Segment3& line : lines)
    for (const Eigen::Vector3d& p : {line.start, line.end}) {
      const Eigen::Array2d at(u.dot(p), v.dot(p));
      low = low.min(at), high = high.max(at);
    }
  return (high - low).matrix();
}

/// Whether all that a plane has is in another one as well: both are pieces of the same wall.
bool isPieceOf(const std::vector<Segment3>& lines, const MapPlane& whole) {
  return std::all_of(lines.begin(), lines.end(), [&](const Segment3& line) {
    return std::abs(whole.normal_w.dot(line.start) - whole.offset_m) <= kSameWall_m &&
           std::abs(whole.normal_w.dot(line.end) - whole.offset_m) <= kSameWall_m;
  });
}

void addIds(const std::vector<std::uint64_t>& more, std::vector<std::uint64_t>& ids) {
  ids.insert(ids.end(), more.begin(), more.end());
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

bool isLarge(const std::vector<Segment3>& lines, const MapPlane& plane, bool horizontal) {
  if (horizontal)
    return extentOf(lines, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()).minCoeff() >= kLeastWidth_m;
  const Eigen::Vector3d level = Eigen::Vector3d::UnitZ().cross(plane.normal_w).normalized();
  const Eigen::Vector2d extent = extentOf(lines, level, Eigen::Vector3d::UnitZ());
  return extent.x() >= kLeastWidth_m && extent.y() >= kLeastHeight_m;
}

}  // namespace

void namePlanes(const LineMap& map, std::vector<MapPlane>& planes) {
  Eigen::Vector3d cameras = Eigen::Vector3d::Zero();
  for (const MapKeyframe& keyframe : map.keyframes)
    cameras += keyframe.T_w_b.p / static_cast<double>(map.keyframes.size());
  const std::vector<Eigen::Vector3d> places = placesOf(map);
  std::unordered_map<std::uint64_t, std::size_t> line_of;
  for (std::size_t i = 0; i < map.lines.size(); ++i) line_of.emplace(map.lines[i].id, i);
  std::map<std::string, int> numbers;
  std::vector<MapPlane> named;
  for (MapPlane& plane : planes) {
    if (plane.normal_w.dot(cameras) < plane.offset_m)
      plane.normal_w = -plane.normal_w, plane.offset_m = -plane.offset_m;
    const double up = plane.normal_w.z();
    const bool horizontal = std::abs(up) > std::sqrt(1 - kUpright * kUpright), vertical = std::abs(up) < kUpright;
    std::string kind = horizontal ? "horizontal" : vertical ? "vertical" : "slanted";
    std::vector<Segment3> lines;
    for (const std::uint64_t id : plane.lines) lines.push_back(map.lines[line_of.at(id)].segment_w);
    if ((horizontal || vertical) && isLarge(lines, plane, horizontal) && nothingIsBehind(places, plane)) {
      kind = vertical ? "wall" : up > 0 ? "floor" : "ceiling";
      const auto whole = std::find_if(named.begin(), named.end(), [&](const MapPlane& other) {
        return other.name.compare(0, kind.size(), kind) == 0 && isPieceOf(lines, other);
      });
      if (whole != named.end()) {
        addIds(plane.lines, whole->lines), addIds(plane.points, whole->points);
        continue;
      }
    }
    const int number = ++numbers[kind];
    const bool only = (kind == "floor" || kind == "ceiling") && number == 1;
    plane.name = only ? kind : kind + " " + std::to_string(number);
    named.push_back(std::move(plane));
  }
  planes = std::move(named);
}

}  // namespace lintel
