// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/TrackNoise.h"

#include <cmath>

namespace lintel {

std::vector<NoiseKind> kindsAbout(const NoiseKind& typical) {
  if (typical.walk == 0) return {typical};
  constexpr double kRatio = 4;
  return {{typical.white, typical.walk / kRatio}, typical, {typical.white, typical.walk * kRatio}};
}

double whiten(const NoiseKind& kind, const std::vector<double>& t_s, Eigen::Ref<Eigen::MatrixXd> errors) {
  const double white = kind.white * kind.white, walk = kind.walk * kind.walk;
  Eigen::RowVectorXd slid = Eigen::RowVectorXd::Zero(errors.cols());  // the walk's value as known before an observation
  double variance = 0, log_det = 0;
  for (Eigen::Index i = 0; i < errors.rows(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (i > 0) variance += walk * (t_s[at] - t_s[at - 1]);
    const double sigma = std::sqrt(variance + white), gain = variance / sigma;
    errors.row(i) = (errors.row(i) - slid) / sigma;
    slid += gain * errors.row(i);
    variance -= gain * gain;
    log_det += std::log(sigma);
  }
  return log_det;
}

Eigen::MatrixXd whitener(const NoiseKind& kind, const std::vector<double>& t_s) {
  const auto n = static_cast<Eigen::Index>(t_s.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Identity(n, n);
  whiten(kind, t_s, result);
  return result;
}

}  // namespace lintel
