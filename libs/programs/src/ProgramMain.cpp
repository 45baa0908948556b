// SPDX-License-Identifier: BSD-3-Clause
#include "ProgramMain.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <csignal>
#include <new>
#include <ostream>

#include "lintel/core/Version.h"

namespace lintel {

namespace {

std::string oneLine(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

int programMain(const std::string& name, std::ostream& err, const std::function<int()>& body) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file over the user's limit is an error of writing, not a sudden end
  try {
    return body();
  } catch (const UsageError& error) {
    err << name << ": " << oneLine(error.what()) << "; see " << name << " --help\n";
    return 2;
  } catch (const std::bad_alloc&) {
    err << name << ": out of memory; free some, or give a shorter part of the recording\n";
  } catch (const std::exception& error) {
    err << name << ": " << oneLine(error.what()) << "\n";
  }
  return 1;
}

std::optional<int> parseArguments(CLI::App& app, int argc, const char* const* argv, std::ostream& out,
                                  std::ostream& err) {
  app.set_version_flag("--version", app.get_name() + " " + version(), "Print the version and exit");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error, out, err);  // --help, --version
    err << app.get_name() << ": " << oneLine(error.what()) << "; see " << app.get_name() << " --help\n";
    return 2;
  }
  return std::nullopt;
}

}  // namespace lintel
