// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// How far solves change the scale, against what was said of it. A start with too little motion, or with a wrong
/// mounting that is taken for a bias, may be wrong by many of its sigmas, and so is a scale that comes from an
/// accelerometer with errors that last for seconds; a prior then holds the scale for long.
class ScaleDrift {
 public:
  /// `sigma`: relative, of the start.
  void start(double sigma);

  void beforeSolve(const SlidingWindow& window);
  void afterSolve(const SlidingWindow& window);

  /// Whether the scale has changed by what the start's sigma makes impossible.
  bool leftStart() const;

  /// By how much the logarithm of the scale has changed in the last seconds, where neither the sigma that was said then
  /// nor `sigma`, the present one, explains it; otherwise zero. A change is given once: the sigma said then is enlarged
  /// by it.
  double takeUnexplainedChange(double sigma);

 private:
  /// The solves since a sigma was said.
  struct Stretch {
    double sigma = std::numeric_limits<double>::infinity();  ///< relative
    double log_change = 0;
    int solves = 0;
  };

  Stretch since_start_, lately_;
  std::vector<Eigen::Vector3d> before_;  // positions of the frames
};

}  // namespace lintel
