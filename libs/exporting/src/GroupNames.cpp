// SPDX-License-Identifier: BSD-3-Clause
#include "GroupNames.h"

#include <set>

namespace lintel {

namespace {

constexpr char kNoGroup[] = "no group";
constexpr std::size_t kLongest = 16;  // with "LINES_" and a number within the 31 characters of a layer of DXF R12

std::string placeName(std::size_t group) { return "group " + std::to_string(group); }

std::string spellable(const std::string& name) {
  std::string out = name.substr(0, kLongest);
  for (char& c : out) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!plain && c != ' ' && c != '-' && c != '.') c = '_';
  }
  return out;
}

/// Forms differ in what they tell apart: some write capitals only, some no blanks.
std::string plainest(std::string name) {
  for (char& c : name)
    c = c == ' ' || c == '-' || c == '.' ? '_' : c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return name;
}

}  // namespace

GroupNames::GroupNames(const LineMap& map) {
  std::set<std::string> taken{plainest(kNoGroup)};
  for (std::size_t i = 0; i < map.groups.size(); ++i) {
    std::string name = spellable(map.groups[i].name);
    if (name.empty()) name = placeName(i);
    const std::string wanted = name;
    for (std::size_t k = i; !taken.insert(plainest(name)).second; ++k) name = wanted + "-" + std::to_string(k);
    names_.push_back(std::move(name));
  }
}

std::string GroupNames::operator()(int group) const {
  if (group < 0) return kNoGroup;
  const auto place = static_cast<std::size_t>(group);
  return place < names_.size() ? names_[place] : placeName(place);
}

}  // namespace lintel
