// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/factors/ImageFactor.h"
#include "lintel/factors/ImageObservations.h"

namespace lintel {

/// Distances of the two observed end points to the projected infinite line, in pixels ([Lim2021] line residual,
/// [Bartoli2005]):
///
///   (n, d) = line block, moment about the constant world point `origin_w`
///   l = n_c = R_c_w (n + (origin_w - p_w_c) x d),    r_k = weight s_k x_k^T l / sqrt(l_1^2 + l_2^2),  k = start, end
///
/// with the rays x_k and s_k the pixels that a distance of 1 is there (LineEnd); of wide lenses |l| for the root. A
/// constant origin near the line keeps phi well conditioned far from the world's origin. The rows of the ends may have
/// been exposed at other times (RowTime), to first order.
struct LineResidual {
  const LineEnd &start, &end;
  const Eigen::Vector3d& origin_w;
  double weight;  ///< 1 / the sightings' standard deviation [px]
  RowTime start_row = {}, end_row = {};

  void linearise(const CameraView& view, const double* correction, const LineAxes& line, bool jacobians,
                 LineLinearisation& out) const;
};

/// LineResidual as a factor. Blocks: pose (T_w_b), extrinsics (T_b_c), correction, line.
class LineFactor final : public ImageFactor<LineTarget> {
 public:
  LineFactor(const LineEnd& start, const LineEnd& end, const FrameMotion& motion, const Eigen::Vector3d& origin_w,
             double sigma_px, const RowTime& start_row = {}, const RowTime& end_row = {})
      : ImageFactor(motion),
        start_(start),
        end_(end),
        origin_w_(origin_w),
        weight_(1 / sigma_px),
        start_row_(start_row),
        end_row_(end_row) {}
  void linearise(const CameraView& view, const double* correction, const LineAxes& line, bool jacobians,
                 LineLinearisation& out) const override {
    LineResidual{start_, end_, origin_w_, weight_, start_row_, end_row_}.linearise(view, correction, line, jacobians,
                                                                                   out);
  }

 private:
  LineEnd start_, end_;
  Eigen::Vector3d origin_w_;
  double weight_;
  RowTime start_row_, end_row_;
};

}  // namespace lintel
