// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/core/Frame.h"
#include "lintel/geometry/Camera.h"
#include "lintel/mapping/LineMap.h"

namespace lintel {

/// The pinhole camera without distortion that has the size, the principal point and, at the optical axis, the scale of
/// `camera`. Of a lens that bends lines outwards (a barrel, a fisheye) it sees less: no part of its image is empty.
Camera pinholeOf(const Camera& camera);

/// The map as pinholeOf() its camera would have seen it. Observations that lie outside its image are left out; a point
/// or a line keeps its place.
LineMap undistorted(LineMap map);

/// An image of `camera` as `pinhole` would have taken it, by linear interpolation; black where `camera` does not see.
class ImageUndistorter {
 public:
  ImageUndistorter(const Camera& camera, const Camera& pinhole);
  /// The image must have the camera's size. Throws std::invalid_argument.
  GrayImage operator()(const GrayImage& image) const;

 private:
  int width_, height_;                  ///< of images to be undistorted
  int to_width_, to_height_;            ///< of the pinhole's
  std::vector<float> from_x_, from_y_;  ///< where each of its pixels is seen [px], row by row
};

}  // namespace lintel
