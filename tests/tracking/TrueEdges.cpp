// SPDX-License-Identifier: BSD-3-Clause
#include "TrueEdges.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "lintel/geometry/Rotation.h"
#include "lintel/sensing/GroundTruth.h"

namespace lintel::truth {
namespace {

constexpr double kNear_m = 0.05;

void eachRow(const std::string& path, const std::function<void(const std::vector<std::string>&)>& take) {
  std::ifstream in(path);
  if (!in) throw std::runtime_error(path + ": cannot be read");
  for (std::string row; std::getline(in, row);) {
    if (row.empty() || row[0] == '#') continue;
    std::vector<std::string> cells;
    std::istringstream stream(row);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    take(cells);
  }
}

/// The numbers of `key: [ ... ]`; empty without that key.
std::vector<double> numbersOf(const std::string& text, const std::string& key) {
  std::vector<double> numbers;
  const std::size_t at = text.find(key);
  if (at == std::string::npos) return numbers;
  const std::size_t open = text.find('[', at), close = text.find(']', at);
  std::string list = text.substr(open + 1, close - open - 1);
  std::replace(list.begin(), list.end(), ',', ' ');
  std::istringstream stream(list);
  for (double x; stream >> x;) numbers.push_back(x);
  return numbers;
}

}  // namespace

TrueEdges::TrueEdges(const std::string& recording, const Rig& rig) : camera_(rig.camera), T_b_c_(rig.T_b_c) {
  const std::string mav0 = recording + "/mav0/";
  eachRow(mav0 + "lines0/data.csv", [&](const std::vector<std::string>& c) {
    const auto at = [&](std::size_t i) { return std::stod(c.at(i)); };
    edges_[std::stoi(c.at(0))] = {{at(1), at(2), at(3)}, {at(4), at(5), at(6)}, c.size() > 8 ? c[8] : ""};
  });
  eachRow(mav0 + "lines0/visible.csv", [&](const std::vector<std::string>& c) {
    visible_.insert({std::stoll(c.at(0)), {std::stoi(c.at(1)), std::stoi(c.at(2))}});
  });
  poses_ = readGroundTruth(recording);
  if (poses_.empty()) throw std::runtime_error(recording + ": no true poses");

  std::ifstream in(mav0 + "arena.txt");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto k = numbersOf(text, "\nintrinsics:"), d = numbersOf(text, "\ndistortion_coefficients:"),
             T = numbersOf(text, "data:"), delay = numbersOf(text, "\ndelay:");
  if (k.size() != 4 || d.size() != 4 || T.size() != 16) return;  // the rig's camera is the true one
  camera_.fx = k[0], camera_.fy = k[1], camera_.cx = k[2], camera_.cy = k[3];
  camera_.k1 = d[0], camera_.k2 = d[1], camera_.p1 = d[2], camera_.p2 = d[3];
  Eigen::Matrix3d R;
  R << T[0], T[1], T[2], T[4], T[5], T[6], T[8], T[9], T[10];
  T_b_c_.q = Eigen::Quaterniond(R).normalized();
  T_b_c_.p = {T[3], T[7], T[11]};
  if (!delay.empty()) delay_s_ = delay[0];
}

bool TrueEdges::poseAt(std::int64_t t_ns, Pose& T_c_w) const {
  const std::int64_t t = t_ns + static_cast<std::int64_t>(1e9 * delay_s_);
  auto after = std::lower_bound(poses_.begin(), poses_.end(), t,
                                [](const auto& pose, std::int64_t time) { return pose.first < time; });
  if (after == poses_.end()) after = std::prev(after);
  if (after == poses_.begin()) ++after;
  const auto before = std::prev(after);
  if (after == poses_.end() || t < before->first - 6'000'000 || t > after->first + 6'000'000) return false;
  const double share = static_cast<double>(t - before->first) / static_cast<double>(after->first - before->first);
  const Pose &a = before->second, &b = after->second;
  Pose T_w_b;
  T_w_b.q = a.q * expRotation(share * logRotation(a.q.conjugate() * b.q));
  T_w_b.p = a.p + share * (b.p - a.p);
  T_c_w = (T_w_b * T_b_c_).inverse();
  return true;
}

Eigen::Vector3d TrueEdges::lineOf(const Edge& edge, const Pose& T_c_w) const {
  const double focal = camera_.meanFocal();
  Eigen::Vector3d n = (T_c_w * edge.start_w).cross(T_c_w * edge.end_w);
  n.z() *= focal;  // from normalised coordinates to undistorted pixels
  return n / n.head<2>().norm();
}

Eigen::Vector3d TrueEdges::lineAt(int id, std::int64_t t_ns) const {
  Pose T_c_w;
  return poseAt(t_ns, T_c_w) ? lineOf(edges_.at(id), T_c_w) : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

std::vector<SeenEdge> TrueEdges::seenAt(std::int64_t t_ns) const {
  std::vector<SeenEdge> seen;
  Pose T_c_w;
  if (!poseAt(t_ns, T_c_w)) return seen;
  const double focal = camera_.meanFocal();
  const auto range = visible_.equal_range(t_ns);
  for (auto it = range.first; it != range.second; ++it) {
    const auto [id, mask] = it->second;
    const Edge& edge = edges_.at(id);
    int first = 0, last = 4;  // each of the five points stands for a fifth
    while (first < 5 && !(mask & (1 << first))) ++first;
    while (last > first && !(mask & (1 << last))) --last;
    if (first > 4) continue;
    const auto at = [&](double share) -> Eigen::Vector3d {
      return T_c_w * Eigen::Vector3d(edge.start_w + share * (edge.end_w - edge.start_w));
    };
    Eigen::Vector3d a = at(first / 5.0), b = at((last + 1) / 5.0);
    if (a.z() < kNear_m && b.z() < kNear_m) continue;
    if (a.z() < kNear_m) a += (b - a) * (kNear_m - a.z()) / (b.z() - a.z());
    if (b.z() < kNear_m) b += (a - b) * (kNear_m - b.z()) / (a.z() - b.z());
    seen.push_back({id, focal * a.head<2>() / a.z(), focal * b.head<2>() / b.z(), lineOf(edge, T_c_w)});
  }
  return seen;
}

}  // namespace lintel::truth
