// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace lintel {

/// How patches are followed.
struct PatchFlowParams {
  int window_px = 13;        ///< side of a patch
  int levels = 1;            ///< of the pyramid, from full resolution on; fewer when there are not so many
  int max_iterations = 20;   ///< per level
  double settled_px = 0.01;  ///< a smaller step ends a level
  double min_texture =
      0.1;  ///< a patch with a smaller eigenvalue of its mean structure tensor is lost [grey levels^2/px^2]
};

constexpr float kLeastContrast = 0.125f;  ///< of a patch's contrast that it must still have, and most times as much

/// Follows patches of one image into another: iterative Lucas-Kanade, from coarse to fine [Bouguet2001], whatever the
/// brightness and contrast of each patch become (linear appearance variation, [Baker2003]). Gradients come from the
/// patch itself, so that no derivative image is needed, and of the images only what the patches cover is touched.
///
/// `from`, `to`: levels of the pyramids, each the half of the one before, with at least patchBorder(window_px) readable
/// pixels around. `px`: centres in `from`. `moved`: guesses of where they are in `to`; on return where they were found.
/// Returns 1 for each patch that was followed to the finest level; 0 where it left the image, has no texture, or
/// what it became has next to no contrast (or a great deal more).
std::vector<unsigned char> followPatches(const std::vector<cv::Mat>& from, const std::vector<cv::Mat>& to,
                                         const std::vector<cv::Point2f>& px, const PatchFlowParams& params,
                                         std::vector<cv::Point2f>& moved);

/// Pixels around an image that followPatches() may read.
int patchBorder(int window_px);

}  // namespace lintel
