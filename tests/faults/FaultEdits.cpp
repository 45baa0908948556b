// SPDX-License-Identifier: BSD-3-Clause
#include "FaultEdits.h"

#include <zlib.h>

#include <algorithm>
#include <functional>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <sstream>
#include <stdexcept>

#include "MapChecksums.h"
#include "TinyEuroc.h"

namespace lintel::test {

namespace fs = std::filesystem;

namespace {

using Words = std::vector<std::string>;

std::string unescaped(const std::string& word) {
  static const std::map<char, char> kBytes{{'s', ' '},  {'n', '\n'}, {'r', '\r'},
                                           {'t', '\t'}, {'0', '\0'}, {'\\', '\\'}};
  std::string text;
  for (std::size_t i = 0; i < word.size(); ++i) {
    if (word[i] != '\\' || i + 1 == word.size()) {
      text += word[i];
    } else if (word[++i] == 'e') {
      continue;  // an empty word
    } else if (word[i] == 'x') {
      text += static_cast<char>(std::stoi(word.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      text += kBytes.at(word[i]);
    }
  }
  return text;
}

/// "37%" of `size`, or a number.
std::size_t placeIn(std::size_t size, const std::string& place) {
  const double number = std::stod(place);
  const double bytes = place.back() == '%' ? number / 100 * static_cast<double>(size) : number;
  return std::min(size, static_cast<std::size_t>(bytes));
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end =
        std::min(text.size(), text.find('\n', begin) + 1 == 0 ? text.size() : text.find('\n', begin) + 1);
    lines.push_back(text.substr(begin, end - begin));
    begin = end;
  }
  return lines;
}

/// Changes a table's rows, or those from one place to another (arguments 2 and 3).
std::string withRows(const std::string& text, const Words& w,
                     const std::function<void(Words&, std::size_t, std::size_t)>& change) {
  Words lines = linesOf(text), rows;
  const auto is_header = [](const std::string& line) { return line[0] == '#'; };
  const auto first = std::find_if_not(lines.begin(), lines.end(), is_header);
  rows.assign(first, lines.end());
  lines.erase(first, lines.end());
  const std::size_t from = w.size() > 2 ? placeIn(rows.size(), w[2]) : 0,
                    to = w.size() > 3 ? placeIn(rows.size(), w[3]) : rows.size();
  change(rows, std::min(from, rows.size() - 1), to);
  std::string result;
  for (const Words* part : {&lines, &rows})
    for (const std::string& line : *part) result += line;
  return result;
}

/// A row with its field `column` (from 0) changed.
std::string withField(const std::string& row, std::size_t column,
                      const std::function<std::string(const std::string&)>& change) {
  std::string body = row;
  std::string end;
  while (!body.empty() && (body.back() == '\n' || body.back() == '\r')) {
    end.insert(0, 1, body.back());
    body.pop_back();
  }
  std::istringstream in(body);
  std::string result;
  std::size_t k = 0;
  for (std::string field; std::getline(in, field, ','); ++k)
    result += (k ? "," : "") + (k == column ? change(field) : field);
  return result + end;
}

std::string utf16(const std::string& text) {
  std::string result = "\xff\xfe";
  for (const char c : text) (result += c) += '\0';
  return result;
}

std::string replaced(std::string text, const std::string& from, const std::string& to, bool all) {
  std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::runtime_error("there is no '" + from + "'");
  for (; at != std::string::npos; at = all ? text.find(from, at + to.size()) : std::string::npos)
    text.replace(at, from.size(), to);
  return text;
}

std::string withNoise(std::string text, unsigned seed, std::size_t count, std::size_t from) {
  std::mt19937 random(seed);
  for (std::size_t i = 0; i < count && from < text.size(); ++i) {
    const auto mask = static_cast<char>(1 + random() % 255);
    char& byte = text[from + random() % (text.size() - from)];
    byte = static_cast<char>(byte ^ mask);
  }
  return text;
}

std::string bomb(std::size_t megabytes) {
  const std::string zeros(1 << 20, '\0');
  z_stream stream{};
  deflateInit2(&stream, 1, Z_DEFLATED, 31, 8, Z_DEFAULT_STRATEGY);
  std::string packed, buffer(1 << 16, '\0');
  for (std::size_t i = 0; i <= megabytes; ++i) {
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(zeros.data()));
    stream.avail_in = i < megabytes ? static_cast<uInt>(zeros.size()) : 0;
    do {
      stream.next_out = reinterpret_cast<Bytef*>(buffer.data());
      stream.avail_out = static_cast<uInt>(buffer.size());
      deflate(&stream, i < megabytes ? Z_NO_FLUSH : Z_FINISH);
      packed.append(buffer, 0, buffer.size() - stream.avail_out);
    } while (stream.avail_out == 0);
  }
  deflateEnd(&stream);
  return packed;
}

std::string png(int width, int height, int grey, int type) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", cv::Mat(height, width, type, cv::Scalar::all(grey)), bytes);
  return {bytes.begin(), bytes.end()};
}

std::string drop(const std::string& text, const Words& w) {
  return withRows(text, w, [](Words& rows, std::size_t a, std::size_t b) {
    rows.erase(rows.begin() + static_cast<long>(a), rows.begin() + static_cast<long>(b));
  });
}

std::string repeat(const std::string& text, const Words& w) {
  return withRows(text, w, [](Words& rows, std::size_t a, std::size_t b) {
    const Words part(rows.begin() + static_cast<long>(a), rows.begin() + static_cast<long>(b));
    rows.insert(rows.begin() + static_cast<long>(b), part.begin(), part.end());
  });
}

std::string reverse(const std::string& text, const Words& w) {
  return withRows(text, w, [](Words& rows, std::size_t a, std::size_t b) {
    std::reverse(rows.begin() + static_cast<long>(a), rows.begin() + static_cast<long>(b));
  });
}

std::string field(const std::string& text, const Words& w) {
  return withRows(text, {w[0], w[1], w[2]}, [&](Words& rows, std::size_t a, std::size_t) {
    rows[a] = withField(rows[a], std::stoul(w[3]), [&](const std::string&) { return w[4]; });
  });
}

std::string fields(const std::string& text, const Words& w) {
  return withRows(text, {w[0], w[1], w[2], w[3]}, [&](Words& rows, std::size_t a, std::size_t b) {
    for (; a < b; ++a) rows[a] = withField(rows[a], std::stoul(w[4]), [&](const std::string&) { return w[5]; });
  });
}

std::string shift(const std::string& text, const Words& w) {
  return withRows(text, {w[0], w[1], w[2], w[3]}, [&](Words& rows, std::size_t a, std::size_t b) {
    for (; a < b; ++a)
      rows[a] =
          withField(rows[a], 0, [&](const std::string& t) { return std::to_string(std::stoll(t) + std::stoll(w[4])); });
  });
}

std::string row(const std::string& text, const Words& w) {
  return withRows(text, {w[0], w[1], w[2]}, [&](Words& rows, std::size_t a, std::size_t) {
    rows.insert(rows.begin() + static_cast<long>(a), w[3] + "\n");
  });
}

std::string zero(std::string text, const Words& w) {
  const std::size_t a = placeIn(text.size(), w[2]), b = placeIn(text.size(), w[3]);
  return text.replace(a, b - a, std::string(b - a, '\0'));
}

std::string noise(const std::string& text, const Words& w) {
  const auto seed = static_cast<unsigned>(std::stoul(w[2]));
  return withNoise(text, seed, std::stoul(w[3]), w.size() > 4 ? placeIn(text.size(), w[4]) : 0);
}

using Change = std::function<std::string(const std::string& text, const Words& words)>;

/// Verbs that make other bytes of a file's bytes.
const std::map<std::string, Change>& changes() {
  static const std::map<std::string, Change> kChanges{
      {"checksums", [](const std::string& t, const Words&) { return withRightChecksums(t); }},
      {"empty", [](const std::string&, const Words&) { return ""; }},
      {"write", [](const std::string&, const Words& w) { return w.at(2); }},
      {"cut", [](const std::string& t, const Words& w) { return t.substr(0, placeIn(t.size(), w.at(2))); }},
      {"behead", [](const std::string& t, const Words& w) { return t.substr(placeIn(t.size(), w.at(2))); }},
      {"zero", zero},
      {"noise", noise},
      {"append", [](const std::string& t, const Words& w) { return t + w.at(2); }},
      {"nest", [](const std::string&, const Words& w) { return std::string(std::stoul(w.at(2)), '['); }},
      {"prepend", [](const std::string& t, const Words& w) { return w.at(2) + t; }},
      {"double", [](const std::string& t, const Words&) { return t + t; }},
      {"replace", [](const std::string& t, const Words& w) { return replaced(t, w.at(2), w.at(3), false); }},
      {"replaceall", [](const std::string& t, const Words& w) { return replaced(t, w.at(2), w.at(3), true); }},
      {"utf16", [](const std::string& t, const Words&) { return utf16(t); }},
      {"drop", drop},
      {"repeat", repeat},
      {"reverse", reverse},
      {"field", field},
      {"fields", fields},
      {"shift", shift},
      {"row", row},
      {"bomb", [](const std::string&, const Words& w) { return bomb(std::stoul(w.at(2))); }},
      {"image", [](const std::string&,
                   const Words& w) { return png(std::stoi(w.at(2)), std::stoi(w.at(3)), std::stoi(w.at(4)), CV_8U); }},
      {"colour",
       [](const std::string&, const Words& w) { return png(std::stoi(w.at(2)), std::stoi(w.at(3)), 99, CV_8UC3); }},
      {"deep",
       [](const std::string&, const Words& w) { return png(std::stoi(w.at(2)), std::stoi(w.at(3)), 999, CV_16U); }}};
  return kChanges;
}

fs::path fileOf(const fs::path& root, std::string name) {
  if (const std::size_t at = name.find('@'); at != std::string::npos)
    name = name.substr(0, at) + std::to_string(TinyEuroc::frameStamp(std::stoi(name.substr(at + 1)))) + ".png";
  return root / name;
}

}  // namespace

