// SPDX-License-Identifier: BSD-3-Clause
#include "solver/CameraPairs.h"

#include "lintel/core/ForAvx2.h"

namespace lintel {

namespace {

constexpr int N = kCameraTangent;

struct Pairs {
  const CameraRows* J;
  const double* information;
  const Eigen::Index* places;
  std::ptrdiff_t count;
};

LINTEL_FOR_AVX2_TOO void add(Pairs pairs, double* __restrict H, std::ptrdiff_t rows) {
  for (std::ptrdiff_t j = 0; j < pairs.count; ++j)
    for (std::ptrdiff_t i = j; i < pairs.count; ++i) {
      const double weight = pairs.information[i + j * pairs.count];
      if (weight == 0) continue;
      const double *Ji = pairs.J[i].data(), *Jj = pairs.J[j].data();
      for (int c = 0; c < N; ++c) {
        const double first = weight * Jj[c], second = weight * Jj[N + c];
        double* column = H + pairs.places[i] + (pairs.places[j] + c) * rows;
        for (int r = 0; r < N; ++r) column[r] += Ji[r] * first + Ji[N + r] * second;
      }
    }
}

}  // namespace

void addCameraPairs(const std::vector<CameraRows>& J, const std::vector<double>& information,
                    const std::vector<Eigen::Index>& places, Eigen::MatrixXd& H) {
  add({J.data(), information.data(), places.data(), static_cast<std::ptrdiff_t>(J.size())}, H.data(), H.rows());
}

}  // namespace lintel
