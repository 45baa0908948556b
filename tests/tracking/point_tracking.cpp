// SPDX-License-Identifier: BSD-3-Clause
//
// point_tracking RECORDING [to_s]: how well points stay on what they follow. Every track is fitted with one place in
// the world, poses and camera as the recording's ground truth says; what is left is the tracker's error. White noise is
// the same at any age; drift grows with it.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <map>
#include <string>

#include "lintel/geometry/Pose.h"
#include "lintel/sensing/GroundTruth.h"
#include "lintel/sensing/Recording.h"
#include "lintel/tracking/FrontEnd.h"

namespace lintel {
namespace {

struct Sighting {
  Pose T_w_c;
  Eigen::Vector2d normalised;
};

Pose poseAt(const std::vector<std::pair<std::int64_t, Pose>>& truth, std::int64_t t_ns) {
  auto after =
      std::lower_bound(truth.begin(), truth.end(), t_ns, [](const auto& p, std::int64_t t) { return p.first < t; });
  if (after == truth.begin()) return after->second;
  if (after == truth.end()) return std::prev(after)->second;
  const auto before = std::prev(after);
  const double s = static_cast<double>(t_ns - before->first) / static_cast<double>(after->first - before->first);
  return {before->second.q.slerp(s, after->second.q), (1 - s) * before->second.p + s * after->second.p};
}

/// Residuals [px] at the best place; empty when it has no parallax to speak of.
std::vector<Eigen::Vector2d> residualsOf(const std::vector<Sighting>& track, double focal) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Sighting& s : track) {
    const Eigen::Vector3d ray = s.T_w_c.q * s.normalised.homogeneous().normalized();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - ray * ray.transpose();
    A += across;
    b += across * s.T_w_c.p;
  }
  Eigen::Vector3d p = A.ldlt().solve(b);
  std::vector<Eigen::Vector2d> r(track.size());
  for (int iteration = 0; iteration < 8; ++iteration) {
    Eigen::Matrix3d H = 1e-6 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < track.size(); ++i) {
      const Eigen::Vector3d c = track[i].T_w_c.inverse() * p;
      if (c.z() < 0.05) return {};
      r[i] = focal * (c.head<2>() / c.z() - track[i].normalised);
      Eigen::Matrix<double, 2, 3> J;
      J << 1 / c.z(), 0, -c.x() / (c.z() * c.z()), 0, 1 / c.z(), -c.y() / (c.z() * c.z());
      J = focal * J * track[i].T_w_c.R().transpose();
      const double w = 1 / (1 + r[i].squaredNorm());
      H += w * J.transpose() * J;
      g += w * J.transpose() * r[i];
    }
    p -= H.ldlt().solve(g);
  }
  return r;
}

double median(std::vector<double> v) {
  if (v.empty()) return 0;
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

int run(int argc, char** argv) {
  RecordingParams options;
  if (argc > 2) options.to_s = std::stod(argv[2]);
  const auto truth = readGroundTruth(argv[1]);
  auto recording = openRecording(argv[1], options);
  FrontEndParams params;
  params.features = "points";
  FrontEnd front_end(recording->rig(), params);
  const Pose T_b_c = recording->rig().T_b_c;
  std::map<TrackId, std::vector<Sighting>> tracks;
  while (const auto step = recording->next()) {
    const Pose T_w_c = poseAt(truth, step->frame.t_ns) * T_b_c;
    for (const PointObservation& p : front_end.process(step->frame, step->imu).points)
      tracks[p.id].push_back({T_w_c, p.normalised});
  }
  const double focal = recording->rig().camera.meanFocal();
  const std::size_t kinds[] = {10, 20, 40, 80, 160, 100000};
  for (int k = 0; k + 1 < 6; ++k) {
    std::vector<double> all, steps, ends;
    double correlated = 0, power = 0;
    int n = 0;
    for (const auto& [id, track] : tracks) {
      if (track.size() < kinds[k] || track.size() >= kinds[k + 1]) continue;
      const auto r = residualsOf(track, focal);
      if (r.empty()) continue;
      ++n;
      for (std::size_t i = 0; i < r.size(); ++i) all.push_back(r[i].norm());
      for (std::size_t i = 1; i < r.size(); ++i) {
        steps.push_back((r[i] - r[i - 1]).norm());
        if (r[i].norm() < 3 && r[i - 1].norm() < 3) correlated += r[i].dot(r[i - 1]), power += r[i].squaredNorm();
      }
    }
    std::printf(
        "tracks of %4zu and more frames: %5d  error median %.3f px  step median %.3f px  correlation of consecutive "
        "ones %.2f\n",
        kinds[k], n, median(all), median(steps), correlated / std::max(power, 1e-9));
  }
  return 0;
}

}  // namespace
}  // namespace lintel

int main(int argc, char** argv) {
  try {
    return lintel::run(argc, argv);
  } catch (const std::exception& e) {
    std::cerr << "point_tracking: " << e.what() << "\n";
    return 1;
  }
}
