// SPDX-License-Identifier: BSD-3-Clause
#include "TrueEdges.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "lintel/core/TextRows.h"

namespace lintel::truth {
namespace {

constexpr double kNear_m = 0.05;

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

TrueEdges::TrueEdges(const std::string& recording, const Rig& rig, const TruePoses& poses)
    : camera_(rig.camera), T_b_c_(rig.T_b_c), poses_(poses) {
  if (poses_.empty()) throw std::runtime_error(recording + ": no true poses");
  const std::string mav0 = recording + "/mav0/";
  TextRows lines(mav0 + "lines0/data.csv", throwError<std::runtime_error>);
  while (lines.next()) {
    const auto at = [&](std::size_t i) { return lines.number(i); };
    const std::string kind = lines.fields().size() > 8 ? std::string(lines.fields()[8]) : "";
    edges_[static_cast<int>(lines.integer(0))] = {{at(1), at(2), at(3)}, {at(4), at(5), at(6)}, kind};
  }
  TextRows visible(mav0 + "lines0/visible.csv", throwError<std::runtime_error>);
  while (visible.next()) {
    const auto at = [&](std::size_t i) { return static_cast<int>(visible.integer(i)); };
    visible_.insert({visible.integer(0), {at(1), at(2)}});
  }

  std::ifstream in(mav0 + "arena.txt");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto k = numbersOf(text, "\nintrinsics:"), d = numbersOf(text, "\ndistortion_coefficients:"),
             T = numbersOf(text, "data:"), delay = numbersOf(text, "\ndelay:");
  if (k.size() != 4 || d.size() != 4 || T.size() != 16) return;  // the rig's camera is the true one
  camera_.fx = k[0], camera_.fy = k[1], camera_.cx = k[2], camera_.cy = k[3];
  std::copy(d.begin(), d.end(), camera_.lens.begin());
  Eigen::Matrix3d R;
  R << T[0], T[1], T[2], T[4], T[5], T[6], T[8], T[9], T[10];
  T_b_c_.q = Eigen::Quaterniond(R).normalized();
  T_b_c_.p = {T[3], T[7], T[11]};
  if (!delay.empty()) delay_s_ = delay[0];
}

std::optional<Pose> TrueEdges::poseAt(std::int64_t t_ns) const {
  const auto T_w_b = poses_.at(t_ns + static_cast<std::int64_t>(1e9 * delay_s_));
  if (!T_w_b) return std::nullopt;
  return (*T_w_b * T_b_c_).inverse();
}

Eigen::Vector3d TrueEdges::lineOf(const Edge& edge, const Pose& T_c_w) const {
  const double focal = camera_.meanFocal();
  Eigen::Vector3d n = (T_c_w * edge.start_w).cross(T_c_w * edge.end_w);
  n.z() *= focal;  // from normalised coordinates to undistorted pixels
  return n / n.head<2>().norm();
}

Eigen::Vector3d TrueEdges::lineAt(int id, std::int64_t t_ns) const {
  const auto T_c_w = poseAt(t_ns);
  return T_c_w ? lineOf(edges_.at(id), *T_c_w) : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

std::vector<SeenEdge> TrueEdges::seenAt(std::int64_t t_ns) const {
  std::vector<SeenEdge> seen;
  const auto T_c_w = poseAt(t_ns);
  if (!T_c_w) return seen;
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
      return *T_c_w * Eigen::Vector3d(edge.start_w + share * (edge.end_w - edge.start_w));
    };
    Eigen::Vector3d a = at(first / 5.0), b = at((last + 1) / 5.0);
    if (a.z() < kNear_m && b.z() < kNear_m) continue;
    if (a.z() < kNear_m) a += (b - a) * (kNear_m - a.z()) / (b.z() - a.z());
    if (b.z() < kNear_m) b += (a - b) * (kNear_m - b.z()) / (a.z() - b.z());
    seen.push_back({id, focal * a.head<2>() / a.z(), focal * b.head<2>() / b.z(), lineOf(edge, *T_c_w)});
  }
  return seen;
}

}  // namespace lintel::truth
