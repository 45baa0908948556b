// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "lintel/core/Frame.h"
#include "lintel/core/Rig.h"
#include "lintel/simulation/ImuSimulator.h"
#include "lintel/simulation/Scene.h"

namespace lintel {

/// A true line as it is written.
struct TrueLine {
  SceneLine line;
  int direction_group = -1;  ///< families of parallel lines, the largest is 0
  int frames_seen = 0;
};

/// Writes the files of an EuRoC folder. Every function throws std::runtime_error naming the file that cannot be
/// written.
class EurocWriter {
 public:
  /// `folder` gets `mav0`; it is created with its parents.
  explicit EurocWriter(const std::filesystem::path& folder);

  /// mav0/body.yaml and the sensor.yaml of cam0, imu0 and the ground truth.
  void writeSensors(const Rig& rig) const;

  /// One image, mav0/cam0/data/T_NS.png. May be called from several threads.
  void writeImage(std::int64_t t_ns, const GrayImage& image) const;
  void writeImageList(const std::vector<std::int64_t>& stamps) const;

  void writeImu(const std::vector<ImuSample>& samples) const;
  void writeGroundTruth(const std::vector<InertialTruth>& truth) const;

  /// mav0/lines0/data.csv: id,x0,y0,z0,x1,y1,z1,direction_group,kind,frames_seen in the world frame [m].
  void writeLines(const std::vector<TrueLine>& lines) const;

  /// mav0/scene0/scene.ply: the true surfaces as triangles, world frame [m].
  void writeScene(const Scene& scene) const;

 private:
  std::filesystem::path mav0_;
};

/// Numbers families of at least six lines that are parallel within 0.2 degrees, the largest first; -1 for the others.
std::vector<int> directionGroups(const std::vector<SceneLine>& lines);

}  // namespace lintel
