// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/bench/BenchSuite.h"

#include <glob.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>

#include "lintel/core/TextFile.h"

namespace lintel {

namespace {

namespace fs = std::filesystem;

/// The paths that match a pattern of the shell, sorted.
std::vector<std::string> matches(const std::string& pattern) {
  glob_t found{};
  const std::unique_ptr<glob_t, void (*)(glob_t*)> holder(&found, globfree);
  std::vector<std::string> paths;
  if (glob(pattern.c_str(), 0, nullptr, &found) == 0)
    for (std::size_t i = 0; i < found.gl_pathc; ++i) paths.emplace_back(found.gl_pathv[i]);
  return paths;
}

bool isRecording(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path / "mav0" / "cam0", ignored) || fs::is_directory(path / "cam0", ignored) ||
         (path.extension() == ".rawlog" && fs::is_regular_file(path, ignored));
}

std::string findRecording(const std::string& name, const fs::path& folder) {
  for (const fs::path& path : {folder / name, folder / (name + ".rawlog")})
    if (isRecording(path)) return path.string();
  for (const std::string& path : matches((folder / "*" / name).string()))
    if (isRecording(path)) return path;
  return "";
}

class SuiteReader {
 public:
  SuiteReader(const std::string& file, const std::string& folder) : file_(file), folder_(folder) {
    try {
      root_ = YAML::Load(textOfFile(file, [](const std::string& what) { throw SuiteError(what); }));
    } catch (const YAML::Exception& e) {
      throw SuiteError(file + ":" + std::to_string(e.mark.line + 1) + ": is not YAML: " + e.msg);
    }
  }

  BenchSuite read() {
    checkKeys(root_,
              {"name", "title", "config", "recordings", "configurations", "starts_s", "seeds", "published", "notes"});
    BenchSuite suite;
    suite.name = fs::path(file_).stem().string();
    if (root_["name"]) suite.name = nameOf(root_["name"]);
    suite.title = root_["title"] ? as<std::string>(root_["title"]) : suite.name;
    if (root_["starts_s"]) suite.starts_s = startsIn(root_["starts_s"]);
    if (root_["seeds"]) seeds_ = asList<std::uint64_t>(root_["seeds"]);
    if (root_["notes"]) suite.notes = asList<std::string>(root_["notes"]);
    if (root_["config"]) config_ = besideSuite(root_["config"]);
    if (!root_["recordings"] || !root_["recordings"].IsSequence()) fail(root_, "needs a list 'recordings'");
    for (const YAML::Node& node : root_["recordings"]) addRecording(node, suite);
    if (!root_["configurations"] || !root_["configurations"].IsSequence()) fail(root_, "needs a list 'configurations'");
    for (const YAML::Node& node : root_["configurations"]) addConfiguration(node, suite);
    for (const auto& system : root_["published"]) addPublished(system.first, system.second, suite);
    if (suite.recordings.empty()) fail(root_["recordings"], "names no recording");
    if (suite.configurations.empty()) fail(root_["configurations"], "names no configuration");
    return suite;
  }

 private:
  [[noreturn]] void fail(const YAML::Node& node, const std::string& what) const {
    const int line = node.IsDefined() ? node.Mark().line : -1;
    throw SuiteError(file_ + (line >= 0 ? ":" + std::to_string(line + 1) : "") + ": " + what);
  }

  template <class T>
  T as(const YAML::Node& node) const {
    try {
      return node.as<T>();
    } catch (const YAML::Exception&) {
      const std::string what = node.IsScalar() ? "'" + node.Scalar() + "'" : node.IsSequence() ? "a list" : "a map";
      fail(node, what + " is of the wrong kind here");
    }
  }

  template <class T>
  std::vector<T> asList(const YAML::Node& node) const {
    auto list = as<std::vector<T>>(node);
    if (list.empty()) fail(node, "an empty list");
    return list;
  }

  std::vector<double> startsIn(const YAML::Node& node) const {
    auto starts_s = asList<double>(node);
    for (const double start_s : starts_s)
      if (!(start_s >= 0 && start_s < 1e9)) fail(node, "starts_s must be seconds after the first frame");
    return starts_s;
  }

  void checkKeys(const YAML::Node& node, const std::set<std::string>& known) const {
    if (!node.IsMap()) fail(node, "must hold keys");
    for (const auto& entry : node) {
      const std::string key = as<std::string>(entry.first);
      if (known.count(key) > 0) continue;
      std::string list;
      for (const std::string& k : known) list.append(" ").append(k);
      fail(entry.first, std::string("unknown key '").append(key).append("'; known here:").append(list));
    }
  }

  /// A name that is also the name of a folder.
  std::string nameOf(const YAML::Node& node) const {
    auto name = as<std::string>(node);
    if (name.empty() || name[0] == '.' || name[0] == '-' || name.find_first_of("/ \t\n") != std::string::npos)
      fail(node, "'" + name + "' is no name: without blanks and slashes, not beginning with a dot or a dash");
    return name;
  }

