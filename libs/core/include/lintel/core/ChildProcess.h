// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace lintel {

/// A program to run. It is looked for in PATH when its name has no slash.
struct ChildRequest {
  std::vector<std::string> command;      ///< program and arguments, no shell between
  std::string input;                     ///< what it reads on standard input
  std::string log_path;                  ///< standard output and error are appended here; empty: both are returned
  std::vector<std::string> environment;  ///< NAME=VALUE, added to this process' own
  std::function<bool()> stop = {};       ///< asked while it runs, from this thread: true sends it SIGTERM; may be empty
};

struct ChildResult {
  int exit_code = 0;  ///< 127: could not be started; 128 + N: ended by signal N
  std::string output, errors;
  double cpu_s = 0, peak_memory_mb = 0;
};

/// Runs a program to its end. It is killed when the calling thread ends, however that happens: a killed program leaves
/// no children behind that go on writing. May be used from several threads at once. Throws std::runtime_error when the
/// system has no process or file left.
ChildResult runChild(const ChildRequest& request);

/// The words as a line for a POSIX shell.
std::string shellLine(const std::vector<std::string>& words);

}  // namespace lintel
