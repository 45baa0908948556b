// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/pages/Plots.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lintel/core/Formatted.h"

namespace lintel {

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kTruthColour = "#9a9a9a";
constexpr std::size_t kMostPoints = 1000;     // of a curve through poses: a figure has fewer pixels
constexpr std::int64_t kGap_ns = 1000000000;  // a line is interrupted where poses are farther apart

double secondsBetween(std::int64_t from_ns, std::int64_t to_ns) { return 1e-9 * static_cast<double>(to_ns - from_ns); }

/// A curve through poses, interrupted at gaps.
template <class PointOf>
Curve curveThrough(const NamedTrajectory& trajectory, const PointOf& pointOf) {
  std::vector<PlotPoint> points;
  const StampedPoses& poses = trajectory.poses;
  const std::size_t step = std::max<std::size_t>(1, (poses.size() + kMostPoints - 1) / kMostPoints);
  for (std::size_t i = 0; i < poses.size(); i += step) {
    if (i >= step && poses[i].first - poses[i - step].first > kGap_ns + static_cast<std::int64_t>(step) * kGap_ns / 10)
      points.push_back({kNothing, kNothing});
    points.push_back(pointOf(poses[i]));
  }
  Curve curve{trajectory.name, points};
  curve.colour = trajectory.colour;
  if (trajectory.name == "truth") {
    curve.colour = kTruthColour;
    curve.width = 2.5;
  }
  return curve;
}

void addSegment(Curve& curve, const Segment3& segment) {
  curve.points.push_back({segment.start.x(), segment.start.y()});
  curve.points.push_back({segment.end.x(), segment.end.y()});
}

}  // namespace

StampedPoses moved(const StampedPoses& poses, const Similarity& S_a_b) {
  StampedPoses result = poses;
  for (auto& stamped : result) stamped.second = {S_a_b.T_a_b.q * stamped.second.q, S_a_b * stamped.second.p};
  return result;
}

Figure topView(const std::vector<NamedTrajectory>& trajectories) {
  Figure figure{"", "x [m]", "y [m]"};
  for (const NamedTrajectory& t : trajectories)
    figure.curves.push_back(curveThrough(t, [](const auto& s) { return PlotPoint{s.second.p.x(), s.second.p.y()}; }));
  figure.equal_axes = true;
  figure.height_px = 540;
  return figure;
}

Figure heightOverTime(const std::vector<NamedTrajectory>& trajectories, std::int64_t t0_ns) {
  Figure figure{"", "time [s]", "height [m]"};
  for (const NamedTrajectory& t : trajectories)
    figure.curves.push_back(curveThrough(t, [&](const auto& s) {
      return PlotPoint{secondsBetween(t0_ns, s.first), s.second.p.z()};
    }));
  figure.height_px = 260;
  return figure;
}

Figure errorOverTime(const NamedErrors& errors) {
  Figure figure{"", "time [s]", "position error [m]"};
  std::int64_t t0_ns = std::numeric_limits<std::int64_t>::max();
  for (const auto& [name, e] : errors)
    if (!e.series.empty()) t0_ns = std::min(t0_ns, e.series.front().first);
  for (const auto& [name, e] : errors) {
    std::vector<PlotPoint> points;
    for (const auto& [t_ns, error_m] : e.series) points.push_back({secondsBetween(t0_ns, t_ns), error_m});
    figure.curves.push_back({name, thinned(points)});
  }
  figure.from_zero = true;
  figure.height_px = 300;
  return figure;
}

Figure errorWithSigma(const Consistency& consistency, int axis) {
  Figure figure{"", "time [s]", std::string("error in ") + "xyz"[axis] + " [m]"};
  Curve band{"3 sigma", {}, CurveStyle::kBand, plotColour(0)}, error{"error", {}, CurveStyle::kLine, "#000000", 1};
  const std::size_t count = consistency.series.size(), step = std::max<std::size_t>(1, count / kMostPoints);
  for (std::size_t i = 0; i < count; i += step) {
    const SigmaSample& sample = consistency.series[i];
    const double t_s = secondsBetween(consistency.series.front().t_ns, sample.t_ns);
    for (const int side : {1, -1}) band.points.push_back({t_s, side * 3 * sample.sigma_m[axis]});
    error.points.push_back({t_s, sample.error_m[axis]});
  }
  figure.curves = {band, error};
  figure.height_px = 260;
  return figure;
}

Figure relativeErrorBoxes(const NamedErrors& errors) {
  Figure figure{"", "length of the stretch", "translation error [% of the length]"};
  std::vector<double> lengths_m;
  for (const auto& [name, e] : errors)
    for (const RelativeErrors& r : e.relative)
      if (!r.whole_path && r.translation_m.count > 0) lengths_m.push_back(r.distance_m);
  std::sort(lengths_m.begin(), lengths_m.end());
  lengths_m.erase(std::unique(lengths_m.begin(), lengths_m.end()), lengths_m.end());
  for (const double length_m : lengths_m) {
    figure.x_names.push_back(formatted("%g m", length_m));
  }
  const double width = 0.8 / static_cast<double>(std::max<std::size_t>(1, errors.size()));
  for (std::size_t k = 0; k < errors.size(); ++k) {
    BoxSeries series{errors[k].first, {}};
    for (const RelativeErrors& r : errors[k].second.relative) {
      if (r.whole_path || r.translation_m.count == 0) continue;
      const auto place = std::lower_bound(lengths_m.begin(), lengths_m.end(), r.distance_m) - lengths_m.begin();
      const ErrorStatistics& s = r.translation_m;
      const double percent = 100 / r.distance_m;
      series.boxes.push_back(
          {static_cast<double>(place) + width * (static_cast<double>(k) + 0.5) - 0.4,
           0.8 * width,
           {percent * s.p05, percent * s.p25, percent * s.median, percent * s.p75, percent * s.p95}});
    }
    figure.boxes.push_back(series);
  }
  figure.from_zero = true;
  return figure;
}

Figure mapFromAbove(const LineMap& map, const Similarity& S_a_map, const std::vector<TrueLine>& truth,
                    const StampedPoses& trajectory) {
  Figure figure{"", "x [m]", "y [m]"};
  Curve edges{"true edges", {}, CurveStyle::kSegments, "#c8c8c8", 1};
  for (const TrueLine& line : truth) addSegment(edges, line.segment_w);
  Curve well{"lines", {}, CurveStyle::kSegments, plotColour(0), 1.5};
  Curve degenerate{"degenerate", {}, CurveStyle::kSegments, plotColour(1), 1.5};
  Curve constrained{"constrained", {}, CurveStyle::kSegments, plotColour(2), 1.5};
  for (const MapLine& line : map.lines) {
    const Segment3 segment{S_a_map * line.segment_w.start, S_a_map * line.segment_w.end};
    addSegment(line.constrained ? constrained : line.degenerate ? degenerate : well, segment);
  }
  figure.curves = {edges, well, degenerate, constrained};
  if (!trajectory.empty()) {
    figure.curves.push_back(curveThrough({"flight", trajectory, "#000000"}, [](const auto& s) {
      return PlotPoint{s.second.p.x(), s.second.p.y()};
    }));
    figure.curves.back().width = 0.8;
  }
  figure.equal_axes = true;
  figure.height_px = 560;
  return figure;
}

}  // namespace lintel
