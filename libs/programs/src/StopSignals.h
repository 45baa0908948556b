// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <csignal>
#include <stdexcept>
#include <string>

namespace lintel {

/// SIGINT, SIGTERM and SIGHUP as a wish to stop, while an object of the class lives: the first is noted and nothing
/// else, one that comes half a second later or more ends the program at once. Those in between are the same wish:
/// timeout(1) signals its program and then the program's group, and terminals and supervisors do the like. What was
/// ignored before (nohup) stays ignored. One object at a time.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Whether a signal has come. May be called from any thread.
  bool asked() const;
  /// Throws Stopped if one has come.
  void check() const;
  /// The name of the signal that has come, "SIGTERM".
  std::string name() const;
  /// 128 and the signal's number, as shells have it.
  int exitCode() const;

 private:
  static constexpr std::array<int, 3> kSignals = {SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, kSignals.size()> before_;
};

/// A program that was stopped before it had anything worth keeping.
class Stopped : public std::runtime_error {
 public:
  Stopped(const std::string& what, int exit_code) : std::runtime_error(what), exit_code_(exit_code) {}
  int exitCode() const { return exit_code_; }

 private:
  int exit_code_;
};

}  // namespace lintel
