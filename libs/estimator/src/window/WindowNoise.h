// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/estimator/EstimatorParams.h"
#include "lintel/estimator/SlidingWindow.h"
#include "lintel/inertial/NoiseMeter.h"

namespace lintel {

/// The noise densities that a window's IMU samples are integrated with. Densities with a scale of 1 are those of the
/// rig checked against what the samples show (NoiseMeter.h); others are meant as they are given.
class WindowNoise {
 public:
  WindowNoise(const ImuNoise& given, const FactorParams& params) : given_(given), params_(params) {}

  /// Samples between two frames, as NoiseMeter takes them.
  void add(const ImuBatch& batch) { meter_.add(batch); }

  /// For samples that come now.
  ImuNoise now() const { return chosen(effectiveNoise(given_, meter_)); }

  /// That white noise is more than a data sheet says is known after some frames: those before get it as well.
  void raise(SlidingWindow& window) const;

 private:
  ImuNoise chosen(const ImuNoise& measured) const;

  ImuNoise given_;
  FactorParams params_;
  NoiseMeter meter_;
};

}  // namespace lintel
