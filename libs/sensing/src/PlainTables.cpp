// SPDX-License-Identifier: BSD-3-Clause
#include "PlainTables.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

#include "SampleGate.h"
#include "TimeTicks.h"
#include "lintel/core/TextRows.h"
#include "lintel/sensing/Recording.h"

namespace lintel {
namespace {

constexpr double kGravity_m_s2 = 9.80665;
constexpr double kRadians = 3.14159265358979323846 / 180;

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

bool holds(const std::string& text, std::initializer_list<const char*> any) {
  return std::any_of(any.begin(), any.end(), [&](const char* word) { return text.find(word) != std::string::npos; });
}

/// A row that names columns: its first field is no number.
bool isHeader(const TextRows& rows) { return !rows.numberIfAny(0); }

std::vector<std::string> headings(const TextRows& rows) {
  std::vector<std::string> names;
  for (const std::string_view field : rows.fields()) names.push_back(lower(field));
  if (!names.empty() && !names.front().empty() && names.front().front() == '#') names.front().erase(0, 1);
  if (!names.empty() && names.front().empty()) names.erase(names.begin());  // "# time gx …"
  return names;
}

/// Which of the six values a heading names: 0 to 2 the gyroscope, 3 to 5 the accelerometer; -1 for none.
int valueOf(const std::string& heading) {
  const std::string name = heading.substr(0, heading.find_first_of("[("));
  const std::size_t axis_at = name.find_last_of("xyz");
  if (axis_at == std::string::npos) return -1;
  const int axis = name[axis_at] - 'x';
  if (holds(name, {"bias", "mag", "orient", "quat", "cov"})) return -1;
  const bool accel = holds(name, {"acc", "alpha", "a_rs", "linear"}) || name[0] == 'a';
  const bool angular = holds(name, {"gyr", "omega", "ang", "w_rs", "rot"}) || name[0] == 'g' || name[0] == 'w';
  if (angular) return axis;
  return accel ? 3 + axis : -1;
}

double unitOf(const std::string& heading, bool gyro) {
  if (gyro) return holds(heading, {"deg", "dps"}) ? kRadians : 1;
  if (holds(heading, {"[g]", "(g)", "_g"})) return kGravity_m_s2;
  return holds(heading, {"[mg]", "(mg)"}) ? 1e-3 * kGravity_m_s2 : 1;
}

struct ImuLayout {
  std::array<int, 6> column{-1, -1, -1, -1, -1, -1};
  std::array<double, 6> unit{1, 1, 1, 1, 1, 1};
  TimeUnit time = TimeUnit::kUnknown;
  std::size_t time_column = 0;
};

class ImuTable {
 public:
  ImuTable(const std::string& file, ImuColumns sensors)
      : rows_(file, throwError<RecordingError>),
        from_(sensors == ImuColumns::kAccel ? 3 : 0),
        to_(sensors == ImuColumns::kGyro ? 3 : 6) {
    for (int i = from_; i < to_; ++i) layout_.column[static_cast<std::size_t>(i)] = 1 + i - from_;
    while (rows_.next(false)) {
      pending_ = !isHeader(rows_);
      if (pending_) return;
      readHeader();
    }
    throw RecordingError(file + ": holds no samples: give a table with a time, angular rates and accelerations a line");
  }

  std::optional<ImuSample> next(const WarningSink& warn) {
    while (std::exchange(pending_, false) || rows_.next()) {
      std::optional<ImuSample> sample = read(warn);
      if (sample && gate_.admit(
                        *sample, [this] { return rows_.where(); }, warn))
        return sample;
    }
    return std::nullopt;
  }

 private:
  /// Comments that name no columns are left aside.
  void readHeader() {
    const std::vector<std::string> names = headings(rows_);
    ImuLayout named;
    int found = 0;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const int value = valueOf(names[i]);
      if (value < from_ || value >= to_ || named.column[static_cast<std::size_t>(value)] >= 0) continue;
      named.column[static_cast<std::size_t>(value)] = static_cast<int>(i);
      named.unit[static_cast<std::size_t>(value)] = unitOf(names[i], value < 3);
      ++found;
    }
    const auto time = std::find_if(names.begin(), names.end(), [](const std::string& name) {
      const std::string bare = name.substr(0, name.find_first_of("_ [("));
      return bare == "t" || holds(name, {"time", "stamp"});
    });
    if (time != names.end()) {
      named.time = timeUnitOf(*time);
      named.time_column = static_cast<std::size_t>(time - names.begin());
    }
    if (found == to_ - from_) layout_ = named;
    if (found > 0 && found < to_ - from_ && rows_.fields()[0].front() != '#')
      rows_.fail("the header names " + std::to_string(found) + " of " + std::to_string(to_ - from_) +
                 " values (gx gy gz, ax ay az): complete it");
  }

