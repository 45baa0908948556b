// SPDX-License-Identifier: BSD-3-Clause
#include "LoopSection.h"

#include <algorithm>
#include <map>

#include "Degrees.h"
#include "lintel/core/Quantiles.h"
#include "lintel/pages/Plots.h"

namespace lintel {

namespace {

constexpr std::int64_t kSameVisit_ns = 2'000'000'000;
constexpr std::size_t kMostRows = 40;

/// Pairs of one stretch of the flight with one earlier stretch.
struct Visit {
  std::int64_t earlier_first_ns, earlier_last_ns, later_first_ns, later_last_ns;
  int pairs = 0, most_points = 0;
  std::vector<double> before_m{}, after_m{}, turned_rad{};

  bool continues(const PlacePair& pair) const {
    return pair.later_ns - later_last_ns <= kSameVisit_ns && pair.earlier_ns >= earlier_first_ns - kSameVisit_ns &&
           pair.earlier_ns <= earlier_last_ns + kSameVisit_ns;
  }
};

/// Where the estimate was interrupted: which stretches are in one frame.
void pieces(HtmlPage& page, const OdometryResult& result) {
  const std::vector<MapPiece>& all = result.map.pieces;
  if (all.size() < 2) return;
  const auto seconds = [&](std::int64_t t_ns) {
    return fixedText(1e-9 * static_cast<double>(t_ns - result.statistics.first_frame_ns), 1);
  };
  Table table{"pieces", "Pieces between interruptions", {"piece", "from [s]", "to [s]", "in the frame of"}, {}, {}};
  std::vector<std::string> apart;
  for (std::size_t p = 0; p < all.size(); ++p) {
    const std::string name = std::to_string(p + 1);
    const bool joined = all[p].world != static_cast<int>(p);
    table.rows.push_back({name, seconds(all[p].first_ns), seconds(all[p].last_ns),
                          joined   ? "piece " + std::to_string(all[p].world + 1)
                          : p == 0 ? "-"
                                   : "its own"});
    if (p > 0 && !joined) apart.push_back(name);
  }
  page.table(table);
  std::string names;
  for (const std::string& name : apart) names += (names.empty() ? "" : ", ") + name;
  if (!apart.empty())
    page.warnings({"No place of piece " + names +
                   " was found in those before: where it lies against them is not known, " +
                   "it begins where the estimate had ended."});
}

std::vector<Visit> visitsOf(const LoopResult& loops) {
  std::vector<Visit> visits;
  std::size_t accepted = 0;
  for (const PlacePair& pair : loops.places.pairs) {
    if (!pair.refusal.empty() || pair.joinsRuns()) continue;
    auto visit = std::find_if(visits.begin(), visits.end(), [&](const Visit& v) { return v.continues(pair); });
    if (visit == visits.end())
      visit = visits.insert(visits.end(), {pair.earlier_ns, pair.earlier_ns, pair.later_ns, pair.later_ns});
    visit->earlier_first_ns = std::min(visit->earlier_first_ns, pair.earlier_ns);
    visit->earlier_last_ns = std::max(visit->earlier_last_ns, pair.earlier_ns);
    visit->later_last_ns = pair.later_ns;
    ++visit->pairs;
    visit->most_points = std::max(visit->most_points, pair.points);
    visit->before_m.push_back(pair.drift_m);
    visit->turned_rad.push_back(pair.drift_rad);
    if (accepted < loops.drift_after_m.size()) visit->after_m.push_back(loops.drift_after_m[accepted]);
    ++accepted;
  }
  return visits;
}

Table visitsTable(std::vector<Visit> visits, std::int64_t t0_ns) {
  const auto seconds = [&](std::int64_t first_ns, std::int64_t last_ns) {
    const auto text = [&](std::int64_t t_ns) { return fixedText(1e-9 * static_cast<double>(t_ns - t0_ns), 1); };
    return text(first_ns) + " to " + text(last_ns);
  };
  Table table{
      "loops",
      "Stretches of the flight that show a place seen before",
      {"at [s]", "as at [s]", "pairs of images", "points, most", "drift before [m]", "turned [deg]", "drift after [m]"},
      {},
      {"Drift: how far the trajectory contradicts what two images say; median over the pairs. Before: of the "
       "causal trajectory, after: of the refined one."}};
  if (visits.size() > kMostRows) {
    table.notes.push_back(std::to_string(visits.size() - kMostRows) + " more are not listed.");
    visits.erase(visits.begin() + kMostRows, visits.end());
  }
  for (Visit& v : visits)
    table.rows.push_back({seconds(v.later_first_ns, v.later_last_ns), seconds(v.earlier_first_ns, v.earlier_last_ns),
                          std::to_string(v.pairs), std::to_string(v.most_points), fixedText(upperMedian(v.before_m), 3),
                          fixedText(kDegrees * upperMedian(v.turned_rad), 2),
                          v.after_m.empty() ? "-" : fixedText(upperMedian(v.after_m), 3)});
  return table;
}

/// Lines between the places where the pairs' images were taken, over the trajectory from above.
Figure pairsFromAbove(const OdometryResult& result) {
  const bool refined = !result.refined_trajectory.empty();
  const std::vector<OdometryPose>& trajectory = refined ? result.refined_trajectory : result.trajectory;
  StampedPoses poses;
  std::map<std::int64_t, Eigen::Vector3d> places;
  for (const OdometryPose& pose : trajectory) {
    poses.emplace_back(pose.t_ns, pose.T_w_b);
    places[pose.t_ns] = pose.T_w_b.p;
  }
  Curve pairs{"the same place", {}, CurveStyle::kSegments, plotColour(1)};
  for (const PlacePair& pair : result.loops.places.pairs) {
    if (!pair.refusal.empty() || places.count(pair.earlier_ns) + places.count(pair.later_ns) < 2) continue;
    for (const std::int64_t t_ns : {pair.earlier_ns, pair.later_ns})
      pairs.points.push_back({places[t_ns].x(), places[t_ns].y()});
  }
  Figure figure = topView({{refined ? "refined" : "causal", poses, plotColour(0)}});
  figure.curves.push_back(pairs);
  return figure;
}

void refusals(HtmlPage& page, const LoopResult& loops) {
  std::map<std::string, int> reasons;
  for (const PlacePair& pair : loops.places.pairs)
    if (!pair.refusal.empty()) ++reasons[pair.refusal];
  if (reasons.empty()) return;
  std::vector<std::string> items;
  items.reserve(reasons.size());
  for (const auto& [reason, n] : reasons) items.push_back(std::to_string(n) + ": " + reason);
  page.paragraph("Pairs of images that look alike and were refused:");
  page.list(items);
}

}  // namespace

void loopSection(HtmlPage& page, const OdometryResult& result) {
  const LoopResult& loops = result.loops;
  pieces(page, result);
  if (!loops.searched) return;
  page.heading("Places seen again");
  const std::vector<Visit> visits = visitsOf(loops);
  page.paragraph(std::to_string(loops.drift_before_m.size()) + " pairs of " + std::to_string(loops.places.described) +
                 " images show the same place; " + std::to_string(loops.places.same.size()) +
                 " points were tracked there both times, and " + std::to_string(result.refinement.joined) +
                 " of them are one point in the refined map.");
  if (result.refinement.joins_refused)
    page.warnings({"The refinement failed its checks with the points seen again, and was done without them."});
  if (!visits.empty()) {
    page.figure(pairsFromAbove(result), "From above, with lines between the images of one place");
    page.table(visitsTable(visits, result.statistics.first_frame_ns));
  }
  refusals(page, loops);
}

}  // namespace lintel
