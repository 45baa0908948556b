// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "ImageLine.h"
#include "StepTranslation.h"

namespace lintel {

/// How far away a line's ends are, as inverse depths in the unit of StepTranslation. They predict how the line
/// moves when the camera moves: an edge that moves otherwise is another one, also where it is near in the image.
struct LineDepth {
  InverseDepth start, end;
  int epoch = 0;  ///< of StepTranslation
};

/// A line of the frame before where it should be now.
struct CarriedDepth {
  ImageLine line;
  LineDepth depth;                 ///< of the ends, seen from the new frame
  Eigen::Vector2d sigma_px{0, 0};  ///< of the ends across the line
};

/// Initial depth of a line: that of the points.
LineDepth assumedDepth(const StepTranslation& step);

/// `turned`: `line` moved by the rotation only.
CarriedDepth carry(const LineDepth& depth, const ImageLine& line, const ImageLine& turned,
                   const Eigen::Quaterniond& R_c1_c0, const Eigen::Vector3d& t_c1, double focal_px);

/// What is known after the line has been `seen`, its place known to `noise_px`; of the ends that are seen now.
LineDepth observe(const CarriedDepth& carried, const ImageLine& turned, const ImageLine& seen,
                  const Eigen::Vector3d& t_c1, double focal_px, double noise_px);

/// Depth of the ends of `to`, a stretch of the same line as `from`: inverse depth is linear along the image of a
/// straight line.
LineDepth alongLine(const LineDepth& depth, const ImageLine& from, const ImageLine& to);

}  // namespace lintel
