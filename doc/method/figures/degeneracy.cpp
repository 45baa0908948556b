// SPDX-License-Identifier: BSD-3-Clause
// degeneracy: how well a line is known, as the estimator computes it (LineFactor, LineDegeneracy), over the geometry of
// motion and line. Data of the figures in doc/method/degeneracy.md: blocks of columns for gnuplot, on standard output.
//
// A camera flies along its x axis and looks along z, ten images in all. The line is 5 m away; 1 px noise at a focal
// length of 458 px; 1.2 m of it are seen.
#include <cmath>
#include <cstdio>

#include "LineDegeneracy.h"
#include "lintel/factors/LineFactor.h"
#include "lintel/factors/Manifolds.h"

namespace {

using namespace lintel;

constexpr int kImages = 10;
constexpr double kFocal_px = 458, kDepth_m = 5, kHalfLength_m = 0.6, kDegree = M_PI / 180;

/// `baseline_m` along x; `sideways_m`: how far the path swings out along y; the line's middle and direction.
LineUncertainty uncertainty(double baseline_m, double sideways_m, const Eigen::Vector3d& middle,
                            const Eigen::Vector3d& direction) {
  const Eigen::Vector3d ends[2] = {middle - kHalfLength_m * direction, middle + kHalfLength_m * direction};
  const Eigen::Vector3d origin_w = middle + Eigen::Vector3d(0.3, -0.4, 0.2);  // near the line, as in the estimator
  const LineBlock line = toBlock(toOrthonormal(movedOrigin(lineThrough(ends[0], ends[1]), origin_w)));
  const PoseBlock extrinsics = toBlock(Pose());
  const CorrectionBlock correction = CorrectionBlock::Zero();
  RowMajorMatrix plus(kLineSize, kLineTangent);
  LineManifold().PlusJacobian(line.data(), plus.data());
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  for (int i = 0; i < kImages; ++i) {
    const double s = static_cast<double>(i) / (kImages - 1);
    Pose T_w_b;
    T_w_b.p = {baseline_m * (s - 0.5), sideways_m * std::sin(M_PI * s), 0};
    NormalisedObservation seen[2];
    for (int k = 0; k < 2; ++k) seen[k].position = (ends[k] - T_w_b.p).hnormalized();
    const LineFactor factor(seen[0], seen[1], FrameMotion(), origin_w, kFocal_px);
    const PoseBlock pose = toBlock(T_w_b);
    const double* blocks[] = {pose.data(), extrinsics.data(), correction.data(), line.data()};
    Eigen::Vector2d r;
    Eigen::Matrix<double, 2, kLineSize, Eigen::RowMajor> J;
    double* jacobians[] = {nullptr, nullptr, nullptr, J.data()};
    factor.Evaluate(blocks, r.data(), jacobians);
    information += (J * plus).transpose() * (J * plus);
  }
  const OrthonormalLine orthonormal = lineFromBlock(line.data());
  const PluckerLine plucker = orthonormal.plucker();
  const double along_m = (middle - origin_w - plucker.nearestPoint()).dot(plucker.d.normalized());
  return uncertaintyOf(orthonormal, information, along_m);
}

/// Turns out of the plane through baseline and line by `angle`.
Eigen::Vector3d turned(double angle) { return {std::cos(angle), std::sin(angle), 0}; }

}  // namespace

int main() {
  const Eigen::Vector3d middle(0, 0, kDepth_m);
  for (const double baseline_m : {0.2, 0.5, 1.0}) {
    std::printf("# baseline %.1f m: angle to the plane of degenerate lines [deg], direction [rad], distance [m]\n",
                baseline_m);
    for (double angle = 0.5; angle <= 60; angle *= 1.05) {
      const LineUncertainty u = uncertainty(baseline_m, 0, middle, turned(angle * kDegree));
      std::printf("%.3f %.6g %.6g\n", angle, u.direction_rad, u.distance_m);
    }
    std::printf("\n\n");
  }
  // a strut in the plane of the baseline, not parallel to it, and a line along the motion; the path swings out
  for (const double slope : {0.0, 40.0}) {
    std::printf("# line in the plane of the baseline, %.0f deg to it: swing [m], direction [rad], distance [m]\n",
                slope);
    const Eigen::Vector3d direction(std::cos(slope * kDegree), 0, std::sin(slope * kDegree));
    for (double swing = 0.002; swing <= 0.5; swing *= 1.08) {
      const LineUncertainty u = uncertainty(1.0, swing, middle, direction);
      std::printf("%.4f %.6g %.6g\n", swing, u.direction_rad, u.distance_m);
    }
    std::printf("\n\n");
  }
}
