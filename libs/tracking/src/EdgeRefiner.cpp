// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeRefiner.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lintel {
namespace {

constexpr double kStep_px = 4;             ///< between samples along the line
constexpr double kMaxSteps = 50;           ///< on a long line they lie further apart
constexpr float kWeak = 0.3f;              ///< of the line's usual gradient: less is another edge, or none
constexpr float kMinGradient = 32 * 2.0f;  ///< 2 grey levels a pixel, in units of the derivative image
constexpr double kInlier_px = 0.8;         ///< of a sample's edge from the fitted line
constexpr double kMinSupport = 0.5;
constexpr double kFloor_px = 0.25;  ///< systematic: blur, sampling, lens model
constexpr double kBlur_px = 1;      ///< a blurred edge is predicted that much worse
constexpr int kMaxReach = 8;        ///< profiles reach this far at most

/// Edge candidates across the line at one place along it.
struct Sample {
  double s = 0;                    ///< along the line, from its start [px]
  std::array<double, 2> offset{};  ///< along the normal, the stronger one first [px]
  std::array<float, 2> gradient{};
  int candidates = 0;
  double fitted = 0;  ///< the candidate that the fit uses
  bool inlier = false;
};

/// Edge: offset(s) = alpha + beta * s.
struct Fit {
  double alpha = 0, beta = 0;
  double at(double s) const { return alpha + beta * s; }
};

/// Bilinear gradient at (x, y), taken along (nx, ny); the caller keeps a pixel from the border.
float gradientAlong(const cv::Mat& derivative, double x, double y, double nx, double ny) {
  const int ix = static_cast<int>(x), iy = static_cast<int>(y);
  const float fx = static_cast<float>(x - ix), fy = static_cast<float>(y - iy);
  const short* upper = derivative.ptr<short>(iy) + 2 * ix;
  const short* lower = derivative.ptr<short>(iy + 1) + 2 * ix;
  const float w00 = (1 - fx) * (1 - fy), w01 = fx * (1 - fy), w10 = (1 - fx) * fy, w11 = fx * fy;
  const float dx = w00 * upper[0] + w01 * upper[2] + w10 * lower[0] + w11 * lower[2];
  const float dy = w00 * upper[1] + w01 * upper[3] + w10 * lower[1] + w11 * lower[3];
  return dx * static_cast<float>(nx) + dy * static_cast<float>(ny);
}

/// Local maxima of the profile, the two strongest, by parabola.
void findPeaks(const std::array<float, 2 * kMaxReach + 3>& profile, int reach, Sample& sample) {
  for (int i = 1; i <= 2 * reach + 1; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const float here = profile[k], before = profile[k - 1], after = profile[k + 1];
    if (here < kMinGradient || here < before || here <= after || here <= sample.gradient[1]) continue;
    const double offset = i - 1 - reach + 0.5 * (before - after) / (before - 2 * here + after);
    const std::size_t place = here > sample.gradient[0] ? 0 : 1;
    if (place == 0) {
      sample.gradient[1] = sample.gradient[0];
      sample.offset[1] = sample.offset[0];
    }
    sample.gradient[place] = here;
    sample.offset[place] = offset;
  }
  sample.candidates = (sample.gradient[0] > 0) + (sample.gradient[1] > 0.4f * sample.gradient[0]);
}

/// Takes away candidates much weaker than the line's own edge: past a corner there is often a faint one.
void dropWeak(std::vector<Sample>& samples, double length) {
  std::vector<float> gradients;
  for (const Sample& sample : samples)
    if (sample.candidates > 0 && sample.s > 0 && sample.s < length) gradients.push_back(sample.gradient[0]);
  if (gradients.empty()) return;
  const auto middle = gradients.begin() + static_cast<std::ptrdiff_t>(gradients.size() / 2);
  std::nth_element(gradients.begin(), middle, gradients.end());
  for (Sample& sample : samples)
    while (sample.candidates > 0 && sample.gradient[static_cast<std::size_t>(sample.candidates) - 1] < kWeak * *middle)
      --sample.candidates;
}

std::vector<Sample> sampleProfiles(const LineCamera& camera, const cv::Mat& derivative, double scale,
                                   const ImageLine& line, int reach, double grow_px) {
  std::vector<Sample> samples;
  const Eigen::Vector2d d = line.direction(), n = line.normal();
  const double step_px = std::max(kStep_px, line.length() / kMaxSteps);
  const int grow_steps = static_cast<int>(grow_px / step_px);
  const int steps = static_cast<int>(line.length() / step_px);
  const double first = 0.5 * (line.length() - steps * step_px);
  std::array<float, 2 * kMaxReach + 3> profile{};
  for (int i = -grow_steps; i <= steps + grow_steps; ++i) {
    Sample sample;
    sample.s = first + i * step_px;
    const Eigen::Vector2d u = line.start + sample.s * d;
    if (!camera.mayBeSeen(u)) continue;
    const Eigen::Vector2d px = camera.toImage(u), step = camera.imageJacobian(u) * n;
    const double stride = step.norm();
    if (!camera.camera().contains(px, scale * ((reach + 1) * std::max(stride, 1.0) + 2))) continue;
    const Eigen::Vector2d centre = px / scale,
                          unit = step / stride;  // in pixels of the level; there a step is scale px
    for (int k = -reach - 1; k <= reach + 1; ++k)
      profile[static_cast<std::size_t>(k + reach + 1)] =
          gradientAlong(derivative, centre.x() + k * step.x(), centre.y() + k * step.y(), unit.x(), unit.y());
    findPeaks(profile, reach, sample);
    for (double& offset : sample.offset) offset *= scale;
    samples.push_back(sample);
  }
  dropWeak(samples, line.length());
  return samples;
}

/// Distance of the nearest candidate from the fit, signed; large without candidates.
double nearest(const Sample& sample, const Fit& fit, double& offset) {
  double best = 1e9;
  for (int c = 0; c < sample.candidates; ++c) {
    const double r = sample.offset[static_cast<std::size_t>(c)] - fit.at(sample.s);
    if (std::abs(r) < std::abs(best)) {
      best = r;
      offset = sample.offset[static_cast<std::size_t>(c)];
    }
  }
  return best;
}

/// Votes over shifts and tilts around the prediction; among equals the nearer to it wins.
Fit vote(const std::vector<Sample>& samples, double length, double search_px) {
  constexpr double kBin_px = 0.5;
  const int bins = 2 * static_cast<int>(std::ceil(search_px / kBin_px)) + 1;
  Fit best;
  double best_score = -1;
  std::vector<double> votes;
  for (const double tilt : {0.0, -1.5, 1.5, -3.0, 3.0}) {
    votes.assign(static_cast<std::size_t>(bins) + 2, 0.0);  // one more at both ends spares the checks
    for (const Sample& sample : samples)
      for (int c = 0; c < sample.candidates; ++c) {
        const double shift = sample.offset[static_cast<std::size_t>(c)] - tilt * (sample.s / length - 0.5);
        const int bin = static_cast<int>(std::lround(shift / kBin_px)) + bins / 2;
        if (bin < 0 || bin >= bins) continue;
        const auto k = static_cast<std::size_t>(bin);
        votes[k] += 0.5;
        votes[k + 1] += 1.0;
        votes[k + 2] += 0.5;
      }
    for (int bin = 0; bin < bins; ++bin) {
      const double shift = kBin_px * (bin - bins / 2);
      const double score = votes[static_cast<std::size_t>(bin) + 1] *
                           (1.0 - 0.25 * (std::abs(shift) + 0.5 * std::abs(tilt)) / (search_px + 1.5));
      if (score > best_score) {
        best_score = score;
        best = {shift - 0.5 * tilt, tilt / length};
      }
    }
  }
  return best;
}

/// Least squares over the candidates near the line, repeated; returns their root mean square distance.
double leastSquares(std::vector<Sample>& samples, Fit& fit, double tolerance_px) {
  double rms = 0;
  for (int iteration = 0; iteration < 3; ++iteration) {
    double n = 0, ss = 0, sss = 0, so = 0, sso = 0;
    for (Sample& sample : samples) {
      sample.inlier = std::abs(nearest(sample, fit, sample.fitted)) < tolerance_px;
      if (!sample.inlier) continue;
      n += 1;
      ss += sample.s;
      sss += sample.s * sample.s;
      so += sample.fitted;
      sso += sample.s * sample.fitted;
    }
    const double det = n * sss - ss * ss;
    if (n < 4 || det < 1e-6 * n * sss) return 1e9;
    fit = {(sss * so - ss * sso) / det, (n * sso - ss * so) / det};
    double squares = 0;
    for (const Sample& sample : samples)
      if (sample.inlier) squares += std::pow(sample.fitted - fit.at(sample.s), 2);
    rms = std::sqrt(squares / std::max(n - 2, 1.0));
  }
  return rms;
}

/// First sample (going by `step` from `from`) at which three of four samples see the edge; `end` when there is none.
int firstSupported(const std::vector<Sample>& samples, int from, int end, int step) {
  const auto sees = [&](int i) {
    return i >= 0 && i < static_cast<int>(samples.size()) && samples[static_cast<std::size_t>(i)].inlier;
  };
  for (int i = from; i != end; i += step)
    if (sees(i) && sees(i) + sees(i + step) + sees(i + 2 * step) + sees(i + 3 * step) >= 3) return i;
  return end;
}

/// Walks outward from `at` while the edge goes on, over at most one sample without it.
int growFrom(const std::vector<Sample>& samples, int at, int step) {
  int last = at;
  for (int i = at + step; i >= 0 && i < static_cast<int>(samples.size()) && std::abs(i - last) <= 2; i += step)
    if (samples[static_cast<std::size_t>(i)].inlier) last = i;
  return last;
}

}  // namespace

