// SPDX-License-Identifier: BSD-3-Clause
#include "Bag.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "ByteReader.h"
#include "Decompress.h"
#include "YamlFile.h"
#include "lintel/sensing/Recording.h"

namespace lintel {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMetadata = "metadata.yaml";

/// The messages of one topic from several files, one after the other; those compressed by themselves are unpacked.
class ChainReader final : public BagReader {
 public:
  ChainReader(const std::vector<std::unique_ptr<Bag>>& files, std::string topic)
      : files_(files), topic_(std::move(topic)) {}

  std::optional<BagMessage> next() override {
    for (; file_ < files_.size(); reader_.reset(), ++file_) {
      if (!reader_ && !holdsTopic(*files_[file_])) continue;
      if (!reader_) reader_ = files_[file_]->read(topic_);
      if (std::optional<BagMessage> message = reader_->next()) return unpacked(std::move(*message));
    }
    return std::nullopt;
  }

 private:
  bool holdsTopic(const Bag& bag) const {
    return std::any_of(bag.topics().begin(), bag.topics().end(), [&](const BagTopic& t) { return t.name == topic_; });
  }

  static BagMessage unpacked(BagMessage message) {
    const ByteReader bytes(message.bytes->data(), message.bytes->size());
    std::uint64_t size = 0;
    if (!isZstd(bytes, size)) return message;
    auto plain = std::make_shared<std::vector<std::uint8_t>>();
    if (decompress("zstd", bytes, size, *plain)) message.bytes = plain;  // else the message is found damaged
    return message;
  }

  const std::vector<std::unique_ptr<Bag>>& files_;
  std::string topic_;
  std::size_t file_ = 0;
  std::unique_ptr<BagReader> reader_;
};

class ChainedBag final : public Bag {
 public:
  explicit ChainedBag(std::vector<std::unique_ptr<Bag>> files) : files_(std::move(files)) {
    for (const auto& file : files_)
      for (const BagTopic& topic : file->topics()) add(topic);
    std::sort(topics_.begin(), topics_.end(), [](const BagTopic& a, const BagTopic& b) { return a.name < b.name; });
  }

  const std::vector<BagTopic>& topics() const override { return topics_; }
  std::unique_ptr<BagReader> read(const std::string& topic) const override {
    return std::make_unique<ChainReader>(files_, topic);
  }

 private:
  void add(const BagTopic& topic) {
    const auto known =
        std::find_if(topics_.begin(), topics_.end(), [&](const BagTopic& t) { return t.name == topic.name; });
    if (known == topics_.end()) return topics_.push_back(topic);
    if (topic.count == 0) return;
    known->first_ns = known->count == 0 ? topic.first_ns : std::min(known->first_ns, topic.first_ns);
    known->last_ns = std::max(known->last_ns, topic.last_ns);
    known->count += topic.count;
  }

  std::vector<std::unique_ptr<Bag>> files_;
  std::vector<BagTopic> topics_;
};

std::unique_ptr<Bag> openFile(const std::string& path) {
  const std::string extension = fs::path(path).extension().string();
  if (!fs::exists(path)) throw RecordingError(path + ": does not exist: give a bag's name");
  if (extension == ".bag") return openRos1Bag(path);
  if (extension == ".db3") return openSqliteBag(path);
  if (extension == ".mcap") return openMcapBag(path);
  throw RecordingError(path + ": no .db3 or .mcap: decompress the bag's files first (zstd -d)");
}

/// The files that the metadata of a ROS 2 bag name, in the order of their recording.
std::vector<std::string> filesOf(const std::string& folder) {
  const YamlFile metadata((fs::path(folder) / kMetadata).string(), "rebuild it with ros2 bag reindex");
  std::vector<std::string> paths;
  for (const auto& name :
       metadata.below("rosbag2_bagfile_information").get<std::vector<std::string>>("relative_file_paths")) {
    const fs::path inside = fs::path(folder) / name;
    paths.push_back((fs::exists(inside) ? inside : fs::path(folder) / fs::path(name).filename()).string());
  }
  if (paths.empty())
    throw RecordingError(folder + "/" + kMetadata + ": names no file: rebuild it with ros2 bag reindex");
  return paths;
}

}  // namespace

double BagTopic::rate_hz() const {
  if (count < 2 || last_ns <= first_ns) return 0;
  // a bag may say anything of its times: their difference need not be a number of 64 bits
  const double duration_ns = static_cast<double>(last_ns) - static_cast<double>(first_ns);
  return std::round(1e10 * static_cast<double>(count - 1) / duration_ns) / 10;
}

std::string ros1Type(const std::string& type) {
  const std::size_t place = type.find("/msg/");
  return place == std::string::npos ? type : type.substr(0, place) + type.substr(place + 4);
}

bool isBag(const std::string& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) return fs::exists(fs::path(path) / kMetadata, ignored);
  const std::string extension = fs::path(path).extension().string();
  return extension == ".bag" || extension == ".db3" || extension == ".mcap";
}

std::unique_ptr<Bag> openBag(const std::string& path) {
  std::vector<std::unique_ptr<Bag>> files;
  if (fs::is_directory(path))
    for (const std::string& file : filesOf(path)) files.push_back(openFile(file));
  else
    files.push_back(openFile(path));
  return std::make_unique<ChainedBag>(std::move(files));
}

}  // namespace lintel
