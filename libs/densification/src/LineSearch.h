// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "LineSupport.h"
#include "lintel/densification/DensifyParams.h"

namespace lintel {

/// What segment `s` of view `i` saw of the line in space that most images support: its plane is intersected with those
/// of the segments of the first `params.partners` views of `common`, and each line looked for in all of `common`. Empty
/// when none has enough support.
std::optional<Segment3> searchLine(const DensifyParams& params, const std::vector<SegmentView>& views,
                                   const std::vector<std::size_t>& common, std::size_t i, std::size_t s);

}  // namespace lintel
