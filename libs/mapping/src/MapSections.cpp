// SPDX-License-Identifier: BSD-3-Clause
#include "MapSections.h"

#include <algorithm>

#include "lintel/geometry/LensNames.h"

namespace lintel {

namespace {

// Smallest bytes of one record, to bound what its announced number may reserve.
constexpr std::size_t kKeyframeBytes = 8 + 8 + 7 * 8 + 9 * 8, kPointObservationBytes = 8 + 2 * 8,
                      kPointBytes = 8 + 3 * 8 + 8 + 16 + 8, kLineObservationBytes = 8 + 4 * 8,
                      kLineBytes = 8 + 6 * 8 + 16 + 16 + 1 + 4 + 8, kTrajectoryBytes = 8 + 7 * 8,
                      kGroupBytes = 8 + 3 * 8 + 8, kCovarianceBytes = std::size_t{10} * 4,
                      kErrorsBytes = std::size_t{6} * kErrorDraws * 4, kCornerBytes = 3 * 8 + 8 + 8,
                      kPlaneBytes = 8 + 3 * 8 + 2 * 8 + 2 * 8;

enum LineFlag : std::uint8_t { kDegenerate = 1, kConstrained = 2, kMapped = 4 };

// One list of a rig's numbers serves both directions, so that they cannot differ.
template <class RigT, class Integer, class Number>
void rigFields(RigT& rig, Integer&& integer, Number&& number) {
  auto& camera = rig.camera;
  integer(camera.width), integer(camera.height);
  number(camera.fx), number(camera.fy), number(camera.cx), number(camera.cy);
  for (int i = 0; i < 4; ++i) number(camera.lens[static_cast<std::size_t>(i)]);
  number(rig.camera_rate_hz), number(rig.imu_rate_hz);
  auto& noise = rig.imu_noise;
  number(noise.gyro_noise), number(noise.gyro_walk), number(noise.accel_noise), number(noise.accel_walk);
}

void encodeRig(const LineMap& map, ByteWriter& out) {
  rigFields(
      map.rig, [&](int v) { out.i32(v); }, [&](double v) { out.f64(v); });
  out.pose(map.rig.T_b_c);
}

void decodeRig(ByteReader& in, LineMap& map) {
  rigFields(
      map.rig, [&](int& v) { v = in.i32(); }, [&](double& v) { v = in.f64(); });
  map.rig.T_b_c = in.pose();
}

/// Nothing for a lens that RIG_ describes.
void encodeLens(const LineMap& map, ByteWriter& out) {
  const Camera& camera = map.rig.camera;
  if (camera.model == LensModel::kRadialTangential && camera.lens[4] == 0) return;
  out.text(lensName(camera.model).name);
  for (const double coefficient : camera.lens) out.f64(coefficient);
}

void decodeLens(ByteReader& in, LineMap& map) {
  const auto model = lensModel(in.text());
  if (!model) throw ByteReaderError("names a lens model that this version does not have");
  map.rig.camera.model = *model;
  for (double& coefficient : map.rig.camera.lens) coefficient = in.f64();
}

void encodeConfiguration(const LineMap& map, ByteWriter& out) { out.text(map.configuration); }
void decodeConfiguration(ByteReader& in, LineMap& map) { map.configuration = in.text(); }
void encodeSource(const LineMap& map, ByteWriter& out) { out.text(map.source); }
void decodeSource(ByteReader& in, LineMap& map) { map.source = in.text(); }

void encodeKeyframes(const LineMap& map, ByteWriter& out) {
  out.u64(map.keyframes.size());
  for (const MapKeyframe& keyframe : map.keyframes) {
    out.u64(keyframe.id), out.i64(keyframe.t_ns), out.pose(keyframe.T_w_b);
    out.vec3(keyframe.v_w_b), out.vec3(keyframe.bias_gyro), out.vec3(keyframe.bias_accel);
  }
}

void decodeKeyframes(ByteReader& in, LineMap& map) {
  map.keyframes.resize(in.count(kKeyframeBytes));
  for (MapKeyframe& keyframe : map.keyframes) {
    keyframe.id = in.u64(), keyframe.t_ns = in.i64(), keyframe.T_w_b = in.pose();
    keyframe.v_w_b = in.vec3(), keyframe.bias_gyro = in.vec3(), keyframe.bias_accel = in.vec3();
  }
}

void encodePoints(const LineMap& map, ByteWriter& out) {
  out.u64(map.points.size());
  for (const MapPoint& point : map.points) {
    out.u64(point.id), out.vec3(point.p_w), out.f64(point.sigma_distance_m);
    out.i64(point.first_t_ns), out.i64(point.last_t_ns), out.u64(point.observations.size());
    for (const MapPointObservation& seen : point.observations) out.u64(seen.keyframe_id), out.vec2(seen.px);
  }
}

void decodePoints(ByteReader& in, LineMap& map) {
  map.points.resize(in.count(kPointBytes));
  for (MapPoint& point : map.points) {
    point.id = in.u64(), point.p_w = in.vec3(), point.sigma_distance_m = in.f64();
    point.first_t_ns = in.i64(), point.last_t_ns = in.i64();
    point.observations.resize(in.count(kPointObservationBytes));
    for (MapPointObservation& seen : point.observations) seen.keyframe_id = in.u64(), seen.px = in.vec2();
  }
}

void encodeLines(const LineMap& map, ByteWriter& out) {
  out.u64(map.lines.size());
  for (const MapLine& line : map.lines) {
    out.u64(line.id), out.vec3(line.segment_w.start), out.vec3(line.segment_w.end);
    out.f64(line.sigma_direction_rad), out.f64(line.sigma_distance_m);
    out.i64(line.first_t_ns), out.i64(line.last_t_ns);
    out.u8(static_cast<std::uint8_t>((line.degenerate ? kDegenerate : 0) | (line.constrained ? kConstrained : 0) |
                                     (line.mapped ? kMapped : 0)));
    out.i32(line.group), out.u64(line.observations.size());
    for (const MapLineObservation& seen : line.observations)
      out.u64(seen.keyframe_id), out.vec2(seen.start_px), out.vec2(seen.end_px);
  }
}

void decodeLines(ByteReader& in, LineMap& map) {
  map.lines.resize(in.count(kLineBytes));
  for (MapLine& line : map.lines) {
    line.id = in.u64(), line.segment_w.start = in.vec3(), line.segment_w.end = in.vec3();
    line.sigma_direction_rad = in.f64(), line.sigma_distance_m = in.f64();
    line.first_t_ns = in.i64(), line.last_t_ns = in.i64();
    const std::uint8_t flags = in.u8();
    line.degenerate = (flags & kDegenerate) != 0, line.constrained = (flags & kConstrained) != 0;
    line.mapped = (flags & kMapped) != 0;
    line.group = in.i32();
    line.observations.resize(in.count(kLineObservationBytes));
    for (MapLineObservation& seen : line.observations) {
      seen.keyframe_id = in.u64(), seen.start_px = in.vec2(), seen.end_px = in.vec2();
    }
  }
}

void encodeTrajectory(const LineMap& map, ByteWriter& out) {
  out.u64(map.trajectory.size());
  for (const auto& [t_ns, T_w_b] : map.trajectory) out.i64(t_ns), out.pose(T_w_b);
}

void decodeTrajectory(ByteReader& in, LineMap& map) {
  map.trajectory.resize(in.count(kTrajectoryBytes));
  for (auto& [t_ns, T_w_b] : map.trajectory) t_ns = in.i64(), T_w_b = in.pose();
}

void encodeGroups(const LineMap& map, ByteWriter& out) {
  out.u64(map.groups.size());
  for (const MapGroup& group : map.groups) out.text(group.name), out.vec3(group.direction_w), out.f64(group.spread_rad);
}

void decodeGroups(ByteReader& in, LineMap& map) {
  map.groups.resize(in.count(kGroupBytes));
  for (MapGroup& group : map.groups) group.name = in.text(), group.direction_w = in.vec3(), group.spread_rad = in.f64();
}

// What files of former versions do not have: an empty section is not written, and what is not there stays empty.

template <class Numbers>
void encodeFloats(const Numbers& values, ByteWriter& out) {
  for (Eigen::Index i = 0; i < values.size(); ++i) out.f32(values.data()[i]);
}

template <class Numbers>
void decodeFloats(ByteReader& in, Numbers& values) {
  for (Eigen::Index i = 0; i < values.size(); ++i) values.data()[i] = in.f32();
}

/// The lower halves of the lines' covariances.
void encodeCovariances(const LineMap& map, ByteWriter& out) {
  if (std::all_of(map.lines.begin(), map.lines.end(), [](const MapLine& line) { return line.covariance.isZero(0); }))
    return;
  out.u64(map.lines.size());
  for (const MapLine& line : map.lines)
    for (int c = 0; c < 4; ++c)
      for (int r = c; r < 4; ++r) out.f32(line.covariance(r, c));
}

void decodeCovariances(ByteReader& in, LineMap& map) {
  if (in.count(kCovarianceBytes) != map.lines.size()) throw ByteReaderError("has not one covariance for each line");
  for (MapLine& line : map.lines)
    for (int c = 0; c < 4; ++c)
      for (int r = c; r < 4; ++r) line.covariance(r, c) = line.covariance(c, r) = in.f32();
}

void encodeErrors(const LineMap& map, ByteWriter& out) {
  if (map.camera_errors.empty()) return;
  out.u32(kErrorDraws), out.u64(map.camera_errors.size());
  for (const CameraErrors& errors : map.camera_errors) encodeFloats(errors, out);
}

void decodeErrors(ByteReader& in, LineMap& map) {
  if (in.u32() != kErrorDraws) throw ByteReaderError("has not as many draws as this version reads");
  map.camera_errors.resize(in.count(kErrorsBytes));
  if (map.camera_errors.size() != map.keyframes.size())
    throw ByteReaderError("has not the errors of one camera for each keyframe");
  for (CameraErrors& errors : map.camera_errors) decodeFloats(in, errors);
}

void encodeIds(const std::vector<std::uint64_t>& ids, ByteWriter& out) {
  out.u64(ids.size());
  for (const std::uint64_t id : ids) out.u64(id);
}

void decodeIds(ByteReader& in, std::vector<std::uint64_t>& ids) {
  ids.resize(in.count(8));
  for (std::uint64_t& id : ids) id = in.u64();
}

void encodeCorners(const LineMap& map, ByteWriter& out) {
  if (map.corners.empty()) return;
  out.u64(map.corners.size());
  for (const MapCorner& corner : map.corners)
    out.vec3(corner.p_w), out.f64(corner.sigma_m), encodeIds(corner.lines, out);
}

void decodeCorners(ByteReader& in, LineMap& map) {
  map.corners.resize(in.count(kCornerBytes));
  for (MapCorner& corner : map.corners) corner.p_w = in.vec3(), corner.sigma_m = in.f64(), decodeIds(in, corner.lines);
}

void encodePlanes(const LineMap& map, ByteWriter& out) {
  if (map.planes.empty()) return;
  out.u64(map.planes.size());
  for (const MapPlane& plane : map.planes) {
    out.text(plane.name), out.vec3(plane.normal_w), out.f64(plane.offset_m), out.f64(plane.spread_m);
    encodeIds(plane.lines, out), encodeIds(plane.points, out);
  }
}

void decodePlanes(ByteReader& in, LineMap& map) {
  map.planes.resize(in.count(kPlaneBytes));
  for (MapPlane& plane : map.planes) {
    plane.name = in.text(), plane.normal_w = in.vec3(), plane.offset_m = in.f64(), plane.spread_m = in.f64();
    decodeIds(in, plane.lines), decodeIds(in, plane.points);
  }
}

}  // namespace

const MapSection kMapSections[kMapSectionCount] = {{"RIG_", encodeRig, decodeRig},
                                                   {"LENS", encodeLens, decodeLens},
                                                   {"CONF", encodeConfiguration, decodeConfiguration},
                                                   {"SRC_", encodeSource, decodeSource},
                                                   {"KEYF", encodeKeyframes, decodeKeyframes},
                                                   {"PNTS", encodePoints, decodePoints},
                                                   {"LINE", encodeLines, decodeLines},
                                                   {"TRAJ", encodeTrajectory, decodeTrajectory},
                                                   {"GRPS", encodeGroups, decodeGroups},
                                                   {"LCOV", encodeCovariances, decodeCovariances},
                                                   {"KERR", encodeErrors, decodeErrors},
                                                   {"CRNR", encodeCorners, decodeCorners},
                                                   {"PLNE", encodePlanes, decodePlanes},
                                                   {"PIEC", encodePieces, decodePieces},
                                                   {"IMU_", encodeImu, decodeImu},
                                                   {"STMP", encodeStamps, decodeStamps},
                                                   {"CORR", encodeCorrelated, decodeCorrelated},
                                                   {"OFFS", encodeOffsets, decodeOffsets},
                                                   {"VIEW", encodeViews, decodeViews}};

}  // namespace lintel
