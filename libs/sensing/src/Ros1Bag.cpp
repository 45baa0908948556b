// SPDX-License-Identifier: BSD-3-Clause
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <map>

#include "Bag.h"
#include "Ros1Check.h"
#include "lintel/sensing/Recording.h"

namespace lintel {
namespace {

/// What the library throws, as one line. Its own classes and those of its decompression have no common base.
template <class Function>
auto readingBag(const std::string& path, const Function& function) {
  try {
    return function();
  } catch (const rosbag::BagUnindexedException&) {
    throw RecordingError(path + ": the recording was not closed (no index): repair the bag with rosbag reindex");
  } catch (const RecordingError&) {
    throw;
  } catch (const std::exception& e) {
    std::string what = e.what();
    throw RecordingError(path + ": no ROS 1 bag, or cut or damaged (" + what.substr(0, what.find('\n')) +
                         "): repair it with rosbag reindex");
  }
}

std::int64_t nanoseconds(const ros::Time& time) {
  return static_cast<std::int64_t>(time.sec) * 1000000000 + static_cast<std::int64_t>(time.nsec);
}

std::shared_ptr<rosbag::Bag> openForReading(const std::string& path) {
  console_bridge::setLogLevel(
      console_bridge::CONSOLE_BRIDGE_LOG_NONE);  // the library would print beside what it throws
  return readingBag(path, [&] { return std::make_shared<rosbag::Bag>(path, rosbag::bagmode::Read); });
}

class Ros1Reader final : public BagReader {
 public:
  Ros1Reader(std::string path, const std::string& topic)
      : path_(std::move(path)),
        bag_(openForReading(path_)),
        view_(readingBag(path_, [&] { return std::make_unique<rosbag::View>(*bag_, rosbag::TopicQuery(topic)); })),
        at_(view_->begin()) {}

  std::optional<BagMessage> next() override {
    return readingBag(path_, [&] { return read(); });
  }

 private:
  std::optional<BagMessage> read() {
    if (at_ == view_->end()) return std::nullopt;
    const rosbag::MessageInstance& message = *at_;
    BagMessage result{nanoseconds(message.getTime()), std::make_shared<std::vector<std::uint8_t>>(message.size())};
    ros::serialization::OStream stream(result.bytes->data(), static_cast<std::uint32_t>(result.bytes->size()));
    message.write(stream);
    ++at_;
    return result;
  }

  std::string path_;
  std::shared_ptr<rosbag::Bag> bag_;
  std::unique_ptr<rosbag::View> view_;
  rosbag::View::iterator at_;
};

class Ros1Bag final : public Bag {
 public:
  explicit Ros1Bag(const std::string& path) : path_(path) {
    check();
    const auto bag = openForReading(path);
    readingBag(path, [&] { list(*bag); });
  }

  const std::vector<BagTopic>& topics() const override { return topics_; }
  std::unique_ptr<BagReader> read(const std::string& topic) const override {
    return std::make_unique<Ros1Reader>(path_, topic);
  }

 private:
  /// Before the library reads what it would take for granted.
  void check() const {
    try {
      checkRos1Bag(path_);
    } catch (const std::exception& error) {
      throw RecordingError(path_ + ": no ROS 1 bag, or cut or damaged (" + error.what() +
                           "): repair it with rosbag reindex");
    }
  }

  void list(const rosbag::Bag& bag) {
    rosbag::View all(bag);
    std::map<std::string, std::string> types;
    for (const rosbag::ConnectionInfo* connection : all.getConnections())
      types[connection->topic] = connection->datatype;
    for (const auto& [name, type] : types) {
      rosbag::View view(bag, rosbag::TopicQuery(name));
      BagTopic topic{name, type, BagEncoding::kRos1, view.size(), 0, 0};
      if (topic.count > 0) {
        topic.first_ns = nanoseconds(view.getBeginTime());
        topic.last_ns = nanoseconds(view.getEndTime());
      }
      topics_.push_back(topic);
    }
  }

  std::string path_;
  std::vector<BagTopic> topics_;
};

}  // namespace

std::unique_ptr<Bag> openRos1Bag(const std::string& path) { return std::make_unique<Ros1Bag>(path); }

}  // namespace lintel
