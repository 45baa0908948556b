// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace lintel {

/// Name of a keyframe's image in a COLMAP model.
inline std::string colmapName(std::int64_t t_ns) { return std::to_string(t_ns) + ".png"; }

}  // namespace lintel
