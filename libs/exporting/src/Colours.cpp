// SPDX-License-Identifier: BSD-3-Clause
#include "Colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "lintel/core/Formatted.h"
#include "lintel/core/Quantiles.h"

namespace lintel {

namespace {

// Seen on white, black, and the blue and grey backgrounds of MeshLab and SceneViewer3D.
constexpr Rgb kFree{230, 80, 40}, kConstrained{20, 165, 160}, kDegenerate{150, 150, 150}, kNoGroup{140, 140, 140};

// Neighbouring groups differ in hue; none is so light or dark that it is lost on white or black.
constexpr std::array<Rgb, 10> kGroups{{{220, 50, 47},
                                       {50, 160, 70},
                                       {38, 110, 210},
                                       {235, 150, 20},
                                       {140, 80, 200},
                                       {0, 170, 180},
                                       {200, 70, 150},
                                       {150, 160, 20},
                                       {170, 100, 50},
                                       {90, 90, 190}}};

constexpr std::array<Rgb, 5> kScale{{{110, 40, 160}, {60, 100, 200}, {30, 160, 140}, {120, 190, 60}, {250, 200, 30}}};
constexpr int kScaleSteps = 32;

double finiteOr0(double v) { return std::isfinite(v) ? v : 0; }

}  // namespace

Rgb scaleColour(double s) {
  const double step = std::round(std::clamp(s, 0.0, 1.0) * (kScaleSteps - 1)) / (kScaleSteps - 1) * (kScale.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(step), kScale.size() - 2);
  const double f = step - static_cast<double>(i);
  const auto mix = [f](int a, int b) { return static_cast<std::uint8_t>(std::lround(a + f * (b - a))); };
  const Rgb a = kScale[i], b = kScale[i + 1];
  return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

LineColouring::LineColouring(LineColour mode, const std::vector<const MapLine*>& lines) : mode_(mode) {
  if (mode != LineColour::kUncertainty && mode != LineColour::kHeight) return;
  std::vector<double> values;
  values.reserve(lines.size());
  for (const MapLine* line : lines) values.push_back(shown(*line));
  if (values.empty()) values.push_back(0);
  low_ = nearestQuantile(values, 0.02);
  high_ = std::max(nearestQuantile(values, 0.98), low_ + 1e-9);
}

double LineColouring::shown(const MapLine& line) const {
  if (mode_ == LineColour::kHeight) return finiteOr0(line.segment_w.midpoint().z());
  return std::log10(std::clamp(finiteOr0(line.sigma_distance_m), 1e-4, 1e2));
}

Rgb LineColouring::operator()(const MapLine& line) const {
  switch (mode_) {
    case LineColour::kKind:
      return line.degenerate && !line.constrained ? kDegenerate : line.constrained ? kConstrained : kFree;
    case LineColour::kGroup:
      return line.group < 0 ? kNoGroup : kGroups[static_cast<std::size_t>(line.group) % kGroups.size()];
    case LineColour::kUncertainty:
    case LineColour::kHeight:
      break;
  }
  return scaleColour((shown(line) - low_) / (high_ - low_));
}

std::vector<std::pair<std::string, Rgb>> LineColouring::legend(const std::vector<const MapLine*>& lines,
                                                               const GroupNames& names) const {
  std::map<std::string, Rgb> found;
  for (const MapLine* line : lines) {
    if (mode_ == LineColour::kKind)
      found[line->constrained ? "direction from group" : line->degenerate ? "degenerate" : "free"] = (*this)(*line);
    if (mode_ == LineColour::kGroup) found[names(line->group)] = (*this)(*line);
  }
  std::vector<std::pair<std::string, Rgb>> entries(found.begin(), found.end());
  const bool scale = mode_ == LineColour::kUncertainty || mode_ == LineColour::kHeight;
  for (const double share : {0.0, 0.5, 1.0}) {
    if (!scale || lines.empty()) break;
    const double value = low_ + share * (high_ - low_);
    entries.emplace_back(formatted(mode_ == LineColour::kHeight ? "z %.2f m" : "sigma %.2g m",
                                   mode_ == LineColour::kHeight ? value : std::pow(10, value)),
                         scaleColour(share));
  }
  return entries;
}

}  // namespace lintel