  std::string besideSuite(const YAML::Node& node) const {
    const fs::path path = fs::path(file_).parent_path() / as<std::string>(node);
    if (!fs::exists(path)) fail(node, path.string() + ": does not exist (paths are seen from the suite's folder)");
    return fs::absolute(path).lexically_normal().string();
  }

  std::string inFolder(const std::string& path) const {
    return fs::absolute(fs::path(folder_) / path).lexically_normal().string();
  }

  void add(const YAML::Node& node, BenchRecording recording, BenchSuite& suite) const {
    for (const BenchRecording& other : suite.recordings)
      if (other.name == recording.name) fail(node, "recording '" + recording.name + "' is there twice");
    suite.recordings.push_back(std::move(recording));
  }

  void addRecording(const YAML::Node& node, BenchSuite& suite) const {
    if (node.IsScalar()) {
      const std::string name = nameOf(node);
      BenchRecording recording{name, findRecording(name, inFolder("")), {}, {}, ""};
      return add(node, recording, suite);
    }
    checkKeys(node, {"name", "path", "glob", "sim", "groundtruth", "from_s", "to_s"});
    BenchRecording recording;
    if (node["from_s"]) recording.from_s = as<double>(node["from_s"]);
    if (node["to_s"]) recording.to_s = as<double>(node["to_s"]);
    if (node["groundtruth"]) recording.groundtruth = inFolder(as<std::string>(node["groundtruth"]));
    if (node["glob"]) return addMatches(node, recording, suite);
    if (!node["name"]) fail(node, "a recording needs a 'name' (or a 'glob')");
    recording.name = nameOf(node["name"]);
    if (node["sim"]) {
      recording.seeds = seeds_;
      readSimulation(node["sim"], recording);
    } else if (node["path"]) {
      const std::string path = inFolder(as<std::string>(node["path"]));
      if (isRecording(path)) recording.path = path;
    } else {
      recording.path = findRecording(recording.name, inFolder(""));
    }
    add(node, recording, suite);
  }

  void addMatches(const YAML::Node& node, const BenchRecording& common, BenchSuite& suite) const {
    const std::string pattern = inFolder(as<std::string>(node["glob"]));
    for (const std::string& path : matches(pattern)) {
      if (!isRecording(path)) continue;
      BenchRecording recording = common;
      recording.name = fs::path(path).stem().string();
      recording.path = path;
      std::replace(recording.name.begin(), recording.name.end(), ' ', '_');
      add(node, recording, suite);
    }
    if (suite.recordings.empty()) fail(node, pattern + ": matches no recording; name the folder with --recordings");
  }

  void readSimulation(const YAML::Node& node, BenchRecording& recording) const {
    if (!node.IsMap()) fail(node, "'sim' must hold options of lintel-sim");
    for (const auto& option : node) {
      const std::string key = as<std::string>(option.first), value = as<std::string>(option.second);
      if (key == "seed") {
        recording.seeds = {as<std::uint64_t>(option.second)};
        continue;
      }
      if (value == "false") continue;
      recording.simulation.push_back("--" + key);
      if (value != "true") recording.simulation.push_back(key == "trajectory" ? inFolder(value) : value);
    }
    if (!node["scene"]) fail(node, "a simulation needs a 'scene'");
  }

  void addConfiguration(const YAML::Node& node, BenchSuite& suite) const {
    checkKeys(node, {"name", "config", "set"});
    if (!node["name"]) fail(node, "a configuration needs a 'name'");
    BenchConfiguration configuration{nameOf(node["name"]), config_, {}};
    if (node["config"]) configuration.config = besideSuite(node["config"]);
    if (node["set"]) configuration.settings = as<std::vector<std::string>>(node["set"]);
    for (const BenchConfiguration& other : suite.configurations)
      if (other.name == configuration.name) fail(node, "configuration '" + configuration.name + "' is there twice");
    suite.configurations.push_back(configuration);
  }

  void addPublished(const YAML::Node& system, const YAML::Node& figures, BenchSuite& suite) const {
    constexpr char kForm[] = "published figures need 'recording: RMSE' or 'recording: [RMSE, maximum]', in metres";
    if (!figures.IsMap()) fail(system, kForm);
    PublishedSystem published{as<std::string>(system), {}, {}};
    for (const auto& figure : figures) {
      const auto recording = as<std::string>(figure.first);
      if (recording == "source") {
        published.source = as<std::string>(figure.second);
        continue;
      }
      const auto values =
          figure.second.IsScalar() ? std::vector<double>{as<double>(figure.second)} : asList<double>(figure.second);
      if (values.empty() || values.size() > 2) fail(figure.first, kForm);
      published.errors[recording] = {values[0], values.size() == 2 ? std::optional(values[1]) : std::nullopt};
    }
    suite.published.push_back(published);
  }

  std::string file_, folder_, config_;
  YAML::Node root_;
  std::vector<std::uint64_t> seeds_{1};
};

}  // namespace

BenchSuite readSuite(const std::string& file, const std::string& folder) { return SuiteReader(file, folder).read(); }

}  // namespace lintel
