// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "BoxIndex.h"
#include "lintel/evaluation/LineErrors.h"

namespace lintel {

/// Middles of the pieces of about `step_m` that a segment is cut into, at least one.
std::vector<Eigen::Vector3d> piecesOf(const Segment3& segment, double step_m);

/// How a segment of the map corresponds to the true edges.
struct LineMatch {
  std::vector<double>
      distances_m;  ///< of every piece to the nearest edge of about its direction; infinite if none is near
  std::optional<std::size_t> edge;  ///< index of the edge that the segment is matched to
};

/// The edges' boxes, in their order.
BoxIndex indexOf(const std::vector<TrueLine>& truth);

/// `index` is that of `truth`.
LineMatch matchLine(const Segment3& segment_w, const std::vector<TrueLine>& truth, const BoxIndex& index,
                    const LineErrorParams& params);

}  // namespace lintel
