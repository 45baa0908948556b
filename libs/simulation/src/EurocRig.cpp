// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/EurocRig.h"

namespace lintel {

Rig eurocRig() {
  Rig rig;
  rig.camera = {752, 480, 458.654, 457.296, 367.215, 248.375, -0.28340811, 0.07395907, 0.00019359, 1.76187114e-05};
  Eigen::Matrix4d T_b_c;
  T_b_c << 0.0148655429818, -0.999880929698, 0.00414029679422, -0.0216401454975,  //
      0.999557249008, 0.0149672133247, 0.025715529948, -0.064676986768,           //
      -0.0257744366974, 0.00375618835797, 0.999660727178, 0.00981073058949,       //
      0, 0, 0, 1;
  rig.T_b_c = poseFromMatrix(T_b_c);
  return rig;
}

Camera lensCamera(LensModel model) {
  switch (model) {
    case LensModel::kRational:
      return {752, 480, 458.654, 457.296, 367.215, 248.375, {-0.2, 0.04, 2e-4, 2e-5, 0, 0.08, 0.02, 0}, model};
    case LensModel::kEquidistant:  // the coefficients of TUM-VI's cam0, 166 x 107 degrees
      return {752, 480, 259.7, 259.4, 372.3, 243.1, {0.0034824, 0.000715, -0.0020532, 0.00020294}, model};
    case LensModel::kDoubleSphere:  // much the same lens
      return {752, 480, 214.1, 213.9, 372.3, 243.1, {-0.1755, 0.5929}, model};
    case LensModel::kExtendedUnified:
      return {752, 480, 259.7, 259.4, 372.3, 243.1, {0.63, 1.04}, model};
    default:
      return eurocRig().camera;
  }
}

}  // namespace lintel
