// SPDX-License-Identifier: BSD-3-Clause
#include "ParamsCheck.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace lintel {

namespace {

void require(bool ok, const std::string& name, double value, const std::string& range) {
  if (ok) return;
  std::ostringstream text;
  text << "estimator." << name << " = " << value << ", must be " << range;
  throw std::invalid_argument(text.str());
}

void requireOneOf(const std::string& name, const std::string& value, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), value) != known.end()) return;
  std::string list;
  for (const std::string& k : known) list += (list.empty() ? "" : ", ") + k;
  throw std::invalid_argument("estimator." + name + " = " + value + ", must be one of " + list);
}

/// Whatever a parameter means, it is finite and not negative; noises, losses and limits are not zero either.
class FieldCheck {
 public:
  explicit FieldCheck(std::string path) : path_(std::move(path)) {}

  template <class T>
  void operator()(const std::string& key, T& value) {
    if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, std::string>) {
      return;
    } else if constexpr (std::is_arithmetic_v<T>) {
      require(std::isfinite(static_cast<double>(value)) && value > 0, path_ + key, static_cast<double>(value),
              "greater than 0");
    } else {
      FieldCheck inner(path_ + key + ".");
      value.fields(inner);
    }
  }

 private:
  std::string path_;
};

}  // namespace

void checkParams(EstimatorParams params) {
  requireOneOf("degeneracy.lines", params.degeneracy.lines, {"use", "drop", "constrain"});
  requireOneOf("degeneracy.test", params.degeneracy.test, {"epipole", "observability", "both"});
  FieldCheck check("");
  params.fields(check);
  require(params.keyframes >= 4 && params.keyframes <= 100, "keyframes", params.keyframes, "from 4 to 100");
  require(params.landmarks.point_min_observations >= 2, "landmarks.point_min_observations",
          params.landmarks.point_min_observations, "at least 2");
  require(params.landmarks.line_min_observations >= 2, "landmarks.line_min_observations",
          params.landmarks.line_min_observations, "at least 2");
  require(params.initializer.min_frames >= 4, "initializer.min_frames", params.initializer.min_frames, "at least 4");
  require(params.initializer.max_frames >= params.initializer.min_frames, "initializer.max_frames",
          params.initializer.max_frames, "at least initializer.min_frames");
  require(params.landmarks.max_depth_m > params.landmarks.min_depth_m, "landmarks.max_depth_m",
          params.landmarks.max_depth_m, "greater than landmarks.min_depth_m");
}

}  // namespace lintel
