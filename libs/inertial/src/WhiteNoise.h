// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "lintel/core/Frame.h"

namespace lintel {

/// Largest ratio of densities that count as one: over two seconds at 200 Hz those of white noise differ by a tenth by
/// chance.
constexpr double kWhiteSpread = 1.25;

/// The density of white noise in `values` (a member of the samples), given `of_samples`, the density that single
/// samples show; empty where means of two and of four samples show another one: there is vibration or motion, or the
/// sensor has a filter.
std::optional<double> whiteDensity(const std::deque<ImuSample>& samples, Eigen::Vector3d ImuSample::*values,
                                   double of_samples, double period_s);

}  // namespace lintel
