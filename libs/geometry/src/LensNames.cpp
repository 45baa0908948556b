// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/geometry/LensNames.h"

#include <algorithm>
#include <utility>

namespace lintel {

const LensName& lensName(LensModel model) {
  static const LensName names[] = {
      {"radial-tangential", {"k1", "k2", "p1", "p2", "k3"}},
      {"rational", {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"}},
      {"equidistant", {"k1", "k2", "k3", "k4"}},
      {"double-sphere", {"xi", "alpha"}},
      {"eucm", {"alpha", "beta"}},
  };
  return names[static_cast<int>(model)];
}

std::optional<LensModel> lensModel(const std::string& name) {
  static const std::pair<const char*, LensModel> names[] = {
      {"radial-tangential", LensModel::kRadialTangential},
      {"radtan", LensModel::kRadialTangential},
      {"plumb_bob", LensModel::kRadialTangential},
      {"rational", LensModel::kRational},
      {"rational_polynomial", LensModel::kRational},
      {"equidistant", LensModel::kEquidistant},
      {"equi", LensModel::kEquidistant},
      {"fisheye", LensModel::kEquidistant},
      {"kannala_brandt", LensModel::kEquidistant},
      {"double-sphere", LensModel::kDoubleSphere},
      {"ds", LensModel::kDoubleSphere},
      {"eucm", LensModel::kExtendedUnified},
  };
  for (const auto& [known, model] : names)
    if (name == known) return model;
  return std::nullopt;
}

std::vector<double> lensCoefficients(const Camera& camera) {
  std::size_t count = lensName(camera.model).coefficients.size();
  if (camera.model == LensModel::kRadialTangential && camera.lens[4] == 0) count = 4;
  return {camera.lens.begin(), camera.lens.begin() + static_cast<std::ptrdiff_t>(count)};
}

bool setLens(Camera& camera, LensModel model, const std::vector<double>& coefficients) {
  const std::size_t count = coefficients.size(), all = lensName(model).coefficients.size();
  if (count != all && !(model == LensModel::kRadialTangential && count == 4)) return false;
  camera.model = model;
  camera.lens = {};
  std::copy(coefficients.begin(), coefficients.end(), camera.lens.begin());
  return true;
}

const char* lensCoefficientCount(LensModel model) {
  switch (model) {
    case LensModel::kRadialTangential:
      return "4 or 5";
    case LensModel::kRational:
      return "8";
    case LensModel::kEquidistant:
      return "4";
    default:
      return "2";
  }
}

}  // namespace lintel
