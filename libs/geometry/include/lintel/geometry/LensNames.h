// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lintel/geometry/Camera.h"

namespace lintel {

/// A lens model in the words of calibration files.
struct LensName {
  const char* name;                       ///< as written: radial-tangential, rational, equidistant …
  std::vector<const char*> coefficients;  ///< in the order of Camera::lens
};
const LensName& lensName(LensModel model);

/// By any of its usual names (radtan, plumb_bob, equi, ds …); empty for others.
std::optional<LensModel> lensModel(const std::string& name);

/// The coefficients of a camera's lens; of radial-tangential ones four, five with k3.
std::vector<double> lensCoefficients(const Camera& camera);

/// Sets model and coefficients; false, and nothing done, when the model does not have so many. Radial-tangential: 4 or
/// 5, rational: 8, equidistant: 4, double-sphere and eucm: 2.
bool setLens(Camera& camera, LensModel model, const std::vector<double>& coefficients);

/// The same in words, for messages: "4 or 5".
const char* lensCoefficientCount(LensModel model);

}  // namespace lintel
