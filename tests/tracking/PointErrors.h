// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "TruePoses.h"
#include "lintel/core/FrameTracks.h"
#include "lintel/core/Rig.h"

namespace lintel::truth {

/// How well points stay on what they follow. Every track is fitted with one place in the world, poses and camera as the
/// recording's ground truth says; what is left is the tracker's error. White noise is the same at any age; drift grows
/// with it.
class PointErrors {
 public:
  PointErrors(const TruePoses& poses, const Rig& rig) : poses_(poses), rig_(rig) {}

  void add(const FrameTracks& tracks);

  /// A line for each class of track lengths, and one of how the errors of a track change with time.
  void print() const;

 private:
  struct Sighting {
    Pose T_w_c;
    Eigen::Vector3d ray;
  };
  using Track = std::vector<Sighting>;

  std::vector<Eigen::Vector2d> residualsOf(const Track& track) const;
  void printLags() const;
  void printLengths(std::size_t from, std::size_t to) const;

  const TruePoses& poses_;
  Rig rig_;
  std::map<TrackId, Track> tracks_;
};

}  // namespace lintel::truth