std::optional<RefinedLine> EdgeRefiner::refine(const ImagePyramid& pyramid, const ImageLine& line, double search_px,
                                               double grow_px) const {
  if (auto sharp = refineAtLevel(pyramid, 0, line, search_px, grow_px)) return sharp;
  if (pyramid.levels() < 2) return std::nullopt;
  return refineAtLevel(pyramid, 1, line, search_px + kBlur_px, grow_px);
}

std::optional<RefinedLine> EdgeRefiner::refineAtLevel(const ImagePyramid& pyramid, int level, const ImageLine& line,
                                                      double search_px, double grow_px) const {
  const double scale = 1 << level;
  const int reach = std::min(static_cast<int>(std::ceil(search_px / scale)), kMaxReach);
  const double length = line.length();
  if (length < 4 * kStep_px) return std::nullopt;
  std::vector<Sample> samples = sampleProfiles(camera_, pyramid.derivative(level), scale, line, reach, grow_px);
  if (samples.size() < 5) return std::nullopt;
  Fit fit = vote(samples, length, search_px);
  const double rms = leastSquares(samples, fit, kInlier_px * scale);
  if (rms > kInlier_px * scale) return std::nullopt;

  // The part of the samples on the given segment decides; what lies beyond may only be added to it.
  int own_first = 0, own_last = static_cast<int>(samples.size()) - 1;
  while (own_first < own_last && samples[static_cast<std::size_t>(own_first)].s < 0) ++own_first;
  while (own_last > own_first && samples[static_cast<std::size_t>(own_last)].s > length) --own_last;
  int first = firstSupported(samples, own_first, own_last, 1);
  int last = firstSupported(samples, own_last, own_first, -1);
  if (last - first < 3) return std::nullopt;
  if (first == own_first) first = growFrom(samples, first, -1);
  if (last == own_last) last = growFrom(samples, last, 1);

  const int seen = static_cast<int>(std::count_if(samples.begin() + first, samples.begin() + last + 1,
                                                  [](const Sample& sample) { return sample.inlier; }));
  RefinedLine refined;
  refined.support = static_cast<double>(seen) / (last - first + 1);
  if (refined.support < kMinSupport) return std::nullopt;
  const Eigen::Vector2d d = line.direction(), n = line.normal();
  const auto pointAt = [&](double s) -> Eigen::Vector2d { return line.start + s * d + fit.at(s) * n; };
  refined.line = {pointAt(samples[static_cast<std::size_t>(first)].s),
                  pointAt(samples[static_cast<std::size_t>(last)].s)};
  // The ends of a fitted line vary twice as much as its middle.
  refined.sigma_px = std::hypot(kFloor_px * scale, 2 * rms / std::sqrt(static_cast<double>(seen)));
  return refined;
}

std::optional<ImageLine> EdgeRefiner::orient(const cv::Mat& derivative, const ImageLine& line) const {
  double balance = 0, strength = 0;
  const Eigen::Vector2d n = line.normal();
  for (int i = 1; i <= 9; ++i) {
    const Eigen::Vector2d u = line.at(0.1 * i);
    if (!camera_.sees(u, 4)) continue;
    const Eigen::Vector2d px = camera_.toImage(u), step = (camera_.imageJacobian(u) * n).normalized();
    float strongest = 0;
    for (int k = -2; k <= 2; ++k) {
      const float g = gradientAlong(derivative, px.x() + k * step.x(), px.y() + k * step.y(), step.x(), step.y());
      if (std::abs(g) > std::abs(strongest)) strongest = g;
    }
    balance += strongest;
    strength += std::abs(strongest);
  }
  if (std::abs(balance) < 0.3 * strength || strength == 0) return std::nullopt;
  return balance > 0 ? line : ImageLine{line.end, line.start};
}

}  // namespace lintel
