// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/core/FreeMemory.h"

#include <malloc.h>

extern "C" void mi_collect(bool force) __attribute__((weak));  // mimalloc's, where the program's malloc is that

namespace lintel {

void returnFreeMemory() {
  if (mi_collect)
    mi_collect(true);
  else
    malloc_trim(0);
}

}  // namespace lintel
