// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <vector>

namespace lintel {

/// What the errors of a track's observations may be, a point's or a line's, in units of its factors' residuals: the sum
/// of white noise and of a random walk. What is tracked slides on the surface as the view of it changes, and errors of
/// the calibration change with the place in the image; so observations at nearly the same time agree much better than
/// those far apart.
struct NoiseKind {
  double white = 1;  ///< standard deviation of the white noise
  double walk = 0;   ///< of the walk's change in a second
};

/// Tracks differ: one on a printed corner hardly slides, one where edges at different depths cross slides by pixels.
/// Each track is of one of these kinds, its residuals show which (LandmarkBlock).
struct TrackNoise {
  std::vector<NoiseKind> kinds{NoiseKind{}};
  double freedom = std::numeric_limits<double>::infinity();  ///< of the variance of all of it (TrackLoss)
};

/// Independent errors of unit variance.
inline const TrackNoise kWhiteNoise;

/// The typical kind, and those of which the walk is a fourth and four times as large.
std::vector<NoiseKind> kindsAbout(const NoiseKind& typical);

/// L^-1 of L L' = white^2 I + walk^2 min(t_i, t_j), the covariance of a track's errors in one coordinate, times from
/// the first observation on: what each observation says beyond those before it, as a Kalman filter's innovations over
/// their standard deviations. Matrices have a row an observation, and lie by rows.
class Whitener {
 public:
  Whitener() = default;

  /// `t_s`: times of the observations [s], ascending.
  Whitener(const NoiseKind& kind, const std::vector<double>& t_s);

  std::size_t size() const { return observations_.size(); }

  /// log det L.
  double logDeterminant() const { return log_det_; }

  /// m <- L^-1 m.
  void whiten(double* m, int columns) const;

  /// m <- L^-T m.
  void whitenTransposed(double* m, int columns) const;

  /// L^-T diag(weights) L^-1, size() rows and columns, in `result`.
  void information(const double* weights, std::vector<double>& result) const;

  /// Of the filter whose state is the walk: 1 / the innovation's standard deviation, and what an innovation of one such
  /// moves the state by.
  struct Observation {
    double inverse_sigma, gain;
  };

 private:
  std::vector<Observation> observations_;
  double log_det_ = 0;
};

}  // namespace lintel
