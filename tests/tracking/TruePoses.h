// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lintel/geometry/Pose.h"

namespace lintel::truth {

/// The true poses of a recording at any time.
class TruePoses {
 public:
  explicit TruePoses(const std::string& recording);

  bool empty() const { return poses_.size() < 2; }

  /// T_w_b, interpolated; up to 6 ms beyond the first and last pose as there, further on none.
  std::optional<Pose> at(std::int64_t t_ns) const;

 private:
  std::vector<std::pair<std::int64_t, Pose>> poses_;  ///< T_w_b, ascending
};

}  // namespace lintel::truth
