// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "LineSupport.h"
#include "lintel/densification/DensifyParams.h"

namespace lintel {

/// A line in space that a segment of an image may be the picture of.
struct LineCandidate {
  Segment3 segment_w;  ///< what the segment saw of it
  double score = 0;    ///< what other images cover of it, summed up
  int supporters = 0;  ///< those images
};

/// The candidate that most images support, for segment `s` of view `i`: its plane is intersected with those of the
/// segments of the first `params.partners` views of `common`, and each line looked for in all of `common`. Empty when
/// none has enough support.
std::optional<LineCandidate> searchLine(const DensifyParams& params, const std::vector<SegmentView>& views,
                                        const std::vector<std::size_t>& common, std::size_t i, std::size_t s);

}  // namespace lintel
