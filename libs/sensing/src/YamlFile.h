// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "lintel/sensing/Recording.h"

namespace lintel {

/// A map of a YAML file with typed access that names file and key on failure (RecordingError). Reads OpenCV's files
/// too, which are not quite YAML.
class YamlFile {
 public:
  /// `absent`: what to do when the file cannot be opened, for the message.
  YamlFile(const std::string& path, const std::string& absent);

  /// The map below `key`, which must be there; keys of messages are then "key.inner".
  YamlFile below(const std::string& key) const;

  const std::string& path() const { return path_; }
  std::string where(const std::string& key) const { return path_ + ": " + prefix_ + key; }
  bool has(const std::string& key) const { return root_[key] && !root_[key].IsNull(); }
  /// Keys of the file, in its order.
  std::vector<std::string> keys() const;
  bool isMap(const std::string& key) const { return root_[key] && root_[key].IsMap(); }

  template <class T>
  T get(const std::string& key) const {
    return as<T>(root_[key], key);
  }
  template <class T>
  T get(const std::string& key, const T& otherwise) const {
    return has(key) ? get<T>(key) : otherwise;
  }

  /// A finite number.
  double finite(const std::string& key) const;
  /// A finite number greater than 0.
  double positive(const std::string& key) const;
  /// Numbers: a list, or the `data` of one of OpenCV's or EuRoC's matrices.
  std::vector<double> numbers(const std::string& key) const;
  /// The same, `count` of them.
  std::vector<double> list(const std::string& key, std::size_t count) const;
  /// A matrix of 16 numbers row by row, or of 4 rows.
  Eigen::Matrix4d matrix4(const std::string& key) const;
  Eigen::Matrix3d matrix3(const std::string& key) const;

 private:
  YamlFile(std::string path, std::string prefix, YAML::Node root)
      : path_(std::move(path)), prefix_(std::move(prefix)), root_(std::move(root)) {}

  template <class T>
  T as(const YAML::Node& node, const std::string& key) const {
    if (!node || node.IsNull()) throw RecordingError(where(key) + " is missing: add it");
    try {
      return node.as<T>();
    } catch (const YAML::Exception&) {
      throw RecordingError(path_ + ":" + std::to_string(node.Mark().line + 1) + ": " + prefix_ + key +
                           " is not of the expected type");
    }
  }

  std::string path_, prefix_;
  YAML::Node root_;
};

}  // namespace lintel
