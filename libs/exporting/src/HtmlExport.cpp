// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "ViewerPage.h"
#include "Writers.h"
#include "lintel/core/Base64.h"
#include "lintel/core/Formatted.h"
#include "lintel/core/TextFile.h"

// One page that needs no network: page/viewer.html with three.js and the map put into it.
namespace lintel {

namespace {

using Json = nlohmann::ordered_json;

std::string library(const std::string& name) {
  const std::string path = std::string(kThreeFolder) + "/" + name;
  std::string text = bytesOfFile(path);
  if (text.empty())
    throw ExportError("the html export needs three.js: " + path + " is not there; install the package libjs-three");
  return text;
}

/// Little-endian floats, base64.
class Floats {
 public:
  void add(double v) {
    const auto single = static_cast<float>(v);
    std::uint32_t bits;
    std::memcpy(&bits, &single, 4);
    for (int i = 0; i < 4; ++i) bytes_.push_back(static_cast<char>(bits >> (8 * i)));
  }
  void add(const Eigen::Vector3d& v) { add(v.x()), add(v.y()), add(v.z()); }
  std::string text() const { return base64(bytes_); }

 private:
  std::string bytes_;
};

std::string cssColour(Rgb c) { return formatted("#%02x%02x%02x", c.r, c.g, c.b); }

/// A number of the page's pop-up, rounded for reading; null if not finite.
Json rounded(double v) {
  if (!std::isfinite(v)) return nullptr;
  return std::strtod(formatted("%.4g", v).c_str(), nullptr);
}

double secondsSince(std::int64_t t_ns, std::int64_t origin_ns) {
  return std::round(static_cast<double>(t_ns - origin_ns) * 1e-7) / 100;
}

Json linesData(const Drawing& drawing, std::int64_t origin_ns) {
  Floats ends;
  Json data;
  for (const char* column : {"id", "length", "observations", "first_s", "last_s", "sigma_direction_deg",
                             "sigma_distance_m", "group", "degenerate", "constrained", "mapped"}) {
    data[column] = Json::array();
  }
  for (const MapLine* line : drawing.lines) {
    ends.add(line->segment_w.start), ends.add(line->segment_w.end);
    data["id"].push_back(line->id), data["length"].push_back(rounded(line->segment_w.length()));
    data["observations"].push_back(line->observations.size());
    data["first_s"].push_back(secondsSince(line->first_t_ns, origin_ns)),
        data["last_s"].push_back(secondsSince(line->last_t_ns, origin_ns));
    data["sigma_direction_deg"].push_back(rounded(line->sigma_direction_rad * 180 / M_PI));
    data["sigma_distance_m"].push_back(rounded(line->sigma_distance_m));
    data["group"].push_back(line->group), data["degenerate"].push_back(line->degenerate ? 1 : 0),
        data["constrained"].push_back(line->constrained ? 1 : 0), data["mapped"].push_back(line->mapped ? 1 : 0);
  }
  data["ends"] = ends.text();
  return data;
}

/// Corners, and planes with the places of their lines among those drawn.
void addStructure(const Drawing& drawing, Json& data) {
  Floats corners;
  for (const MapCorner& corner : drawing.structure.corners) corners.add(corner.p_w);
  data["corners"] = corners.text();
  std::unordered_map<std::uint64_t, std::size_t> place;
  for (std::size_t i = 0; i < drawing.lines.size(); ++i) place.emplace(drawing.lines[i]->id, i);
  data["planes"] = Json::array();
  for (const MapPlane& plane : drawing.structure.planes) {
    Json lines = Json::array();
    for (const std::uint64_t id : plane.lines) lines.push_back(place.at(id));
    data["planes"].push_back({{"name", plane.name}, {"lines", lines}});
  }
}

Json coloursData(const Drawing& drawing) {
  Json data;
  const std::pair<const char*, LineColour> modes[] = {{"kind", LineColour::kKind},
                                                      {"group", LineColour::kGroup},
                                                      {"uncertainty", LineColour::kUncertainty},
                                                      {"height", LineColour::kHeight}};
  const GroupNames names(*drawing.map);
  for (const auto& [name, mode] : modes) {
    if (mode == drawing.colour) data["colour"] = name;
    const LineColouring colouring(mode, drawing.lines);
    std::string rgb;
    for (const MapLine* line : drawing.lines) {
      const Rgb c = colouring(*line);
      for (const std::uint8_t v : {c.r, c.g, c.b}) rgb.push_back(static_cast<char>(v));
    }
    Json legend = Json::array();
    for (const auto& [text, colour] : colouring.legend(drawing.lines, names))
      legend.push_back({text, cssColour(colour)});
    data["colours"][name] = {{"rgb", base64(rgb)}, {"legend", legend}};
  }
  return data;
}

Json pathData(const Drawing& drawing, std::int64_t origin_ns) {
  Floats positions, cameras, frustum;
  Json seconds = Json::array();
  for (const auto& [t_ns, T_w_b] : drawing.map->trajectory) {
    if (drawing.summary.trajectory == 0 || !drawable(T_w_b)) continue;
    const Pose T_w_c = T_w_b * drawing.map->rig.T_b_c;
    positions.add(T_w_b.p), cameras.add(T_w_c.p);
    for (const double v : {T_w_c.q.x(), T_w_c.q.y(), T_w_c.q.z(), T_w_c.q.w()}) cameras.add(v);
    seconds.push_back(secondsSince(t_ns, origin_ns));
  }
  Rig camera_at_origin = drawing.map->rig;
  camera_at_origin.T_b_c = Pose{};
  for (const DrawnSegment& s : frustumSegments(camera_at_origin, Pose{}, 2 * drawing.frustum_m, {}))
    frustum.add(s.start), frustum.add(s.end);
  return {
      {"positions", positions.text()}, {"cameras", cameras.text()}, {"frustum", frustum.text()}, {"seconds", seconds}};
}

Json mapData(const Drawing& drawing) {
  const LineMap& map = *drawing.map;
  const std::int64_t origin_ns = !map.trajectory.empty()  ? map.trajectory.front().first
                                 : !drawing.lines.empty() ? drawing.lines.front()->first_t_ns
                                                          : 0;
  Floats points, keyframes;
  for (const DrawnPart& part : drawing.parts) {
    for (const DrawnPoint& point : part.points) points.add(point.p);
    if (part.layer != MapLayer::kKeyframes) continue;
    for (const DrawnSegment& s : part.segments) keyframes.add(s.start), keyframes.add(s.end);
  }
  Json data = coloursData(drawing);
  const Eigen::Vector3d centre = drawing.core.center();
  data["centre"] = {centre.x(), centre.y(), centre.z()};
  data["extent"] = std::max(drawing.core.diagonal().norm(), 1e-3);
  data["lines"] = linesData(drawing, origin_ns);
  data["groups"] = Json::array();
  const GroupNames names(map);
  for (const DrawnPart& part : drawing.parts) {
    if (part.layer == MapLayer::kLines) data["groups"].push_back({{"group", part.group}, {"name", names(part.group)}});
  }
  addStructure(drawing, data);
  data["points"] = points.text();
  data["keyframes"] = keyframes.text();
  data["keyframe_count"] = drawing.summary.keyframes;
  data["path"] = pathData(drawing, origin_ns);
  return data;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '[':
        out += "&#91;";
        break;  // no name can equal one of the page's marks
      default:
        out += c;
    }
  }
  return out;
}

