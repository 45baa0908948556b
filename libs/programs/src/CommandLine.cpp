// SPDX-License-Identifier: BSD-3-Clause
#include "CommandLine.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <ostream>

#include "ProgramMain.h"
#include "lintel/core/Version.h"

namespace lintel {

using Option = CommandLine::Option;

Option Option::type(const std::string& name) { return Option(option_->type_name(name)); }
Option Option::required() { return Option(option_->required()); }
Option Option::showDefault() { return Option(option_->capture_default_str()); }
Option Option::positive() { return Option(option_->check(CLI::PositiveNumber)); }
Option Option::notNegative() { return Option(option_->check(CLI::NonNegativeNumber)); }
Option Option::range(int min, int max) { return Option(option_->check(CLI::Range(min, max))); }
Option Option::range(double min, double max) { return Option(option_->check(CLI::Range(min, max))); }
Option Option::oneOf(const std::vector<std::string>& values) { return Option(option_->check(CLI::IsMember(values))); }
Option Option::separatedBy(char delimiter) { return Option(option_->delimiter(delimiter)); }
Option Option::oneWord() { return Option(option_->allow_extra_args(false)); }
Option Option::repeatable() { return Option(option_->take_all()->allow_extra_args(false)); }
Option Option::excludes(const Option& other) { return Option(option_->excludes(other.option_)); }

CommandLine::CommandLine(const std::string& name, const std::string& description)
    : app_(std::make_unique<CLI::App>(description, name)) {}

CommandLine::~CommandLine() = default;

void CommandLine::footer(const std::string& text) { app_->footer(text); }

Option CommandLine::option(const std::string& names, std::string& value, const std::string& help) {
  return Option(app_->add_option(names, value, help));
}

Option CommandLine::option(const std::string& names, int& value, const std::string& help) {
  return Option(app_->add_option(names, value, help));
}

Option CommandLine::option(const std::string& names, std::uint64_t& value, const std::string& help) {
  return Option(app_->add_option(names, value, help));
}

Option CommandLine::option(const std::string& names, double& value, const std::string& help) {
  return Option(app_->add_option(names, value, help));
}

Option CommandLine::option(const std::string& names, std::vector<std::string>& values, const std::string& help) {
  return Option(app_->add_option(names, values, help));
}

Option CommandLine::option(const std::string& names, std::vector<double>& values, const std::string& help) {
  return Option(app_->add_option(names, values, help));
}

Option CommandLine::flag(const std::string& names, bool& value, const std::string& help) {
  return Option(app_->add_flag(names, value, help));
}

std::optional<int> CommandLine::parse(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  app_->set_version_flag("--version", app_->get_name() + " " + version() + "\nbuilt with " + LINTEL_BUILT_WITH,
                         "Print the version and exit");
  try {
    app_->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app_->exit(error, out, err);  // --help, --version
    err << app_->get_name() << ": " << oneLine(error.what()) << "; see " << app_->get_name() << " --help\n";
    return 2;
  }
  return std::nullopt;
}

}  // namespace lintel
