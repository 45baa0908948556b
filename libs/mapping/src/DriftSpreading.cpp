// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/mapping/DriftSpreading.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>

#include "lintel/geometry/Rotation.h"
#include "lintel/mapping/KeyframeCameras.h"

namespace lintel {

namespace {

constexpr double kLarge_m = 0.1, kLarge_rad = 0.03, kLargeShare = 0.1;   // contradictions that are spread
constexpr double kSighting_m = 0.05, kSighting_rad = 0.01;               // standard deviations
constexpr double kStepShare = 0.01, kStep_m = 0.002, kStep_rad = 0.001;  // of the odometry, from keyframe to keyframe
constexpr double kBlind_m_s = 1, kBlind_rad_s = 0.005;                   // where the IMU alone carried it
constexpr double kLossWidths[] = {100, 10, 3};

/// How a keyframe's surroundings move: turned about it by `values[3]`, then shifted.
constexpr int kSize = 4;

template <class T>
Eigen::Matrix<T, 3, 1> movedBy(const T* values, const Eigen::Vector3d& centre, const Eigen::Vector3d& p) {
  const Eigen::Vector3d d = p - centre;
  const T c = cos(values[3]), s = sin(values[3]);
  return {c * d.x() - s * d.y() + centre.x() + values[0], s * d.x() + c * d.y() + centre.y() + values[1],
          T(p.z()) + values[2]};
}

/// Two keyframes, a and b, want their points p_a and p_b at one place, and the same turn but for `turn`.
struct SamePlace {
  Eigen::Vector3d centre_a, p_a, centre_b, p_b;
  double turn = 0, sigma_m = 1, sigma_rad = 1;

  template <class T>
  bool operator()(const T* a, const T* b, T* residual) const {
    const Eigen::Matrix<T, 3, 1> apart = movedBy(a, centre_a, p_a) - movedBy(b, centre_b, p_b);
    for (int i = 0; i < 3; ++i) residual[i] = apart[i] / sigma_m;
    residual[3] = (a[3] + turn - b[3]) / sigma_rad;
    return true;
  }
};

class DriftGraph {
 public:
  DriftGraph(const std::vector<PlaceSighting>& sightings, MapMaterial& material)
      : sightings_(sightings), material_(material), values_(kSize * material.keyframes.size(), 0.0) {}

  void solve() {
    for (const double width : kLossWidths) solve(width);
  }

  void apply() const {
    std::vector<Pose> moves;
    for (std::size_t k = 0; k < material_.keyframes.size(); ++k) moves.push_back(correction(k));
    const KeyframeCameras cameras(material_);
    const auto moveOf = [&](FrameId id) { return moves[cameras.placeOf(id)]; };
    for (PointRecord& point : material_.points)
      if (!point.views.empty()) point.p_w = moveOf(point.views.front().keyframe) * point.p_w;
    for (LineRecord& line : material_.lines) {
      if (line.views.empty()) continue;
      const Pose T = moveOf(line.views.front().keyframe);
      line.estimate.middle_w = T * line.estimate.middle_w;
      line.estimate.direction_w = T.q * line.estimate.direction_w;
    }
    for (auto& [t_ns, T_w_b] : material_.trajectory) T_w_b = moves[keyframeAt(t_ns)] * T_w_b;
    for (std::size_t k = 0; k < moves.size(); ++k) {
      RetiredKeyframe& keyframe = material_.keyframes[k];
      keyframe.T_w_b = moves[k] * keyframe.T_w_b;
      keyframe.v_w_b = moves[k].q * keyframe.v_w_b;
    }
  }

 private:
  const Eigen::Vector3d& centre(std::size_t k) const { return material_.keyframes[k].T_w_b.p; }
  double* at(std::size_t k) { return values_.data() + kSize * k; }

  /// The last keyframe not after a time.
  std::size_t keyframeAt(std::int64_t t_ns) const {
    const auto& all = material_.keyframes;
    const auto after = std::upper_bound(all.begin(), all.end(), t_ns,
                                        [](std::int64_t t, const RetiredKeyframe& k) { return t < k.t_ns; });
    return after == all.begin() ? 0 : static_cast<std::size_t>(after - all.begin()) - 1;
  }

  Pose correction(std::size_t k) const {
    const double* v = values_.data() + kSize * k;
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(v[3], Eigen::Vector3d::UnitZ()));
    return {turn, centre(k) - turn * centre(k) + Eigen::Vector3d(v[0], v[1], v[2])};
  }

  bool isHeld(std::size_t k) const {
    if (k == 0) return true;
    if (material_.keyframes[k].imu) return false;
    if (material_.pieces.empty()) return true;
    const std::size_t piece = pieceOf(material_.pieces, material_.keyframes[k].id);
    return material_.pieces[piece].world == static_cast<int>(piece);
  }

  static void add(ceres::Problem& problem, const SamePlace& wish, double* a, double* b, ceres::LossFunction* loss) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<SamePlace, 4, kSize, kSize>(new SamePlace(wish)), loss, a,
                             b);
  }

  void addSteps(ceres::Problem& problem) {
    for (std::size_t k = 1; k < material_.keyframes.size(); ++k) {
      const RetiredKeyframe &before = material_.keyframes[k - 1], &here = material_.keyframes[k];
      if (!here.imu) continue;
      const double dt_s = 1e-9 * static_cast<double>(here.t_ns - before.t_ns);
      SamePlace wish{centre(k - 1), centre(k), centre(k), centre(k)};
      wish.sigma_m = kStep_m + kStepShare * (centre(k) - centre(k - 1)).norm() + (here.blind ? kBlind_m_s * dt_s : 0);
      wish.sigma_rad = kStep_rad + (here.blind ? kBlind_rad_s * dt_s : 0);
      add(problem, wish, at(k - 1), at(k), nullptr);
    }
  }

  void solve(double loss_width) {
    ceres::Problem problem;
    for (std::size_t k = 0; k < material_.keyframes.size(); ++k) {
      problem.AddParameterBlock(at(k), kSize);
      if (isHeld(k)) problem.SetParameterBlockConstant(at(k));
    }
    addSteps(problem);
    for (const PlaceSighting& seen : sightings_) {
      const std::size_t a = keyframeAt(seen.earlier_ns), b = keyframeAt(seen.later_ns);
      if (a == b) continue;
      SamePlace wish{centre(a), seen.T_w_c1.p, centre(b), seen.T_w_c0.p};
      wish.turn = yawOf(seen.T_w_c1.q * seen.T_w_c0.q.conjugate());
      wish.sigma_m = kSighting_m, wish.sigma_rad = kSighting_rad;
      add(problem, wish, at(a), at(b), new ceres::CauchyLoss(loss_width));
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.max_num_iterations = 20;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
  }

  const std::vector<PlaceSighting>& sightings_;
  MapMaterial& material_;
  std::vector<double> values_;
};

bool isLarge(const std::vector<PlaceSighting>& sightings) {
  const auto large = std::count_if(sightings.begin(), sightings.end(), [](const PlaceSighting& s) {
    return (s.T_w_c1.p - s.T_w_c0.p).norm() > kLarge_m || s.T_w_c1.q.angularDistance(s.T_w_c0.q) > kLarge_rad;
  });
  return static_cast<double>(large) > kLargeShare * static_cast<double>(sightings.size());
}

}  // namespace

bool spreadDrift(const std::vector<PlaceSighting>& sightings, MapMaterial& material) {
  if (!isLarge(sightings) || material.keyframes.size() < 3) return false;
  DriftGraph graph(sightings, material);
  graph.solve();
  graph.apply();
  return true;
}

}  // namespace lintel
