// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace lintel {

/// How large the errors of a recording's tracks are, in units of the configured noise: light, exposure and lens decide.
/// Found by the residuals of the tracks, each of which has a variance of its own (TrackLoss): their median says by how
/// much the common one is off.
class NoiseScale {
 public:
  /// `freedom`: of the tracks' own variances.
  explicit NoiseScale(double freedom);

  /// The tracks of a window, solved with the present scale: `mean_squares` of their whitened residuals for each degree
  /// of freedom. Windows overlap, and what changes does so within seconds: the median of each counts by its number of
  /// tracks, and is forgotten within kMemory windows. The order changes.
  void add(std::vector<double>& mean_squares);

  double scale() const { return scale_; }

 private:
  double median_;  // of the mean squares of many residuals each, where the scale is right
  double log_sum_ = 0, weight_;
  double scale_ = 1;
};

}  // namespace lintel
