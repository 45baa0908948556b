// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/pipeline/Results.h"

#include <cinttypes>
#include <filesystem>
#include <stdexcept>

#include "lintel/core/AtomicFile.h"
#include "lintel/core/Formatted.h"
#include "lintel/exporting/MapExport.h"
#include "lintel/mapping/MapFile.h"

namespace lintel {

namespace fs = std::filesystem;

namespace {

constexpr const char* kMaskFile = "mask.pgm";

/// Netpbm's graymap, binary.
std::string grayMapText(const GrayImage& image) {
  std::string text = "P5\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n255\n";
  text.append(image.pixels.begin(), image.pixels.end());
  return text;
}

}  // namespace

std::vector<std::string> writeResults(const OdometryResult& result, const std::string& folder,
                                      const std::vector<std::string>& exports) {
  const fs::path out(folder);
  std::error_code error;
  fs::create_directories(out, error);
  if (error) throw std::runtime_error(folder + ": cannot be made: " + error.message() + "; choose another folder");
  AtomicFile::writeWhole((out / "trajectory.tum").string(), trajectoryText(result.trajectory));
  for (const char* earlier : {"trajectory_refined.tum", "stats.json"})  // must not be taken for this run's
    fs::remove(out / earlier, error);
  AtomicFile::writeWhole((out / "trajectory_covariance.csv").string(), covarianceText(result.trajectory));
  if (result.refinement.accepted)
    AtomicFile::writeWhole((out / "trajectory_refined.tum").string(), trajectoryText(result.refined_trajectory));
  AtomicFile::writeWhole((out / "config.yaml").string(), result.map.configuration);
  if (result.found_mask)
    AtomicFile::writeWhole((out / kMaskFile).string(), grayMapText(*result.found_mask));
  else if (!result.rig.mask)  // else it may be the one that was given
    fs::remove(out / kMaskFile, error);
  writeMap(result.map, (out / "map.lintel").string());
  return writeExports(result.map, folder, exports);
}

std::vector<std::string> writeExports(const LineMap& map, const std::string& folder,
                                      const std::vector<std::string>& exports) {
  std::vector<std::string> files;
  files.reserve(exports.size());
  for (const std::string& extension : exports)
    files.push_back(exportMap(map, (fs::path(folder) / ("map." + extension)).string()).files.front());
  return files;
}

std::string trajectoryText(const std::vector<OdometryPose>& trajectory) {
  std::string text = "# timestamp tx ty tz qx qy qz qw\n";
  for (const OdometryPose& pose : trajectory) {
    const Eigen::Vector3d& p = pose.T_w_b.p;
    const Eigen::Quaterniond& q = pose.T_w_b.q;
    text += formatted("%" PRId64 ".%09" PRId64 " %.9f %.9f %.9f %.9f %.9f %.9f %.9f\n", pose.t_ns / 1000000000,
                      pose.t_ns % 1000000000, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  }
  return text;
}

std::string covarianceText(const std::vector<OdometryPose>& trajectory) {
  constexpr const char* kNames[] = {"x", "y", "z", "yaw", "pitch", "roll"};
  std::string text = "# timestamp";
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) text += std::string(",") + kNames[i] + "_" + kNames[j];
  for (const OdometryPose& pose : trajectory) {
    text += formatted("\n%" PRId64 ".%09" PRId64, pose.t_ns / 1000000000, pose.t_ns % 1000000000);
    const PoseCovariance covariance = toEulerCovariance(covarianceOf(pose), pose.T_w_b.q);
    for (int i = 0; i < 6; ++i)
      for (int j = i; j < 6; ++j) text += formatted(",%.9e", covariance(i, j));
  }
  return text + "\n";
}

}  // namespace lintel
