// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "lintel/testing/TempFolder.h"

namespace lintel::test {

/// What a program run in process said.
struct ProgramRun {
  int exit_code = -1;
  std::string out, err;
};

ProgramRun runVio(const std::vector<std::string>& arguments);
ProgramRun runMap(const std::vector<std::string>& arguments);
ProgramRun runConverter(const std::vector<std::string>& arguments);

/// share/lintel/config/euroc.yaml of the source tree.
std::string eurocConfig();

}  // namespace lintel::test
