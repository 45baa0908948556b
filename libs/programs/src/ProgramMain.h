// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <iosfwd>
#include <optional>
#include <stdexcept>
#include <string>

namespace CLI {
class App;
}

namespace lintel {

/// A command line that makes no sense although each option alone does: exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Runs a program's body and returns its exit code. What the body throws becomes one line "name: what" on `err` and
/// exit code 2 (UsageError) or 1 (anything else). Never throws.
int programMain(const std::string& name, std::ostream& err, const std::function<int()>& body);

/// Parses the command line with --version added. Empty if the program should go on; else its exit code: 0 after --help
/// or --version (printed to `out`), 2 after a wrong command line (one line on `err`).
std::optional<int> parseArguments(CLI::App& app, int argc, const char* const* argv, std::ostream& out,
                                  std::ostream& err);

}  // namespace lintel
