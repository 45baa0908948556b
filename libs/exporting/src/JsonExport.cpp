// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "Text.h"
#include "Writers.h"
#include "lintel/geometry/LensNames.h"

namespace lintel {

namespace {

/// Writes JSON piece by piece: a tree in memory of an hour's map would be many times the text.
class JsonWriter {
 public:
  explicit JsonWriter(const Drawing& drawing) : drawing_(drawing) {}

  std::string write() {
    const LineMap& map = *drawing_.map;
    text_ << "{\n\"format\": \"lintel map\",\n\"version\": 1,\n\"frame\": \"world [m], z up\",\n\"source\": ";
    string(map.source);
    text_ << ",\n\"configuration\": ";
    string(map.configuration);
    text_ << ",\n\"rig\": ";
    writeRig(map.rig);
    writeGroups(map);
    list("keyframes", drawing_.keyframes, [this](const MapKeyframe& keyframe) { writeKeyframe(keyframe); });
    list("points", points(), [this](const MapPoint* point) { writePoint(*point); });
    list("lines", drawing_.lines, [this](const MapLine* line) { writeLine(*line); });
    list("corners", placesOf(drawing_.structure.corners), [this](const MapCorner* corner) { writeCorner(*corner); });
    list("planes", placesOf(drawing_.structure.planes), [this](const MapPlane* plane) { writePlane(*plane); });
    list("trajectory", trajectory(), [this](const auto* stamped) {
      text_ << "{\"t_ns\": " << stamped->first << ", ", pose(stamped->second), text_ << '}';
    });
    text_ << "\n}\n";
    return std::move(text_.bytes());
  }

 private:
  void writeGroups(const LineMap& map) {
    const GroupNames names(map);
    int place = 0;
    std::vector<const MapGroup*> groups;
    for (const MapGroup& group : map.groups) groups.push_back(&group);
    list("groups", groups, [&](const MapGroup* group) {
      text_ << "{\"name\": ";
      string(names(place++));
      vectorField("direction", group->direction_w), field("spread_rad", group->spread_rad), text_ << '}';
    });
  }

  std::vector<const MapPoint*> points() const {
    std::vector<const MapPoint*> found;
    for (const DrawnPart& part : drawing_.parts) {
      for (const DrawnPoint& point : part.points) found.push_back(point.point);
    }
    return found;
  }

  std::vector<const std::pair<std::int64_t, Pose>*> trajectory() const {
    std::vector<const std::pair<std::int64_t, Pose>*> found;
    if (drawing_.summary.trajectory == 0) return found;
    for (const auto& stamped : drawing_.map->trajectory) {
      if (drawable(stamped.second)) found.push_back(&stamped);
    }
    return found;
  }

  template <class List, class WriteOne>
  void list(std::string_view name, const List& all, WriteOne&& write_one) {
    text_ << ",\n\"" << name << "\": [";
    bool first = true;
    for (const auto& one : all) {
      text_ << (first ? "\n" : ",\n");
      write_one(one);
      first = false;
    }
    text_ << ']';
  }

  void string(std::string_view s) {
    constexpr char digits[] = "0123456789abcdef";
    text_ << '"';
    for (const char c : s) {
      const auto u = static_cast<unsigned char>(c);
      if (c == '"' || c == '\\') {
        text_ << '\\' << c;
      } else if (u < 0x20) {
        text_ << "\\u00" << digits[u >> 4] << digits[u & 15];
      } else {
        text_ << c;
      }
    }
    text_ << '"';
  }

  void number(double v) {  // JSON has no numbers that are not finite
    if (std::isfinite(v)) {
      text_ << v;
    } else {
      text_ << "null";
    }
  }

  template <class Vector>
  void vector(const Vector& v) {
    for (Eigen::Index i = 0; i < v.size(); ++i) text_ << (i == 0 ? "[" : ", "), number(v[i]);
    text_ << ']';
  }

  void field(std::string_view name, double v, std::string_view before = ", ") {
    text_ << before << '"' << name << "\": ";
    number(v);
  }
  template <class Vector>
  void vectorField(std::string_view name, const Vector& v, std::string_view before = ", ") {
    text_ << before << '"' << name << "\": ";
    vector(v);
  }

  void pose(const Pose& T) {
    vectorField("p", T.p, "");
    vectorField("q_wxyz", Eigen::Vector4d(T.q.w(), T.q.x(), T.q.y(), T.q.z()));
  }

