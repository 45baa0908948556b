// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "lintel/estimator/WindowUpdate.h"

namespace lintel {

/// Watches the standard deviation that the estimate gives its positions. Where images show too few points for a long
/// time it grows to metres, and nothing contradicts what the IMU makes up.
class SigmaCheck {
 public:
  void add(const WindowUpdate& update);

  /// The largest standard deviation of a position, over what is allowed after the way until there and for the distance
  /// of what is seen; without what is gained while the images show nothing, which is said elsewhere.
  double worst() const { return worst_; }

  /// How far positions are unknown; empty: not too far.
  std::string fault() const;

 private:
  struct Last {
    Eigen::Vector3d p_w_b;
    double variance;
    bool blind;
  };

  std::optional<Last> last_;
  double gained_ = 0;  ///< variance [m^2]
  double way_m_ = 0, worst_ = 0, worst_sigma_m_ = 0, worst_way_m_ = 0;
};

}  // namespace lintel
