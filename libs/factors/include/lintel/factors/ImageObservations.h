// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <utility>

#include "lintel/factors/StateBlocks.h"
#include "lintel/geometry/PinholeRadtan.h"

namespace lintel {

/// An image observation on the normalised plane and how it moves with the camera correction, about one correction.
struct NormalisedObservation {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< (x/z, y/z)
  ObservationJacobian correction_jacobian = ObservationJacobian::Zero();
  CorrectionBlock linearised_at = CorrectionBlock::Zero();

  /// The observation under a correction, to first order.
  Eigen::Vector2d corrected(const double* correction) const {
    return position + correction_jacobian * (Eigen::Map<const CorrectionBlock>(correction) - linearised_at);
  }
};

/// An observed end point of a line, and how many pixels a distance of 1 across the line is there. That scale moves with
/// the camera correction, too: with a constant one, distances on the normalised plane would be the smaller the longer
/// the focal length, and every line would pull at it.
struct LineEnd : NormalisedObservation {
  using Row = Eigen::Matrix<double, 1, kCorrectionSize>;
  double linearised_scale_px = 1;        ///< at `linearised_at`
  Row log_scale_jacobian = Row::Zero();  ///< d log scale / d correction

  /// Under a correction, to first order [px].
  double scale_px(const double* correction) const {
    return linearised_scale_px *
           (1 + log_scale_jacobian.dot(Eigen::Map<const CorrectionBlock>(correction) - linearised_at));
  }
};

/// How an observed pixel depends on the camera correction (intrinsics, by the camera model), about `correction`.
NormalisedObservation makeObservation(const PinholeRadtan& calibrated, const Eigen::Vector2d& px,
                                      const CorrectionBlock& correction = CorrectionBlock::Zero());

/// The two end points of an observed line [px]; their scales are across the line through both.
std::pair<LineEnd, LineEnd> makeLineEnds(const PinholeRadtan& calibrated, const Eigen::Vector2d& start_px,
                                         const Eigen::Vector2d& end_px,
                                         const CorrectionBlock& correction = CorrectionBlock::Zero());

}  // namespace lintel
