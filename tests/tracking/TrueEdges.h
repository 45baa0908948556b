// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "TruePoses.h"
#include "lintel/core/Rig.h"
#include "lintel/geometry/Camera.h"
#include "lintel/geometry/Pose.h"

namespace lintel::truth {

/// A true edge as one image shows it. Undistorted pixels: normalised coordinates times the mean focal length.
struct SeenEdge {
  int id = 0;
  Eigen::Vector2d start, end;  ///< the part that is seen
  Eigen::Vector3d line;        ///< the infinite line: line . (x, y, 1) is the signed distance [px]
};

/// The true edges, poses and camera of a rendered EuRoC folder (mav0/lines0 with visible.csv,
/// mav0/state_groundtruth_estimate0; mav0/arena.txt has the camera that took the images where it is not the rig's).
/// Throws std::runtime_error naming what is missing.
class TrueEdges {
 public:
  /// `poses` must outlive this.
  TrueEdges(const std::string& recording, const Rig& rig, const TruePoses& poses);

  const Camera& camera() const { return camera_; }
  /// Edges that the image of that time shows; empty without a pose for it.
  std::vector<SeenEdge> seenAt(std::int64_t t_ns) const;
  /// The infinite line of any edge at that time, seen or not; zero without a pose.
  Eigen::Vector3d lineAt(int id, std::int64_t t_ns) const;
  const std::string& kind(int id) const { return edges_.at(id).kind; }

 private:
  struct Edge {
    Eigen::Vector3d start_w, end_w;
    std::string kind;
  };
  std::optional<Pose> poseAt(std::int64_t t_ns) const;  ///< T_c_w
  Eigen::Vector3d lineOf(const Edge& edge, const Pose& T_c_w) const;

  Camera camera_;
  Pose T_b_c_;
  double delay_s_ = 0;  ///< an image with stamp t shows the scene at t + delay
  std::map<int, Edge> edges_;
  std::multimap<std::int64_t, std::pair<int, int>> visible_;  ///< time: edge, mask of its five points
  const TruePoses& poses_;
};

}  // namespace lintel::truth