  void writeRig(const Rig& rig) {
    const Camera& c = rig.camera;
    text_ << "{\"width\": " << c.width << ", \"height\": " << c.height;
    field("fx", c.fx), field("fy", c.fy), field("cx", c.cx), field("cy", c.cy);
    const std::vector<double> lens = lensCoefficients(c);
    for (std::size_t i = 0; i < lens.size(); ++i) field(lensName(c.model).coefficients[i], lens[i]);
    field("camera_rate_hz", rig.camera_rate_hz), field("imu_rate_hz", rig.imu_rate_hz);
    field("gyro_noise", rig.imu_noise.gyro_noise), field("gyro_walk", rig.imu_noise.gyro_walk);
    field("accel_noise", rig.imu_noise.accel_noise), field("accel_walk", rig.imu_noise.accel_walk);
    text_ << ", \"T_b_c\": {", pose(rig.T_b_c), text_ << "}}";
  }

  void writeKeyframe(const MapKeyframe& keyframe) {
    text_ << "{\"id\": " << keyframe.id << ", \"t_ns\": " << keyframe.t_ns << ", ";
    pose(keyframe.T_w_b);
    vectorField("v_w_b", keyframe.v_w_b), vectorField("bias_gyro", keyframe.bias_gyro),
        vectorField("bias_accel", keyframe.bias_accel);
    text_ << '}';
  }

  void writePoint(const MapPoint& point) {
    text_ << "{\"id\": " << point.id;
    vectorField("p_w", point.p_w), field("sigma_distance_m", point.sigma_distance_m);
    text_ << ", \"first_t_ns\": " << point.first_t_ns << ", \"last_t_ns\": " << point.last_t_ns
          << ", \"observations\": [";
    for (std::size_t i = 0; i < point.observations.size(); ++i) {
      text_ << (i == 0 ? "" : ", ") << "{\"keyframe\": " << point.observations[i].keyframe_id;
      vectorField("px", point.observations[i].px), text_ << '}';
    }
    text_ << "]}";
  }

  void writeLine(const MapLine& line) {
    text_ << "{\"id\": " << line.id;
    vectorField("start", line.segment_w.start), vectorField("end", line.segment_w.end);
    field("sigma_direction_rad", line.sigma_direction_rad), field("sigma_distance_m", line.sigma_distance_m);
    text_ << ", \"first_t_ns\": " << line.first_t_ns << ", \"last_t_ns\": " << line.last_t_ns;
    text_ << ", \"degenerate\": " << (line.degenerate ? "true" : "false")
          << ", \"constrained\": " << (line.constrained ? "true" : "false")
          << ", \"source\": " << (line.mapped ? "\"mapped\"" : "\"tracked\"");
    text_ << ", \"group\": " << line.group << ", \"observations\": [";
    for (std::size_t i = 0; i < line.observations.size(); ++i) {
      text_ << (i == 0 ? "" : ", ") << "{\"keyframe\": " << line.observations[i].keyframe_id;
      vectorField("start_px", line.observations[i].start_px), vectorField("end_px", line.observations[i].end_px);
      text_ << '}';
    }
    text_ << "]}";
  }

  template <class Thing>
  static std::vector<const Thing*> placesOf(const std::vector<Thing>& things) {
    std::vector<const Thing*> places;
    places.reserve(things.size());
    for (const Thing& thing : things) places.push_back(&thing);
    return places;
  }

  void idsField(std::string_view name, const std::vector<std::uint64_t>& ids) {
    text_ << ", \"" << name << "\": [";
    for (std::size_t i = 0; i < ids.size(); ++i) text_ << (i == 0 ? "" : ", ") << ids[i];
    text_ << ']';
  }

  void writeCorner(const MapCorner& corner) {
    vectorField("p_w", corner.p_w, "{"), field("sigma_m", corner.sigma_m), idsField("lines", corner.lines);
    text_ << '}';
  }

  void writePlane(const MapPlane& plane) {
    text_ << "{\"name\": ";
    string(plane.name);
    vectorField("normal", plane.normal_w), field("offset_m", plane.offset_m), field("spread_m", plane.spread_m);
    idsField("lines", plane.lines), idsField("points", plane.points), text_ << '}';
  }

  const Drawing& drawing_;
  Text text_;
};

}  // namespace

OutputFiles jsonFiles(const Drawing& drawing, const std::string& path) { return {{path, JsonWriter(drawing).write()}}; }

}  // namespace lintel
