// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <iosfwd>
#include <stdexcept>
#include <string>

namespace lintel {

/// A command line that makes no sense although each option alone does: exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Runs a program's body and returns its exit code. What the body throws becomes one line "name: what" on `err` and
/// exit code 2 (UsageError), 128 and the signal's number (Stopped) or 1 (anything else). Never throws.
int programMain(const std::string& name, std::ostream& err, const std::function<int()>& body);

/// `text` without line feeds and other control characters, for a message of one line.
std::string oneLine(std::string text);

}  // namespace lintel
