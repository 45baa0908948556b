// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "lintel/geometry/Pose.h"

namespace lintel {

struct MapMaterial;

/// A stretch of a flight without interruption: the IMU leads from each keyframe to the next. Pieces of one world were
/// brought into one frame by places that they have in common; between worlds nothing is known.
struct MapPiece {
  std::uint64_t first_keyframe = 0;
  std::int64_t first_ns = 0, last_ns = 0;  ///< of its keyframes
  std::uint64_t first_pose = 0;            ///< of its poses in the trajectory
  int world = 0;                           ///< the number of the first piece of that world
  int recording = 0;                       ///< which one of a map of several
};

/// Pieces as the IMU's gaps separate them, each a world of its own. None without any IMU.
std::vector<MapPiece> separatePieces(const MapMaterial& material);

/// Which piece a keyframe is of. `pieces` are ascending and not empty.
std::size_t pieceOf(const std::vector<MapPiece>& pieces, std::uint64_t keyframe);

/// The places in the trajectory where a piece's poses begin and end.
std::pair<std::size_t, std::size_t> posesOf(const std::vector<MapPiece>& pieces, std::size_t piece, std::size_t poses);

/// Moves a piece of the material, `new_from_old` keeps the vertical: keyframes, their part of the trajectory, points
/// and lines that they saw.
void movePiece(std::size_t piece, const Pose& new_from_old, MapMaterial& material);

/// Puts another recording's material behind, whose times are later. Ids of keyframes, points and lines grow by what is
/// returned; the calibration stays.
struct AppendedIds {
  std::uint64_t keyframes = 0, points = 0, lines = 0;
  int pieces = 0;
};
AppendedIds appendMaterial(MapMaterial other, MapMaterial& material);

}  // namespace lintel
