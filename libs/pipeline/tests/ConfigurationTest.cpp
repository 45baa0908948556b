// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/pipeline/Configuration.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <type_traits>

#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// Every leaf of a configuration as `key.with.dots` with its bytes and what is allowed; keys of numbers and texts
/// apart.
class Leaves {
 public:
  explicit Leaves(Configuration configuration) { configuration.fields(*this); }

  template <class T, class... Allowed>
  void operator()(const std::string& key, T& value, const Allowed&... allowed) {
    if constexpr (isParamValue<T>) {
      allowed_[path_ + key] = allowedText(allowed...);
      if constexpr (std::is_same_v<T, std::string>) {
        all_[path_ + key] = value;
        texts_.push_back(path_ + key);
      } else {
        all_[path_ + key] = std::string(reinterpret_cast<const char*>(&value), sizeof value);
        if constexpr (!std::is_same_v<T, bool>) numbers_.push_back(path_ + key);
      }
    } else {
      const std::string before = path_;
      path_ += key + ".";
      value.fields(*this);
      path_ = before;
    }
  }
  const std::map<std::string, std::string>& all() const { return all_; }
  const std::map<std::string, std::string>& allowed() const { return allowed_; }
  const std::vector<std::string>& numbers() const { return numbers_; }
  const std::vector<std::string>& texts() const { return texts_; }

 private:
  std::string path_;
  std::map<std::string, std::string> all_, allowed_;
  std::vector<std::string> numbers_, texts_;
};

class ConfigurationTest : public testing::Test {
 protected:
  Configuration read(const std::string& text) const {
    std::ofstream(file_) << text;
    Configuration configuration;
    readConfiguration(file_, configuration);
    return configuration;
  }
  std::string complaintOf(const std::string& text) const {
    try {
      read(text);
    } catch (const ConfigurationError& error) {
      return error.what();
    }
    return "no complaint";
  }
  static std::string setComplaintOf(const std::string& assignment) {
    Configuration configuration;
    try {
      setOption(assignment, configuration);
    } catch (const ConfigurationError& error) {
      return error.what();
    }
    return "no complaint";
  }

  test::TempFolder folder_;
  const std::string file_ = folder_ / "my.yaml";
};

TEST_F(ConfigurationTest, WhatIsDoneWithDegenerateLinesIsDoneInTheMapToo) {
  EXPECT_EQ(Configuration().map.degenerate_lines, Configuration().estimator.degeneracy.lines);
  EXPECT_EQ(read("estimator: {degeneracy: {lines: use}}").map.degenerate_lines, "use");
  Configuration configuration;
  setOption("estimator.degeneracy.lines=drop", configuration);
  EXPECT_EQ(configuration.map.degenerate_lines, "drop");
}

TEST_F(ConfigurationTest, SetsWhatTheFileHoldsAndNothingElse) {
  const Configuration c =
      read("estimator:\n  keyframes: 8\n  factors: {point_sigma_px: 0.75}\nmap:\n  coverage: 0.5\n");
  EXPECT_EQ(c.estimator.keyframes, 8);
  EXPECT_EQ(c.estimator.factors.point_sigma_px, 0.75);
  EXPECT_EQ(c.map.coverage, 0.5);
  const auto set = Leaves(c).all(), defaults = Leaves(Configuration{}).all();
  ASSERT_EQ(set.size(), defaults.size());
  int different = 0;
  for (const auto& [key, value] : defaults) different += set.at(key) != value;
  EXPECT_EQ(different, 3);
}

TEST_F(ConfigurationTest, AnEmptyFileIsTheDefaults) {
  EXPECT_EQ(Leaves(read("")).all(), Leaves(Configuration{}).all());
  EXPECT_EQ(Leaves(read("# nothing but a comment\n")).all(), Leaves(Configuration{}).all());
}

TEST_F(ConfigurationTest, AnUnknownKeyNamesFileLineAndTheKnownOnes) {
  EXPECT_THAT(complaintOf("map:\n  coverage: 0.5\n  coverag: 1\n"),
              AllOf(StartsWith(file_ + ":3: unknown key map.coverag; known here: "), HasSubstr(" min_observations")));
  EXPECT_THAT(complaintOf("maps: {}\n"),
              AllOf(StartsWith(file_ + ":1: unknown key maps"), HasSubstr("estimator features loops map")));
}

TEST_F(ConfigurationTest, AValueOfTheWrongTypeNamesFileLineAndWhatItMustBe) {
  EXPECT_EQ(complaintOf("estimator:\n  keyframes: many\n"),
            file_ + ":2: estimator.keyframes must be a whole number, not 'many'");
  EXPECT_THAT(complaintOf("estimator:\n  keyframes: 7.5\n"), HasSubstr("must be a whole number"));
  EXPECT_THAT(complaintOf("map: {coverage: [1, 2]}\n"), HasSubstr("map.coverage must be a number"));
  EXPECT_THAT(complaintOf("estimator: {calibration: {refine_camera: 3}}\n"), HasSubstr("must be true or false"));
  EXPECT_THAT(complaintOf("estimator: 5\n"), HasSubstr("estimator must hold keys of its own"));
  EXPECT_THAT(complaintOf("- a\n- b\n"), HasSubstr("holds no keys"));
}

