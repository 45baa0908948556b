// SPDX-License-Identifier: BSD-3-Clause
// MCAP files (mcap.dev/spec): records of one byte for the kind, eight for the length, and content; little endian.
#include <map>
#include <utility>

#include "Bag.h"
#include "ByteReader.h"
#include "Decompress.h"
#include "RecordFile.h"
#include "lintel/sensing/Recording.h"

namespace lintel {
namespace {

constexpr std::uint8_t kFooter = 0x02, kSchema = 0x03, kChannel = 0x04, kMessage = 0x05, kChunk = 0x06;
constexpr char kMagic[] = "\x89MCAP0\r\n";
constexpr std::size_t kMagicSize = 8;

struct Channel {
  std::string topic, encoding, type;
};

/// A view of a record.
struct Record {
  std::uint8_t kind = 0;
  ByteReader content;
};

/// The records of a file in its order, those within chunks too. What is needed of schemas and channels is kept.
class McapScanner {
 public:
  explicit McapScanner(const std::string& path) : path_(path), file_(path) {
    char magic[kMagicSize];
    if (!file_.read(magic, kMagicSize) || std::string(magic, kMagicSize) != std::string(kMagic, kMagicSize))
      throw RecordingError(path + ": no MCAP file, or cut: record it anew");
  }

  /// The next message: its channel, time of recording and bytes, which stay valid until the next call; false at the
  /// end.
  bool next() {
    try {
      while (const std::optional<Record> record = nextRecord())
        if (take(*record)) return true;
      return false;
    } catch (const ByteReader::OutOfBytes&) {
      fail();
    }
  }

  std::uint16_t channel() const { return channel_; }
  std::int64_t recorded_ns() const { return recorded_ns_; }
  const ByteReader& bytes() const { return bytes_; }
  const std::map<std::uint16_t, Channel>& channels() const { return channels_; }
  [[noreturn]] void fail() const {
    throw RecordingError(path_ + ": cut or damaged: repair it with mcap recover, or record it anew");
  }

 private:
  std::optional<Record> nextRecord() {
    in_chunk_ = within_.remaining() > 0;
    if (in_chunk_) return recordIn(within_);
    if (ended_) return std::nullopt;
    std::uint8_t head[9];
    if (!file_.read(head, sizeof head)) fail();  // a whole file ends with a footer
    ByteReader reader(head, sizeof head);
    const auto kind = reader.get<std::uint8_t>();
    ended_ = kind == kFooter;
    if (ended_) return std::nullopt;
    const auto length = reader.get<std::uint64_t>();
    if (kind != kSchema && kind != kChannel && kind != kMessage && kind != kChunk) {
      if (!file_.skip(length)) fail();
      return Record{};
    }
    if (!file_.read(length, outer_)) fail();
    return Record{kind, ByteReader(outer_.data(), outer_.size())};
  }

  static Record recordIn(ByteReader& reader) {
    const auto kind = reader.get<std::uint8_t>();
    const auto length = reader.get<std::uint64_t>();
    return {kind, reader.part(length)};
  }

  /// Whether the record was a message.
  bool take(const Record& record) {
    ByteReader in = record.content;
    switch (record.kind) {
      case kSchema:
        takeSchema(in);
        return false;
      case kChannel:
        takeChannel(in);
        return false;
      case kChunk:
        if (in_chunk_) fail();
        openChunk(in);
        return false;
      case kMessage:
        channel_ = in.get<std::uint16_t>();
        in.get<std::uint32_t>();  // sequence
        recorded_ns_ = static_cast<std::int64_t>(in.get<std::uint64_t>());
        in.get<std::uint64_t>();  // time of publication
        bytes_ = in;
        return true;
      default:
        return false;
    }
  }

  void takeSchema(ByteReader& in) {
    const auto id = in.get<std::uint16_t>();
    schemas_[id] = in.text();
  }

  void takeChannel(ByteReader& in) {
    const auto id = in.get<std::uint16_t>(), schema = in.get<std::uint16_t>();
    Channel channel;
    channel.topic = in.text();
    channel.encoding = in.text();
    channel.type = ros1Type(schemas_[schema]);
    channels_[id] = channel;
  }

  void openChunk(ByteReader& in) {
    in.get<std::uint64_t>();  // times of the first and of the last message
    in.get<std::uint64_t>();
    const auto size = in.get<std::uint64_t>();
    in.get<std::uint32_t>();  // CRC of the decompressed bytes; 0 where there is none
    const std::string compression = in.text();
    ByteReader packed = in.part(in.get<std::uint64_t>());
    if (!decompress(compression, packed, size, inner_))
      throw RecordingError(path_ + ": a chunk (compression '" + compression +
                           "') is damaged: repair it with mcap recover");
    within_ = ByteReader(inner_.data(), inner_.size());
  }

  std::string path_;
  RecordFile file_;
  bool ended_ = false, in_chunk_ = false;
  std::vector<std::uint8_t> outer_, inner_;
  ByteReader within_;
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::uint16_t channel_ = 0;
  std::int64_t recorded_ns_ = 0;
  ByteReader bytes_;
};

class McapReader final : public BagReader {
 public:
  McapReader(const std::string& path, std::string topic) : scanner_(path), topic_(std::move(topic)) {}

  std::optional<BagMessage> next() override {
    while (scanner_.next()) {
      const auto channel = scanner_.channels().find(scanner_.channel());
      if (channel == scanner_.channels().end()) scanner_.fail();
      if (channel->second.topic != topic_) continue;
      const ByteReader& bytes = scanner_.bytes();
      return BagMessage{scanner_.recorded_ns(),
                        std::make_shared<std::vector<std::uint8_t>>(bytes.begin(), bytes.end())};
    }
    return std::nullopt;
  }

 private:
  McapScanner scanner_;
  std::string topic_;
};

class McapBag final : public Bag {
 public:
  /// Reads the whole file once: its summary at the end is optional.
  explicit McapBag(const std::string& path) : path_(path) {
    McapScanner scanner(path);
    std::map<std::string, BagTopic> topics;
    while (scanner.next()) {
      const auto found = scanner.channels().find(scanner.channel());
      if (found == scanner.channels().end()) scanner.fail();
      const Channel& channel = found->second;
      if (channel.encoding != "cdr" && channel.encoding != "ros1") continue;
      BagTopic& topic = topics[channel.topic];
      if (topic.count++ == 0) {
        topic.name = channel.topic;
        topic.type = channel.type;
        topic.encoding = channel.encoding == "cdr" ? BagEncoding::kCdr : BagEncoding::kRos1;
        topic.first_ns = scanner.recorded_ns();
      }
      topic.last_ns = scanner.recorded_ns();
    }
    for (auto& [name, topic] : topics) topics_.push_back(std::move(topic));
  }

  const std::vector<BagTopic>& topics() const override { return topics_; }
  std::unique_ptr<BagReader> read(const std::string& topic) const override {
    return std::make_unique<McapReader>(path_, topic);
  }

 private:
  std::string path_;
  std::vector<BagTopic> topics_;
};

}  // namespace

std::unique_ptr<Bag> openMcapBag(const std::string& path) { return std::make_unique<McapBag>(path); }

}  // namespace lintel
