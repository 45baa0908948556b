// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/LineFactor.h"

#include <cmath>

#include "lintel/factors/LineDistances.h"
#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

/// Of lines from cameras that see them. Where a few views hardly determine a line, that it passes through one of the
/// cameras would explain this one's view whatever it shows.
constexpr double kNearest_m = 0.05;

}  // namespace

LineAxes::LineAxes(const double* block) {
  const OrthonormalLine line = lineFromBlock(block);
  U = line.U.toRotationMatrix();
  cosine = std::cos(line.phi);
  sine = std::sin(line.phi);
  n_w = cosine * U.col(0);
  d_w = sine * U.col(1);
}

void LineResidual::linearise(const CameraView& view, const double* correction, const LineAxes& line, bool jacobians,
                             LineLinearisation& out) const {
  const auto& [U, cosine, sine, n_w, d_w] = line;
  const Eigen::Vector3d from_camera_w = origin_w - view.p_w_c;
  const Eigen::Vector3d l = view.R_c_w * (n_w + from_camera_w.cross(d_w));  // moment about the camera, its axes
  const Eigen::Vector3d ends[2] = {start.corrected(correction), end.corrected(correction)};
  const LineDistances distances(ends, l, 1, start.wide, kNearest_m * sine);
  const Eigen::Vector2d scale = weight * Eigen::Vector2d(start.scale_px(correction), end.scale_px(correction));
  out.residual = scale.cwiseProduct(distances.residual);
  const double readout_s = correction[kReadoutAt];
  const Eigen::Vector2d delay_s(start_row.delay_s(readout_s), end_row.delay_s(readout_s));
  if (!jacobians && delay_s.isZero(0)) return;

  Eigen::Matrix<double, 2, 3> d_l;
  d_l << scale[0] * distances.d_l[0], scale[1] * distances.d_l[1];
  const Eigen::Matrix<double, 2, 3> d_nw = d_l * view.R_c_w;
  out.d_camera.leftCols<3>() = d_nw * skew(d_w);
  out.d_camera.rightCols<3>() = d_l * skew(l);
  const Eigen::Vector2d d_time = out.d_camera * view.d_offset;
  out.residual += delay_s.cwiseProduct(d_time);
  if (!jacobians) return;

  out.d_correction.col(kReadoutAt) = Eigen::Vector2d(start_row.share, end_row.share).cwiseProduct(d_time);
  const LineEnd* seen[] = {&start, &end};
  for (int k = 0; k < 2; ++k) {
    out.d_correction.row(k).head<kIntrinsicsSize>() =
        seen[k]->alongJacobian(scale[k] * distances.normal) +
        weight * seen[k]->linearised_scale_px * distances.residual[k] * seen[k]->log_scale_jacobian;
  }
  const Eigen::Matrix<double, 2, 3> d_dw = d_nw * skew(from_camera_w);
  // u1 and u2 turn with U: d(U e) = -U [e]x dpsi
  const Eigen::Matrix<double, 2, 3> nU = cosine * d_nw * U, dU = sine * d_dw * U;
  out.d_target.col(0) = dU.col(2);
  out.d_target.col(1) = -nU.col(2);
  out.d_target.col(2) = nU.col(1) - dU.col(0);
  out.d_target.col(3) = -sine * d_nw * U.col(0) + cosine * d_dw * U.col(1);
  if (distances.near) out.d_target.col(3) -= cosine / sine * scale.cwiseProduct(distances.residual);
}

}  // namespace lintel
