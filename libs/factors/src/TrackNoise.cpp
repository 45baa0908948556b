// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/factors/TrackNoise.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace lintel {

Eigen::MatrixXd whitener(const TrackNoise& noise, const std::vector<double>& t_s) {
  const auto n = static_cast<Eigen::Index>(t_s.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Identity(n, n);
  if (noise.walk == 0) return result / noise.white;
  Eigen::MatrixXd covariance = noise.white * noise.white * result;
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      covariance(i, j) += noise.walk * noise.walk * (t_s[static_cast<std::size_t>(std::min(i, j))] - t_s.front());
  covariance.llt().matrixL().solveInPlace(result);
  return result;
}

}  // namespace lintel
