// SPDX-License-Identifier: BSD-3-Clause
#include "SigmaCheck.h"

#include <algorithm>
#include <cmath>

#include "lintel/core/Formatted.h"

namespace lintel {

namespace {

// The scale of a start may be unknown to a tenth. Beside that a position may be unknown by 0.1 m, or, as from a drone
// at 50 m, by as much at the points' distance as 0.1 m are at 5 m: nine pixels of EuRoC's camera. Runs that last have
// at most 0.4 of all.
constexpr double kShareOfWay = 0.1, kAllowed_m = 0.1, kShareOfDistance = 0.02;

}  // namespace

void SigmaCheck::add(const WindowUpdate& update) {
  if (!update.hasPose()) return last_.reset();
  if (update.status != EstimatorStatus::kTracking) return;
  const Last now{update.T_w_b.p, update.covariance.topLeftCorner<3, 3>().trace(), update.blind};
  if (last_) {
    way_m_ += (now.p_w_b - last_->p_w_b).norm();
    if (!now.blind && !last_->blind) gained_ += std::max(0.0, now.variance - last_->variance);
  }
  last_ = now;
  const double allowed_m = kShareOfWay * way_m_ + std::max(kAllowed_m, kShareOfDistance * update.points_distance_m);
  const double sigma_m = std::sqrt(gained_), share = sigma_m / allowed_m;
  if (share <= worst_) return;
  worst_ = share;
  worst_sigma_m_ = sigma_m;
  worst_way_m_ = way_m_;
}

std::string SigmaCheck::fault() const {
  if (worst_ <= 1) return {};
  return formatted(
      "the images show too little: after a way of %.1f m the position is unknown by %.1f m (one standard "
      "deviation); show the camera more texture or a wider view, or leave this part out (--from, --to)",
      worst_way_m_, worst_sigma_m_);
}

}  // namespace lintel