TEST_F(ConfigurationTest, AValueBeyondItsLimitsNamesFileLineAndLimits) {
  EXPECT_EQ(complaintOf("estimator:\n  keyframes: 2\n"), file_ + ":2: estimator.keyframes = 2, must be from 4 to 100");
  EXPECT_EQ(complaintOf("tracking: {lines: {mode: magic}}\n"),
            file_ + ":1: tracking.lines.mode = magic, must be one of flow, four_steps, descriptor");
  EXPECT_EQ(setComplaintOf("map.coverage=1.5"), "--set map.coverage=1.5:1: map.coverage = 1.5, must be from 0 to 1");
}

TEST_F(ConfigurationTest, NoKeyTakesAnAbsurdValue) {
  const Leaves leaves{Configuration{}};
  EXPECT_GT(leaves.numbers().size(), 100u);
  for (const std::string& key : leaves.numbers())
    for (const char* absurd : {".nan", ".inf", "-.inf", "-1", "-1e-3", "1e30", "2147483647"})
      EXPECT_THAT(setComplaintOf(key + "=" + absurd), HasSubstr(key + (std::string(absurd) == "-1" ? " = -1," : "")))
          << absurd;
  for (const std::string& key : leaves.texts())
    EXPECT_THAT(setComplaintOf(key + "=magic"), HasSubstr(key + " = magic, must be one of "));
}

TEST_F(ConfigurationTest, TheDefaultsAreAllowed) {
  Configuration c;
  EXPECT_NO_THROW(checkRanges(c, ""));
  EXPECT_THAT(complaintOf(writeConfiguration(c)), "no complaint");
}

/// The tables of the document: | `key` | default | allowed | meaning |
TEST_F(ConfigurationTest, TheDocumentHasTheAllowedValues) {
  const std::regex row("^\\| \\**`([a-z0-9_.]+)`\\** \\| [^|]* \\| ([^|]*) \\| .* \\|$");
  std::ifstream document(LINTEL_SOURCE_DIR "/doc/configuration.md");
  std::map<std::string, std::string> documented;
  std::smatch match;
  for (std::string line; std::getline(document, line);)
    if (std::regex_match(line, match, row)) documented[match[1]] = match[2];
  EXPECT_EQ(documented, Leaves(Configuration{}).allowed());
}

TEST_F(ConfigurationTest, WhatIsNoYamlNamesFileAndLine) {
  EXPECT_THAT(complaintOf("estimator:\n  keyframes: [1, 2\nmap: }\n"),
              AllOf(StartsWith(file_ + ":"), HasSubstr("is not YAML")));
  Configuration configuration;
  EXPECT_THROW(readConfiguration(folder_ / "absent.yaml", configuration), ConfigurationError);
}

TEST_F(ConfigurationTest, OptionsAreSetByTheirDottedKeys) {
  Configuration c;
  setOption("estimator.landmarks.line_max_error_px=2.5", c);
  setOption("features=points", c);
  setOption("tracking.lines.mode=descriptor", c);
  EXPECT_EQ(c.estimator.landmarks.line_max_error_px, 2.5);
  EXPECT_EQ(c.tracking.features, "points");
  EXPECT_EQ(Leaves(c).all().at("tracking.lines.mode"), "descriptor");
}

TEST_F(ConfigurationTest, WrongOptionsAreNamed) {
  EXPECT_THAT(setComplaintOf("estimator.keyframs=8"),
              AllOf(StartsWith("--set estimator.keyframs=8"), HasSubstr("unknown key estimator.keyframs")));
  EXPECT_THAT(setComplaintOf("estimator.keyframes=eight"), HasSubstr("must be a whole number"));
  EXPECT_THAT(setComplaintOf("estimator.keyframes"), HasSubstr("must be key=value"));
  EXPECT_THAT(setComplaintOf("=8"), HasSubstr("must be key=value"));
  EXPECT_THAT(setComplaintOf("estimator=8"), HasSubstr("must hold keys of its own"));
}

TEST_F(ConfigurationTest, WrittenAndReadIsTheSameToTheLastBit) {
  Configuration c;
  c.estimator.factors.point_sigma_px = 0.1 + 0.2;
  c.estimator.landmarks.max_depth_m = 1e5 / 3;
  c.map.min_length_m = std::nextafter(0.05, 1.0);
  c.estimator.keyframes = 17;
  c.estimator.calibration.refine_camera = !c.estimator.calibration.refine_camera;
  const std::string text = writeConfiguration(c);
  EXPECT_EQ(Leaves(read(text)).all(), Leaves(c).all());
  EXPECT_EQ(writeConfiguration(read(text)), text);
}

TEST_F(ConfigurationTest, DefaultYamlIsTheBuiltInDefaults) {
  const std::string path = LINTEL_SOURCE_DIR "/share/lintel/config/default.yaml";
  std::ifstream file(path);
  std::string text, line;
  while (std::getline(file, line))
    if (line.empty() || line[0] != '#') text += line + "\n";
  EXPECT_EQ(text, writeConfiguration(Configuration{})) << path << " is not what `lintel-vio --dump-config` prints";
}

TEST_F(ConfigurationTest, EurocYamlLoadsAndHoldsOnlyWhatDiffers) {
  Configuration c;
  readConfiguration(LINTEL_SOURCE_DIR "/share/lintel/config/euroc.yaml", c);
  const auto set = Leaves(c).all(), defaults = Leaves(Configuration{}).all();
  int different = 0;
  for (const auto& [key, value] : defaults) different += set.at(key) != value;
  EXPECT_GT(different, 0);
  EXPECT_LT(different, 20);
}

}  // namespace
}  // namespace lintel
