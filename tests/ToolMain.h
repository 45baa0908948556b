// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <iostream>

namespace lintel {

/// main() of a measuring program: an error is one line with the program's name, and exit code 1.
inline int toolMain(const char* name, int (*run)(int argc, char** argv), int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << "\n";
    return 1;
  }
}

}  // namespace lintel
