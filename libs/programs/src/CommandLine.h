// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace lintel {

/// The options of a program, by CLI11. The only place that includes its headers, which take ten seconds to compile.
class CommandLine {
 public:
  /// An option that has been added, to say more of it.
  class Option {
   public:
    explicit Option(CLI::Option* option) : option_(option) {}

    Option type(const std::string& name);  ///< what --help calls the value
    Option required();
    Option showDefault();  ///< in --help: the present value of the variable
    Option positive();
    Option notNegative();
    Option range(int min, int max);
    Option range(double min, double max);
    Option oneOf(const std::vector<std::string>& values);
    Option separatedBy(char delimiter);  ///< values in one word of the command line
    Option oneWord();                    ///< each time it is given it takes one word, also for lists
    Option repeatable();                 ///< may be given several times, each with one word
    Option excludes(const Option& other);

   private:
    CLI::Option* option_;
  };

  CommandLine(const std::string& name, const std::string& description);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// Text below the options in --help.
  void footer(const std::string& text);

  /// `names` with commas between ("-o,--output"; without dashes: by its position). parse() sets the variable, which
  /// must outlive this.
  Option option(const std::string& names, std::string& value, const std::string& help);
  Option option(const std::string& names, int& value, const std::string& help);
  Option option(const std::string& names, std::uint64_t& value, const std::string& help);
  Option option(const std::string& names, double& value, const std::string& help);
  Option option(const std::string& names, std::vector<std::string>& values, const std::string& help);
  Option option(const std::string& names, std::vector<double>& values, const std::string& help);
  Option flag(const std::string& names, bool& value, const std::string& help);

  /// Parses the command line, with --version added. Empty if the program should go on; else its exit code: 0 after
  /// --help or --version (printed to `out`), 2 after a wrong command line (one line on `err`).
  std::optional<int> parse(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace lintel
