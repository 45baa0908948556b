// SPDX-License-Identifier: BSD-3-Clause
#include "RunAlignment.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "lintel/geometry/Rotation.h"

namespace lintel {

namespace {

constexpr double kSame_m = 0.1, kSameShare = 0.03;  // beside that share of the distance of the points
constexpr double kSame_rad = 0.03;
constexpr double kDriftShare = 0.02;  // of the way between two pairs: the odometry of both runs drifts
constexpr int kTimesRunnerUp = 2;

using Places = std::vector<std::size_t>;  // of pairs

/// The nearest pose that keeps the vertical and takes `p` to the same place.
Pose upright(const Pose& T, const Eigen::Vector3d& p) {
  const Eigen::Quaterniond q(Eigen::AngleAxisd(yawOf(T.q), Eigen::Vector3d::UnitZ()));
  return {q, T * p - q * p};
}

bool agrees(const RunPair& pair, const Pose& T, double allowance_m) {
  const double limit_m = kSame_m + kSameShare * pair.distance_m + allowance_m;
  return (T * pair.p_later - pair.earlier_from_later * pair.p_later).norm() < limit_m &&
         std::abs(yawOf(T.q.conjugate() * pair.earlier_from_later.q)) < kSame_rad;
}

Places agreeing(const std::vector<RunPair>& pairs, const Places& among, const RunPair& with) {
  const Pose T = upright(with.earlier_from_later, with.p_later);
  Places found;
  for (const std::size_t i : among) {
    const double way_m = std::abs(pairs[i].earlier_travelled_m - with.earlier_travelled_m) +
                         std::abs(pairs[i].later_travelled_m - with.later_travelled_m);
    if (agrees(pairs[i], T, kDriftShare * way_m)) found.push_back(i);
  }
  return found;
}

int keyframesOf(const std::vector<RunPair>& pairs, const Places& places) {
  std::set<std::size_t> later;
  for (const std::size_t i : places) later.insert(pairs[i].later);
  return static_cast<int>(later.size());
}

/// Most keyframes that agree; of equally many the first.
Places largestAgreement(const std::vector<RunPair>& pairs, const Places& among) {
  Places best;
  int most = 0;
  for (const std::size_t i : among) {
    Places found = agreeing(pairs, among, pairs[i]);
    const int n = keyframesOf(pairs, found);
    if (n <= most) continue;
    most = n;
    best = std::move(found);
  }
  return best;
}

Pose meanOf(const std::vector<RunPair>& pairs, const Places& places) {
  const double first = yawOf(pairs[places.front()].earlier_from_later.q);
  double turned = 0;
  for (const std::size_t i : places) {
    const double yaw = yawOf(pairs[i].earlier_from_later.q) - first;
    turned += std::remainder(yaw, 2 * M_PI);
  }
  const double yaw = first + turned / static_cast<double>(places.size());
  Pose mean{Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ())), Eigen::Vector3d::Zero()};
  for (const std::size_t i : places)
    mean.p += pairs[i].earlier_from_later * pairs[i].p_later - mean.q * pairs[i].p_later;
  mean.p /= static_cast<double>(places.size());
  return mean;
}

/// What the pairs of two runs say.
struct Edge {
  int earlier_run = 0, later_run = 0, keyframes = 0;
  Pose earlier_from_later;
  Places places;
};

/// Empty when they say nothing that can be believed; the pairs then have the reason.
std::optional<Edge> edgeOf(std::vector<RunPair>& pairs, const Places& among, int min_keyframes,
                           const std::function<bool(int, int, const Pose&)>& possible) {
  const auto refuse = [&](const Places& places, const char* reason) {
    for (const std::size_t i : places) pairs[i].refusal = reason;
  };
  Edge edge{pairs[among.front()].earlier_run, pairs[among.front()].later_run, 0, {}, largestAgreement(pairs, among)};
  edge.keyframes = keyframesOf(pairs, edge.places);
  edge.earlier_from_later = meanOf(pairs, edge.places);
  Places others;
  std::set_difference(among.begin(), among.end(), edge.places.begin(), edge.places.end(), std::back_inserter(others));
  const int runner_up = others.empty() ? 0 : keyframesOf(pairs, largestAgreement(pairs, others));
  refuse(others, "most pairs of the two pieces say otherwise");
  if (edge.keyframes < min_keyframes) {
    refuse(edge.places, "too few keyframes of the two pieces agree");
  } else if (edge.keyframes < kTimesRunnerUp * runner_up) {
    refuse(edge.places, "the two pieces fit in more than one way");
  } else if (!possible(edge.earlier_run, edge.later_run, edge.earlier_from_later)) {
    refuse(edge.places, "the two pieces cannot be so far apart");
  } else {
    return edge;
  }
  return std::nullopt;
}

/// Runs that hang together.
class Worlds {
 public:
  const RunAlignment& of(int run) { return runs_.try_emplace(run, RunAlignment{run, run, {}, 0}).first->second; }

  /// False when both are of one world already.
  bool join(const Edge& edge) {
    RunAlignment a = of(edge.earlier_run), b = of(edge.later_run);
    if (a.world == b.world) return false;
    Pose T_a_b = a.world_from_run * edge.earlier_from_later * b.world_from_run.inverse();
    if (b.world < a.world) {
      std::swap(a, b);
      T_a_b = T_a_b.inverse();
    }
    const int gone = b.world;
    for (auto& [run, alignment] : runs_) {
      if (alignment.world != gone) continue;
      alignment.world = a.world;
      alignment.world_from_run = T_a_b * alignment.world_from_run;
      if (alignment.keyframes == 0) alignment.keyframes = edge.keyframes;
    }
    return true;
  }

  std::vector<RunAlignment> moved() const {
    std::vector<RunAlignment> result;
    for (const auto& [run, alignment] : runs_)
      if (alignment.world != run) result.push_back(alignment);
    return result;
  }

 private:
  std::map<int, RunAlignment> runs_;
};

}  // namespace

std::vector<RunAlignment> alignRuns(std::vector<RunPair>& pairs, int min_keyframes,
                                    const std::function<bool(int, int, const Pose&)>& possible) {
  std::map<std::pair<int, int>, Places> of_runs;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (pairs[i].refusal.empty()) of_runs[{pairs[i].earlier_run, pairs[i].later_run}].push_back(i);
  std::vector<Edge> edges;
  for (const auto& [runs, among] : of_runs)
    if (auto edge = edgeOf(pairs, among, min_keyframes, possible)) edges.push_back(std::move(*edge));
  std::stable_sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.keyframes > b.keyframes; });
  Worlds worlds;
  std::vector<const Edge*> closing;
  for (const Edge& edge : edges)
    if (!worlds.join(edge)) closing.push_back(&edge);
  for (const Edge* edge : closing) {
    const Pose T = worlds.of(edge->earlier_run).world_from_run.inverse() * worlds.of(edge->later_run).world_from_run;
    for (const std::size_t i : edge->places) {
      const double way_m = pairs[i].earlier_travelled_m + pairs[i].later_travelled_m;
      if (!agrees(pairs[i], T, kSame_m + kDriftShare * way_m))
        pairs[i].refusal = "most pairs of the two pieces say otherwise";
    }
  }
  return worlds.moved();
}

}  // namespace lintel
