// SPDX-License-Identifier: BSD-3-Clause
#include "BagTopics.h"

#include <algorithm>
#include <cctype>

#include "lintel/sensing/Recording.h"

namespace lintel {
namespace {

using Topics = std::vector<BagTopic>;

bool isImage(const BagTopic& topic) {
  return topic.type == "sensor_msgs/Image" || topic.type == "sensor_msgs/CompressedImage";
}

bool isImu(const BagTopic& topic) { return topic.type == "sensor_msgs/Imu"; }

bool nameHolds(const BagTopic& topic, const char* word) {
  std::string name = topic.name;
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name.find(word) != std::string::npos;
}

template <class Condition>
Topics select(const Topics& topics, const Condition& condition) {
  Topics selected;
  std::copy_if(topics.begin(), topics.end(), std::back_inserter(selected), condition);
  return selected;
}

std::string namesOf(const Topics& topics) {
  std::string names;
  for (const BagTopic& topic : topics) names += (names.empty() ? "" : ", ") + topic.name;
  return names.empty() ? "none" : names;
}

/// The named topic; `candidates` are those that it may be.
BagTopic find(const Topics& candidates, const std::string& name, const std::string& path, const char* kind) {
  for (const BagTopic& topic : candidates)
    if (topic.name == name || topic.name == "/" + name) return topic;
  throw RecordingError(path + ": has no topic " + name + " with " + kind + ": name one of " + namesOf(candidates));
}

void noteChoice(const Topics& candidates, const char* what, const char* option, const std::string& path,
                std::vector<Warning>& warnings) {
  if (candidates.size() > 1)
    warnings.push_back({Fault::Other, path + ": " + what + " taken from " + candidates.front().name + " of " +
                                          namesOf(candidates) + "; choose with " + option});
}

const BagTopic* preferredOf(const Topics& candidates, const std::string& preferred) {
  const auto found =
      std::find_if(candidates.begin(), candidates.end(), [&](const BagTopic& t) { return t.name == preferred; });
  return found == candidates.end() ? nullptr : &*found;
}

}  // namespace

BagTopic chooseImages(const Topics& topics, const std::string& named, const std::string& preferred,
                      const std::string& path, std::vector<Warning>& warnings) {
  const Topics all = select(topics, isImage);
  if (!named.empty()) return find(all, named, path, "images");
  if (const BagTopic* topic = preferredOf(all, preferred)) return *topic;
  const Topics candidates = select(all, [](const BagTopic& t) { return t.count > 0 && !nameHolds(t, "depth"); });
  if (candidates.empty())
    throw RecordingError(path +
                         ": holds no images (sensor_msgs/Image or CompressedImage); its topics: " + namesOf(topics));
  noteChoice(candidates, "images", "--camera", path, warnings);
  return candidates.front();
}

Topics chooseImu(const Topics& topics, const std::string& named, const std::string& preferred, const std::string& path,
                 std::vector<Warning>& warnings) {
  const Topics all = select(topics, isImu);
  if (!named.empty()) {
    const std::size_t comma = named.find(',');
    if (comma == std::string::npos) return {find(all, named, path, "IMU samples")};
    return {find(all, named.substr(0, comma), path, "IMU samples"),
            find(all, named.substr(comma + 1), path, "IMU samples")};
  }
  if (const BagTopic* topic = preferredOf(all, preferred)) return {*topic};
  const Topics candidates = select(all, [](const BagTopic& t) { return t.count > 0; });
  const Topics gyros = select(candidates, [](const BagTopic&t) { return nameHolds(t, "gyro"); }),
               accels = select(candidates, [](const BagTopic&t) { return nameHolds(t, "accel"); }),
               whole =
                   select(candidates, [](const BagTopic&t) { return !nameHolds(t, "gyro") && !nameHolds(t, "accel"); });
  noteChoice(whole, "the IMU", "--imu", path, warnings);
  if (!whole.empty()) return {whole.front()};
  if (!gyros.empty() && !accels.empty()) return {gyros.front(), accels.front()};
  throw RecordingError(
      path + ": holds no IMU samples (sensor_msgs/Imu) of gyroscope and accelerometer; its topics: " + namesOf(topics));
}

}  // namespace lintel
