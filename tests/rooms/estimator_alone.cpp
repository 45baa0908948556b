// SPDX-License-Identifier: BSD-3-Clause
// A program that only uses the estimator: the test looks at the libraries it is linked with.
#include "lintel/estimator/Estimator.h"

int main() {
  lintel::Estimator estimator(lintel::Rig{}, lintel::EstimatorParams{});
  return estimator.process(lintel::FrameTracks{}, {}).hasPose() ? 1 : 0;
}
