// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/pipeline/Configuration.h"

#include <yaml-cpp/yaml.h>

#include <charconv>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <type_traits>

#include "lintel/core/TextFile.h"

namespace lintel {

namespace {

template <class T>
const char* typeName() {
  if (std::is_same_v<T, bool>) return "true or false";
  if (std::is_integral_v<T>) return "a whole number";
  if (std::is_floating_point_v<T>) return "a number";
  return "a text";
}

/// Sets the fields of a params struct from a YAML map.
class Reader {
 public:
  Reader(const YAML::Node& node, std::string source, std::string path)
      : node_(node), source_(std::move(source)), path_(std::move(path)) {}

  template <class T, class... Allowed>
  void operator()(const std::string& key, T& value, const Allowed&... allowed) {
    known_.insert(key);
    const YAML::Node child = node_[key];
    if (!child) return;
    if constexpr (isParamValue<T>) {
      try {
        value = child.as<T>();
      } catch (const YAML::Exception&) {
        throw ConfigurationError(where(child) + path_ + key + " must be " + typeName<T>() + ", not " +
                                 (child.IsScalar() ? "'" + child.Scalar() + "'" : "a list or map"));
      }
      try {
        if constexpr (sizeof...(Allowed) == 1) checkAllowed(path_ + key, value, allowed...);
      } catch (const std::invalid_argument& e) {
        throw ConfigurationError(where(child) + e.what());
      }
    } else {
      if (!child.IsMap()) throw ConfigurationError(where(child) + path_ + key + " must hold keys of its own");
      Reader reader(child, source_, path_ + key + ".");
      value.fields(reader);
      reader.refuseUnknown();
    }
  }

  void refuseUnknown() const {
    std::set<std::string> seen;
    for (const auto& entry : node_) {
      if (!entry.first.IsScalar()) throw ConfigurationError(where(entry.first) + "a key is a word, no list or map");
      const std::string key = entry.first.Scalar();
      if (!seen.insert(key).second) throw ConfigurationError(where(entry.first) + path_ + key + " is given twice");
      if (known_.count(key) > 0) continue;
      std::string list;
      for (const std::string& k : known_) list += (list.empty() ? "" : " ") + k;
      throw ConfigurationError(
          where(entry.first).append("unknown key ").append(path_).append(key).append("; known here: ").append(list));
    }
  }

 private:
  std::string where(const YAML::Node& node) const {
    const auto line = node.Mark().line;
    return source_ + (line >= 0 ? ":" + std::to_string(line + 1) : "") + ": ";
  }

  YAML::Node node_;
  std::string source_, path_;
  std::set<std::string> known_;
};

/// The shortest text that reads back as the same number.
std::string shortest(double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return std::string(buffer, result.ptr);
}

class Writer {
 public:
  Writer(YAML::Emitter& out) : out_(out) {}

  template <class T, class... Allowed>
  void operator()(const std::string& key, T& value, const Allowed&...) {
    out_ << YAML::Key << key << YAML::Value;
    if constexpr (std::is_floating_point_v<T>) {
      out_ << shortest(value);
    } else if constexpr (isParamValue<T>) {
      out_ << value;
    } else {
      out_ << YAML::BeginMap;
      value.fields(*this);
      out_ << YAML::EndMap;
    }
  }

 private:
  YAML::Emitter& out_;
};

void apply(const YAML::Node& root, const std::string& source, Configuration& configuration) {
  if (root.IsNull()) return;
  if (!root.IsMap()) throw ConfigurationError(source + ": holds no keys; see lintel-vio --dump-config");
  Reader reader(root, source, "");
  configuration.fields(reader);
  reader.refuseUnknown();
  configuration.map.degenerate_lines = configuration.estimator.degeneracy.lines;  // one key for both
}

}  // namespace

void readConfiguration(const std::string& path, Configuration& configuration) {
  YAML::Node root;
  try {
    root = YAML::Load(textOfFile(path, [](const std::string& what) { throw ConfigurationError(what); }));
  } catch (const YAML::Exception& e) {
    throw ConfigurationError(path + ":" + std::to_string(e.mark.line + 1) + ": is not YAML: " + e.msg);
  }
  apply(root, path, configuration);
}

void setOption(const std::string& assignment, Configuration& configuration) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0)
    throw ConfigurationError("--set " + assignment + ": must be key=value, e.g. --set estimator.keyframes=8");
  std::vector<std::string> keys;
  std::istringstream path(assignment.substr(0, equals));
  for (std::string key; std::getline(path, key, '.');) keys.push_back(key);
  YAML::Node value;
  try {
    value = YAML::Load(assignment.substr(equals + 1));
  } catch (const YAML::Exception& e) {
    throw ConfigurationError("--set " + assignment + ": the value is not YAML: " + e.msg);
  }
  for (auto key = keys.rbegin(); key != keys.rend(); ++key) {
    YAML::Node map(YAML::NodeType::Map);
    map[*key] = value;
    value = map;
  }
  apply(value, "--set " + assignment, configuration);
}

std::string writeConfiguration(const Configuration& configuration) {
  YAML::Emitter out;
  out << YAML::BeginMap;
  Configuration copy = configuration;
  Writer writer(out);
  copy.fields(writer);
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

}  // namespace lintel
