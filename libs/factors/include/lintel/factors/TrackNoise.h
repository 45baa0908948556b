// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

namespace lintel {

/// The errors of a track's observations, a point's or a line's, in units of its factors' residuals. Each is the sum of
/// white noise and of a random walk: what is tracked slides on the surface as the view of it changes, and errors of the
/// calibration change with the place in the image. So observations at nearly the same time agree much better than
/// those far apart.
struct TrackNoise {
  double white = 1;                                          ///< standard deviation of the white noise
  double walk = 0;                                           ///< of the walk's change in a second
  double freedom = std::numeric_limits<double>::infinity();  ///< of the variance of all of it (TrackLoss)
};

/// L^-1 of the covariance L L' = white^2 I + walk^2 min(t_i, t_j) of a track's errors in one coordinate, times from the
/// first observation on. It makes residuals independent: each is what an observation says beyond those before it.
/// `t_s`: times of the observations [s], ascending.
Eigen::MatrixXd whitener(const TrackNoise& noise, const std::vector<double>& t_s);

}  // namespace lintel
