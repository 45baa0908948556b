// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "lintel/estimator/SlidingWindow.h"

namespace lintel {

/// How far solves have changed the scale since a start, against what the start said of it. A start with too little
/// motion, or with a wrong mounting that is taken for a bias, may be wrong by many of its sigmas; its prior then holds
/// the scale for long.
class ScaleDrift {
 public:
  /// `sigma`: relative, of the start.
  void start(double sigma);

  void beforeSolve(const SlidingWindow& window);
  void afterSolve(const SlidingWindow& window);

  /// Whether the scale has changed by what the start's sigma makes impossible.
  bool leftStart() const;

 private:
  double sigma_ = std::numeric_limits<double>::infinity();
  double log_change_ = 0;
  std::vector<Eigen::Vector3d> before_;  // positions of the frames
};

}  // namespace lintel
