// SPDX-License-Identifier: BSD-3-Clause
#include "VioTestRuns.h"

#include <sstream>

#include "lintel/programs/Euroc2Rawlog.h"
#include "lintel/programs/LintelMap.h"
#include "lintel/programs/LintelVio.h"

namespace lintel::test {

namespace {

using Program = int (*)(int, const char* const*, std::ostream&, std::ostream&);

ProgramRun runProgram(Program program, const char* name, const std::vector<std::string>& arguments) {
  std::vector<const char*> argv{name};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  std::ostringstream out, err;
  ProgramRun run;
  run.exit_code = program(static_cast<int>(argv.size()), argv.data(), out, err);
  run.out = out.str();
  run.err = err.str();
  return run;
}

}  // namespace

ProgramRun runVio(const std::vector<std::string>& arguments) {
  return runProgram(runLintelVio, "lintel-vio", arguments);
}

ProgramRun runMap(const std::vector<std::string>& arguments) {
  return runProgram(runLintelMap, "lintel-map", arguments);
}

ProgramRun runConverter(const std::vector<std::string>& arguments) {
  return runProgram(runEuroc2Rawlog, "euroc2rawlog", arguments);
}

std::string eurocConfig() { return LINTEL_SOURCE_DIR "/share/lintel/config/euroc.yaml"; }

}  // namespace lintel::test
