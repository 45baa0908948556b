// SPDX-License-Identifier: BSD-3-Clause
// A measuring program, not a test: the solver's Cholesky factorisation against Eigen's on the equations of a full
// window. Not built by default:
//
//   ninja -C build/release cholesky_benchmark && build/release/libs/estimator/cholesky_benchmark
//
// Prints the median CPU time of each, in turn, and their largest difference.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

#include "TestWindow.h"
#include "landmarks/LineTriangulation.h"
#include "landmarks/PointTriangulation.h"
#include "solver/ReducedSystem.h"
#include "solver/SparseCholesky.h"
#include "window/WindowFactors.h"
#include "window/WindowMarginalization.h"

using namespace lintel;

namespace {

/// The equations of a window in flight, prior of a frame that has left included, with the solver's first damping.
Eigen::MatrixXd windowEquations() {
  const EstimatorParams params;
  TrackSimulationParams tracks;
  tracks.duration_s = 4;
  tracks.point_noise_px = tracks.line_noise_px = 0.5;
  const auto frames = static_cast<std::size_t>(params.keyframes) + 2;
  SlidingWindow window = test::trueWindow(test::fly(ImuSimulatorParams{}, tracks), 10, frames);
  triangulatePoints(window, params.landmarks, 1);
  triangulateLines(window, params);
  marginaliseOldest(window, params);
  window.removeFrame(window.frames.front().id, true);
  WindowFactors factors(window, params.factors);
  factors.addAll(params, window.T_b_c());
  ReducedSystem system(window, factors.factors(), {}, {});
  system.linearise();
  Eigen::MatrixXd H = system.eliminate().H;
  H.diagonal() *= 1 + 1e-4;
  return H;
}

double cpu_us() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

/// CPU time of factorising a copy of H [us].
template <class Factorise>
double timeOf(const Eigen::MatrixXd& H, Eigen::MatrixXd& L, Factorise&& factorise) {
  L = H;
  const double start = cpu_us();
  if (!factorise(L)) std::puts("not positive definite");
  return cpu_us() - start;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

bool factoriseWithEigen(Eigen::MatrixXd& H) {
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> llt(H);
  return llt.info() == Eigen::Success;
}

}  // namespace

int main() {
  const Eigen::MatrixXd H = windowEquations();
  Eigen::MatrixXd own, eigen;
  std::vector<double> own_us, eigen_us;
  for (int k = 0; k < 2001; ++k) {
    own_us.push_back(timeOf(H, own, factoriseSparse));
    eigen_us.push_back(timeOf(H, eigen, factoriseWithEigen));
  }
  // rows by their lengths: entries differ by many orders of magnitude with their units
  const Eigen::MatrixXd difference = H.diagonal().cwiseSqrt().cwiseInverse().asDiagonal() *
                                     Eigen::MatrixXd((own - eigen).triangularView<Eigen::Lower>());
  const auto zeros =
      (H.triangularView<Eigen::Lower>().toDenseMatrix().array() == 0).count() - H.rows() * (H.rows() - 1) / 2;
  std::printf("unknowns %ld, zeros in the lower triangle %.0f %%\n", static_cast<long>(H.rows()),
              100.0 * static_cast<double>(zeros) / (0.5 * static_cast<double>(H.rows() * (H.rows() + 1))));
  std::printf("SparseCholesky %.0f us, Eigen::LLT %.0f us, medians of %zu\n", median(own_us), median(eigen_us),
              own_us.size());
  std::printf("largest difference of an entry, relative to the length of its row: %.1e\n",
              difference.cwiseAbs().maxCoeff());
}
