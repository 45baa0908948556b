// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "lintel/core/Frame.h"
#include "lintel/simulation/ImageRenderer.h"
#include "lintel/simulation/Trajectory.h"

namespace lintel {

/// What a real camera does to the light.
struct CameraSensorParams {
  double noise =
      1;  ///< scales read noise (1 grey level) and shot noise (0.01 grey levels of variance per level); 0 = none
  double exposure_time_s = 0;  ///< motion blur; 0 = none. Centred on the frame's stamp
  double line_delay_s = 0;     ///< rolling shutter: from row to row; the stamp is that of the middle row [s]
  double exposure_change = 0;  ///< slow changes of the gain, standard deviation of its logarithm
  double vignetting = 0;       ///< darkening in the corners, 0 to 1
  std::uint64_t seed = 1;

  template <class F>
  void fields(F&& field) {
    field("noise", noise);
    field("exposure_time_s", exposure_time_s);
    field("line_delay_s", line_delay_s);
    field("exposure_change", exposure_change);
    field("vignetting", vignetting);
    field("seed", seed);
  }
};

/// Takes pictures along a trajectory. Each depends on its time only: any number of threads gives the same bytes.
class CameraSensor {
 public:
  CameraSensor(const ImageRenderer& renderer, const Camera& camera, const Pose& T_b_c,
               const CameraSensorParams& params);

  /// The picture at trajectory time `t_s`.
  GrayImage take(const Trajectory& trajectory, double t_s) const;

 private:
  Radiance expose(const Trajectory& trajectory, double t_s) const;
  double gain(double t_s) const;

  const ImageRenderer& renderer_;
  Camera camera_;
  Pose T_b_c_;
  CameraSensorParams params_;
  std::vector<float> gaussians_, vignette_;
};

}  // namespace lintel