std::vector<std::string> wordsOf(const std::string& line) {
  std::istringstream in(line);
  Words words;
  for (std::string word; in >> word;) words.push_back(unescaped(word));
  return words;
}

void applyEdit(const fs::path& root, const std::string& edit) {
  const Words words = wordsOf(edit);
  if (words.empty() || words[0] == "none") return;
  const fs::path file = fileOf(root, words.at(1));
  if (words[0] == "obs") return applyRawlogEdit(file.string(), words);
  if (words[0] == "map") return applyMapEdit(file.string(), words);
  if (words[0] == "remove") {
    if (fs::remove_all(file) == 0) throw std::runtime_error(file.string() + " is not there");
  } else if (words[0] == "folder") {
    fs::remove_all(file);
    fs::create_directories(file);
  } else if (words[0] == "link") {
    fs::remove_all(file);
    fs::create_symlink(words.at(2), file);
  } else if (words[0] == "move") {
    fs::rename(file, fileOf(root, words.at(2)));
  } else {
    const Change& change = changes().at(words[0]);
    writeText(file.string(), change(bytesOf(file), words));
  }
}

void applyEdits(const fs::path& root, const std::string& edits) {
  std::istringstream in(edits);
  for (std::string edit; std::getline(in, edit, ';');) applyEdit(root, edit);
}

}  // namespace lintel::test
