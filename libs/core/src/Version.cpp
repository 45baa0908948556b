// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/core/Version.h"

namespace lintel {

const char* version() { return LINTEL_VERSION; }

}  // namespace lintel
