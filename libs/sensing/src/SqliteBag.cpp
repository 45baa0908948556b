// SPDX-License-Identifier: BSD-3-Clause
#include <sqlite3.h>

#include "Bag.h"
#include "lintel/sensing/Recording.h"

namespace lintel {
namespace {

/// A rosbag2 database, opened for reading.
class Database {
 public:
  explicit Database(std::string path) : path_(std::move(path)) {
    // immutable: no lock or journal is written beside a recording, which may be on a medium that cannot be written
    const std::string uri = "file:" + escaped(path_) + "?immutable=1";
    if (sqlite3_open_v2(uri.c_str(), &database_, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr) != SQLITE_OK) {
      sqlite3_close(database_);
      throw RecordingError(path_ + ": cannot be opened: check its name");
    }
  }
  ~Database() { sqlite3_close(database_); }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  sqlite3* get() const { return database_; }
  [[noreturn]] void fail() const {
    throw RecordingError(path_ + ": no ROS 2 bag, or cut or damaged (" + sqlite3_errmsg(database_) +
                         "): repair it with sqlite3's .recover");
  }

 private:
  static std::string escaped(const std::string& path) {
    std::string uri;
    for (const char c : path) {
      if (c == '%')
        uri += "%25";
      else if (c == '?')
        uri += "%3f";
      else if (c == '#')
        uri += "%23";
      else
        uri += c;
    }
    return uri;
  }

  std::string path_;
  sqlite3* database_ = nullptr;
};

/// A query, row by row.
class Query {
 public:
  Query(const Database& database, const char* sql) : database_(database) {
    if (sqlite3_prepare_v2(database.get(), sql, -1, &statement_, nullptr) != SQLITE_OK) database_.fail();
  }
  ~Query() { sqlite3_finalize(statement_); }
  Query(const Query&) = delete;
  Query& operator=(const Query&) = delete;

  void bind(std::int64_t value) { sqlite3_bind_int64(statement_, 1, value); }
  bool step() {
    const int code = sqlite3_step(statement_);
    if (code != SQLITE_ROW && code != SQLITE_DONE) database_.fail();
    return code == SQLITE_ROW;
  }
  std::int64_t integer(int column) const { return sqlite3_column_int64(statement_, column); }
  std::string text(int column) const {
    const unsigned char* text = sqlite3_column_text(statement_, column);
    return text ? reinterpret_cast<const char*>(text) : "";
  }
  std::vector<std::uint8_t> blob(int column) const {
    const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(statement_, column));
    return data ? std::vector<std::uint8_t>(data, data + sqlite3_column_bytes(statement_, column))
                : std::vector<std::uint8_t>();
  }

 private:
  const Database& database_;
  sqlite3_stmt* statement_ = nullptr;
};

class SqliteReader final : public BagReader {
 public:
  SqliteReader(const std::string& path, std::int64_t topic)
      : database_(path),
        query_(database_, "SELECT timestamp, data FROM messages WHERE topic_id = ? ORDER BY timestamp, id") {
    query_.bind(topic);
  }
  std::optional<BagMessage> next() override {
    if (!query_.step()) return std::nullopt;
    return BagMessage{query_.integer(0), std::make_shared<std::vector<std::uint8_t>>(query_.blob(1))};
  }

 private:
  Database database_;
  Query query_;
};

class SqliteBag final : public Bag {
 public:
  explicit SqliteBag(const std::string& path) : path_(path) {
    const Database database(path);
    Query query(database,
                "SELECT t.id, t.name, t.type, t.serialization_format, count(m.id), min(m.timestamp), max(m.timestamp) "
                "FROM topics t LEFT JOIN messages m ON m.topic_id = t.id GROUP BY t.id ORDER BY t.name");
    while (query.step()) {
      if (query.text(3) != "cdr") continue;
      ids_.push_back(query.integer(0));
      topics_.push_back({query.text(1), ros1Type(query.text(2)), BagEncoding::kCdr,
                         static_cast<std::size_t>(query.integer(4)), query.integer(5), query.integer(6)});
    }
  }

  const std::vector<BagTopic>& topics() const override { return topics_; }
  std::unique_ptr<BagReader> read(const std::string& topic) const override {
    for (std::size_t i = 0; i < topics_.size(); ++i)
      if (topics_[i].name == topic) return std::make_unique<SqliteReader>(path_, ids_[i]);
    throw RecordingError(path_ + ": has no topic " + topic + ": name another");
  }

 private:
  std::string path_;
  std::vector<std::int64_t> ids_;
  std::vector<BagTopic> topics_;
};

}  // namespace

std::unique_ptr<Bag> openSqliteBag(const std::string& path) { return std::make_unique<SqliteBag>(path); }

}  // namespace lintel