/// The page with each mark [[NAME]] replaced; what is put in is not looked at again.
std::string fill(std::string_view page, const std::vector<std::pair<std::string_view, std::string>>& marks) {
  std::string out;
  while (!page.empty()) {
    const std::size_t at = page.find("[["), end = page.find("]]", at);
    out += page.substr(0, at);
    if (at == std::string_view::npos) break;
    const std::string_view name = page.substr(at + 2, end - at - 2);
    for (const auto& [mark, text] : marks) {
      if (mark == name) out += text;
    }
    page.remove_prefix(end + 2);
  }
  return out;
}

}  // namespace

OutputFiles htmlFiles(const Drawing& drawing, const std::string& path) {
  std::string wide_lines;
  for (const char* file : {"LineSegmentsGeometry", "LineMaterial", "LineSegments2"})
    wide_lines += library("examples/js/lines/" + std::string(file) + ".js");
  const std::string name = drawing.map->source.empty() ? "Line map" : "Line map of " + drawing.map->source;
  std::string data = mapData(drawing).dump(-1, ' ', true, Json::error_handler_t::replace);
  return {{path, fill(kViewerPage, {{"TITLE", escaped(name)},
                                    {"DATA", std::move(data)},
                                    {"THREE", library("three.min.js")},
                                    {"CONTROLS", library("examples/js/controls/OrbitControls.js")},
                                    {"WIDE_LINES", std::move(wide_lines)}})}};
}

}  // namespace lintel