  std::optional<ImuSample> read(const WarningSink& warn) {
    double values[6] = {};
    const std::size_t t = layout_.time_column;
    const auto t_ns =
        t < rows_.fields().size() ? parseTime_ns(std::string(rows_.fields()[t]), layout_.time) : std::nullopt;
    bool complete = t_ns.has_value();
    for (std::size_t i = static_cast<std::size_t>(from_); i < static_cast<std::size_t>(to_); ++i) {
      const auto value = rows_.numberIfAny(static_cast<std::size_t>(layout_.column[i]));
      complete = complete && value.has_value();
      if (value) values[i] = *value * layout_.unit[i];
    }
    if (complete)
      return ImuSample{cutToTick(*t_ns), {values[0], values[1], values[2]}, {values[3], values[4], values[5]}};
    if (!rows_.isUnterminated()) rows_.fail("a time and its values are expected: repair or remove the line");
    warn(Fault::CutLine, rows_.where() + ": last line incomplete: skipped");
    return std::nullopt;
  }

  TextRows rows_;
  int from_, to_;  ///< of the six values
  ImuLayout layout_;
  bool pending_ = false;  ///< the present row has not been given
  ImuGate gate_;
};

/// Whole part and decimals of `text` in units of 10^-9 / `per_second` s.
std::optional<std::int64_t> decimal(const std::string& text, int decimals) {
  const std::size_t point = std::min(text.find('.'), text.size());
  std::string digits = text.substr(0, point), fraction = point < text.size() ? text.substr(point + 1) : "";
  if (!std::all_of(fraction.begin(), fraction.end(), [](unsigned char c) { return std::isdigit(c); }))
    return std::nullopt;
  fraction.resize(static_cast<std::size_t>(decimals), '0');
  digits += fraction;
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || value < 0) return std::nullopt;
  return value;
}

/// Times of this century are told by their size: 1.6e9 s.
TimeUnit unitBySize(const std::string& text) {
  if (text.find('.') != std::string::npos || text.size() <= 10) return TimeUnit::kSeconds;
  if (text.size() <= 13) return TimeUnit::kMilliseconds;
  return text.size() <= 16 ? TimeUnit::kMicroseconds : TimeUnit::kNanoseconds;
}

}  // namespace

TimeUnit timeUnitOf(const std::string& heading) {
  const std::string name = lower(heading);
  const auto ends = [&](const char* unit) {
    const std::string u(unit);
    for (const std::string& mark : {"[" + u + "]", "(" + u + ")"})
      if (name.find(mark) != std::string::npos) return true;
    const std::string tail = "_" + u;
    return name.size() > tail.size() && name.compare(name.size() - tail.size(), tail.size(), tail) == 0;
  };
  if (ends("ns") || ends("nsec")) return TimeUnit::kNanoseconds;
  if (ends("us") || ends("usec")) return TimeUnit::kMicroseconds;
  if (ends("ms") || ends("msec")) return TimeUnit::kMilliseconds;
  return ends("s") || ends("sec") ? TimeUnit::kSeconds : TimeUnit::kUnknown;
}

std::optional<std::int64_t> parseTime_ns(const std::string& text, TimeUnit unit) {
  if (unit == TimeUnit::kUnknown) unit = unitBySize(text);
  switch (unit) {
    case TimeUnit::kNanoseconds:
      return decimal(text, 0);
    case TimeUnit::kMicroseconds:
      return decimal(text, 3);
    case TimeUnit::kMilliseconds:
      return decimal(text, 6);
    default:
      return decimal(text, 9);
  }
}

std::vector<TimedImage> readImageTimes(const std::string& file) {
  TextRows rows(file, throwError<RecordingError>);
  std::vector<TimedImage> images;
  TimeUnit unit = TimeUnit::kUnknown;
  while (rows.next(false)) {
    const auto& fields = rows.fields();
    std::size_t at = 0;
    while (at < fields.size() && at < 2 && !rows.numberIfAny(at)) ++at;
    if (at == fields.size() || at == 2 || fields[0].front() == '#') {
      if (!images.empty() && fields[0].front() != '#') rows.fail("no time: repair or remove the line");
      for (const std::string& name : headings(rows))
        if (timeUnitOf(name) != TimeUnit::kUnknown) unit = timeUnitOf(name);
      continue;
    }
    const auto t_ns = parseTime_ns(std::string(fields[at]), unit);
    if (!t_ns) rows.fail("'" + std::string(fields[at]) + "' is no time: repair or remove the line");
    const std::size_t name_at = at == 0 ? 1 : 0;
    images.push_back({*t_ns, name_at < fields.size() ? std::string(fields[name_at]) : std::string()});
  }
  if (images.empty()) throw RecordingError(file + ": holds no times: give one a line");
  return images;
}

ImuSource openImuTable(const std::string& file, ImuColumns sensors) {
  const auto table = std::make_shared<ImuTable>(file, sensors);
  return [table](const WarningSink& warn) { return table->next(warn); };
}

}  // namespace lintel
