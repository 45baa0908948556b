// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace lintel {

/// The version of Lintel that this is: "major.minor.patch".
const char* version();

}  // namespace lintel
