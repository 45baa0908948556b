// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/MapPieces.h"

#include <algorithm>

#include "lintel/mapping/MapMaterial.h"

namespace lintel {

std::vector<MapPiece> separatePieces(const MapMaterial& material) {
  std::vector<MapPiece> pieces;
  const auto has_imu = [](const RetiredKeyframe& keyframe) { return keyframe.imu != nullptr; };
  if (std::none_of(material.keyframes.begin(), material.keyframes.end(), has_imu)) return pieces;
  for (const RetiredKeyframe& keyframe : material.keyframes) {
    if (pieces.empty() || !keyframe.imu)
      pieces.push_back({keyframe.id, keyframe.t_ns, keyframe.t_ns, 0, static_cast<int>(pieces.size()), 0});
    pieces.back().last_ns = keyframe.t_ns;
  }
  const auto& poses = material.trajectory;
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const auto first = std::lower_bound(poses.begin(), poses.end(), pieces[i].first_ns,
                                        [](const auto& pose, std::int64_t t_ns) { return pose.first < t_ns; });
    pieces[i].first_pose = static_cast<std::uint64_t>(first - poses.begin());
  }
  return pieces;
}

std::size_t pieceOf(const std::vector<MapPiece>& pieces, std::uint64_t keyframe) {
  const auto after =
      std::upper_bound(pieces.begin(), pieces.end(), keyframe,
                       [](std::uint64_t id, const MapPiece& piece) { return id < piece.first_keyframe; });
  return after == pieces.begin() ? 0 : static_cast<std::size_t>(after - pieces.begin()) - 1;
}

std::pair<std::size_t, std::size_t> posesOf(const std::vector<MapPiece>& pieces, std::size_t piece, std::size_t poses) {
  const auto bounded = [&](std::size_t at) {
    return at < pieces.size() ? std::min<std::size_t>(pieces[at].first_pose, poses) : poses;
  };
  return {bounded(piece), std::max(bounded(piece), bounded(piece + 1))};
}

void movePiece(std::size_t piece, const Pose& new_from_old, MapMaterial& material) {
  const std::vector<MapPiece>& pieces = material.pieces;
  const auto isOf = [&](const auto& record) {
    return !record.views.empty() && pieceOf(pieces, record.views.front().keyframe) == piece;
  };
  for (RetiredKeyframe& keyframe : material.keyframes) {
    if (pieceOf(pieces, keyframe.id) != piece) continue;
    keyframe.T_w_b = new_from_old * keyframe.T_w_b;
    keyframe.v_w_b = new_from_old.q * keyframe.v_w_b;
  }
  for (PointRecord& point : material.points)
    if (isOf(point)) point.p_w = new_from_old * point.p_w;
  for (LineRecord& line : material.lines) {
    if (!isOf(line)) continue;
    line.estimate.middle_w = new_from_old * line.estimate.middle_w;
    line.estimate.direction_w = new_from_old.q * line.estimate.direction_w;
    line.tie.reset();
  }
  const auto [from, to] = posesOf(pieces, piece, material.trajectory.size());
  for (std::size_t i = from; i < to; ++i) material.trajectory[i].second = new_from_old * material.trajectory[i].second;
}

AppendedIds appendMaterial(MapMaterial other, MapMaterial& material) {
  const auto next = [](const auto& records) { return records.empty() ? 0 : records.back().id + 1; };
  const AppendedIds ids{next(material.keyframes), next(material.points), next(material.lines),
                        static_cast<int>(material.pieces.size())};
  for (MapPiece& piece : other.pieces) {
    piece.first_keyframe += ids.keyframes;
    piece.first_pose += material.trajectory.size();
    piece.world += ids.pieces;
    material.pieces.push_back(piece);
  }
  material.camera_errors.clear();  // another adjustment finds them
  for (RetiredKeyframe& keyframe : other.keyframes) {
    keyframe.id += ids.keyframes;
    keyframe.offset_change_s += other.time_offset_s - material.time_offset_s;
    material.keyframes.push_back(std::move(keyframe));
  }
  for (PointRecord& point : other.points) {
    point.id += ids.points, point.track += ids.points;
    for (TrackId& track : point.joined) track += ids.points;
    for (PointView& view : point.views) view.keyframe += static_cast<std::uint32_t>(ids.keyframes);
    material.points.push_back(std::move(point));
  }
  for (LineRecord& line : other.lines) {
    line.id += ids.lines;
    for (LineView& view : line.views) view.keyframe += ids.keyframes, view.track += ids.lines;
    material.lines.push_back(std::move(line));
  }
  material.trajectory.insert(material.trajectory.end(), other.trajectory.begin(), other.trajectory.end());
  return ids;
}

}  // namespace lintel
