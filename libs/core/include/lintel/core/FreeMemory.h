// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace lintel {

/// Gives memory that is free back to the system, between stages that need much of it: an allocator keeps hundreds of
/// megabytes, in pieces that the next stage cannot use.
void returnFreeMemory();

}  // namespace lintel
