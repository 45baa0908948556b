// SPDX-License-Identifier: BSD-3-Clause
#include "solver/PanelSquare.h"

#include "lintel/core/ForAvx2.h"

namespace lintel {

namespace {

struct Panel {
  const double* data;
  std::ptrdiff_t stride;
};

/// h -= p f' for the first `size` rows of p.
template <int T>
[[gnu::always_inline]] inline void subtractColumn(const Panel& P, const double* f, std::ptrdiff_t size,
                                                  double* __restrict h) {
  const double* __restrict p = P.data;
  for (std::ptrdiff_t i = 0; i < size; ++i) {
    double sum = p[i] * f[0];
    for (int k = 1; k < T; ++k) sum += p[i + k * P.stride] * f[k];
    h[i] -= sum;
  }
}

template <int T>
[[gnu::always_inline]] inline void subtract(const Panel& P, const RowRun* run, const RowRun* end, double* H,
                                            std::ptrdiff_t rows) {
  for (; run != end; ++run)
    for (std::ptrdiff_t j = 0; j < run->size; ++j) {
      double f[T];
      for (int k = 0; k < T; ++k) f[k] = P.data[run->from + j + k * P.stride];
      double* column = H + (run->to + j) * rows;
      subtractColumn<T>({P.data + run->from + j, P.stride}, f, run->size - j, column + run->to + j);
      for (const RowRun* below = run + 1; below != end; ++below)
        subtractColumn<T>({P.data + below->from, P.stride}, f, below->size, column + below->to);
    }
}

LINTEL_FOR_AVX2_TOO void subtract3(Panel P, const RowRun* run, const RowRun* end, double* H, std::ptrdiff_t rows) {
  subtract<3>(P, run, end, H, rows);
}
LINTEL_FOR_AVX2_TOO void subtract4(Panel P, const RowRun* run, const RowRun* end, double* H, std::ptrdiff_t rows) {
  subtract<4>(P, run, end, H, rows);
}
LINTEL_FOR_AVX2_TOO void subtract9(Panel P, const RowRun* run, const RowRun* end, double* H, std::ptrdiff_t rows) {
  subtract<9>(P, run, end, H, rows);
}

}  // namespace

void append(const RowRun& run, std::vector<RowRun>& runs) {
  if (!runs.empty() && runs.back().from + runs.back().size == run.from && runs.back().to + runs.back().size == run.to)
    runs.back().size += run.size;
  else
    runs.push_back(run);
}

template <int T>
void subtractSquare(const Eigen::Matrix<double, Eigen::Dynamic, T>& P, const std::vector<RowRun>& runs,
                    Eigen::MatrixXd& H) {
  const Panel panel{P.data(), P.rows()};
  const RowRun *begin = runs.data(), *end = begin + runs.size();
  if constexpr (T == 3) subtract3(panel, begin, end, H.data(), H.rows());
  if constexpr (T == 4) subtract4(panel, begin, end, H.data(), H.rows());
  if constexpr (T == 9) subtract9(panel, begin, end, H.data(), H.rows());
}

template void subtractSquare<3>(const Eigen::Matrix<double, Eigen::Dynamic, 3>&, const std::vector<RowRun>&,
                                Eigen::MatrixXd&);
template void subtractSquare<4>(const Eigen::Matrix<double, Eigen::Dynamic, 4>&, const std::vector<RowRun>&,
                                Eigen::MatrixXd&);
template void subtractSquare<9>(const Eigen::Matrix<double, Eigen::Dynamic, 9>&, const std::vector<RowRun>&,
                                Eigen::MatrixXd&);

}  // namespace lintel
