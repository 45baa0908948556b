// SPDX-License-Identifier: BSD-3-Clause
#include "YamlFile.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "lintel/core/TextFile.h"

namespace lintel {
namespace {

/// Without what is no YAML: OpenCV's first line "%YAML:1.0", and tabs, which people put into OpenCV's files.
std::string readableYaml(const std::string& text) {
  std::istringstream in(text);
  std::string yaml;
  for (std::string line; std::getline(in, line);) (line.rfind('%', 0) == 0 ? yaml : yaml += line) += '\n';
  std::replace(yaml.begin(), yaml.end(), '\t', ' ');
  return yaml;
}

}  // namespace

YamlFile::YamlFile(const std::string& path, const std::string& absent) : path_(path) {
  if (!std::ifstream(path)) throw RecordingError(path + ": missing: " + absent);
  const std::string text = textOfFile(path, [](const std::string& what) { throw RecordingError(what); });
  try {
    root_ = YAML::Load(readableYaml(text));
  } catch (const YAML::Exception& e) {
    throw RecordingError(path + ":" + std::to_string(e.mark.line + 1) + ": not valid YAML: " + e.msg);
  }
  if (!root_.IsMap()) throw RecordingError(path + ": empty or no YAML map: write the sensor's parameters into it");
}

YamlFile YamlFile::below(const std::string& key) const {
  if (!isMap(key)) throw RecordingError(where(key) + " is missing or no map: add it");
  return {path_, prefix_ + key + ".", root_[key]};
}

std::vector<std::string> YamlFile::keys() const {
  std::vector<std::string> names;
  for (const auto& entry : root_)
    if (entry.first.IsScalar()) names.push_back(entry.first.Scalar());
  return names;
}

double YamlFile::finite(const std::string& key) const {
  const double value = get<double>(key);
  if (!std::isfinite(value)) throw RecordingError(where(key) + " must be a number");
  return value;
}

double YamlFile::positive(const std::string& key) const {
  const double value = get<double>(key);
  if (!std::isfinite(value) || value <= 0) throw RecordingError(where(key) + " must be a number greater than 0");
  return value;
}

std::vector<double> YamlFile::numbers(const std::string& key) const {
  const YAML::Node node = root_[key];
  if (node && node.IsMap()) return as<std::vector<double>>(node["data"], key + ": data");
  if (!node || !node.IsSequence() || node.size() == 0 || !node[0].IsSequence())
    return as<std::vector<double>>(node, key);
  std::vector<double> all;
  for (const std::vector<double>& row : as<std::vector<std::vector<double>>>(node, key))
    all.insert(all.end(), row.begin(), row.end());
  return all;
}

std::vector<double> YamlFile::list(const std::string& key, std::size_t count) const {
  std::vector<double> values = numbers(key);
  if (values.size() != count)
    throw RecordingError(where(key) + " has " + std::to_string(values.size()) + " values, expected " +
                         std::to_string(count));
  return values;
}

Eigen::Matrix4d YamlFile::matrix4(const std::string& key) const {
  const std::vector<double> values = numbers(key);
  if (values.size() != 16) throw RecordingError(where(key) + " needs 16 values, row by row");
  return Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values.data());
}

Eigen::Matrix3d YamlFile::matrix3(const std::string& key) const {
  const std::vector<double> values = numbers(key);
  if (values.size() != 9) throw RecordingError(where(key) + " needs 9 values, row by row");
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data());
}

}  // namespace lintel
