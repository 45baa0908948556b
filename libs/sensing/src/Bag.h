// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lintel {

/// How the messages of a topic are laid out as bytes.
enum class BagEncoding { kRos1, kCdr };

/// A topic of a bag.
struct BagTopic {
  std::string name, type;  ///< type in ROS 1's spelling: sensor_msgs/Imu
  BagEncoding encoding = BagEncoding::kRos1;
  std::size_t count = 0;                   ///< messages
  std::int64_t first_ns = 0, last_ns = 0;  ///< when they were recorded

  /// Mean rate, rounded to 0.1 Hz; 0 if unknown.
  double rate_hz() const;
};

struct BagMessage {
  std::int64_t recorded_ns = 0;
  std::shared_ptr<std::vector<std::uint8_t>> bytes;  ///< never null
};

/// The messages of one topic, in the order of their recording.
class BagReader {
 public:
  virtual ~BagReader() = default;
  /// Empty at the end. Throws RecordingError when the file is damaged.
  virtual std::optional<BagMessage> next() = 0;
};

/// A ROS bag of any kind.
class Bag {
 public:
  virtual ~Bag() = default;
  virtual const std::vector<BagTopic>& topics() const = 0;
  /// Independent of other readers.
  virtual std::unique_ptr<BagReader> read(const std::string& topic) const = 0;
};

/// Whether a path is a bag by its name: .bag, .db3, .mcap, or a folder with a metadata.yaml.
bool isBag(const std::string& path);

/// Opens it. Throws RecordingError.
std::unique_ptr<Bag> openBag(const std::string& path);

// Of one file, by format; each throws RecordingError.

std::unique_ptr<Bag> openRos1Bag(const std::string& path);
std::unique_ptr<Bag> openSqliteBag(const std::string& path);
std::unique_ptr<Bag> openMcapBag(const std::string& path);

/// "sensor_msgs/msg/Imu" (ROS 2) as "sensor_msgs/Imu".
std::string ros1Type(const std::string& type);

}  // namespace lintel
