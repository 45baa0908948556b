// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeRefiner.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "EdgeAppearance.h"
#include "lintel/core/Quantiles.h"

namespace lintel {
namespace {

// All lengths are pixels of the image, whatever the focal length: what counts is the sampling, the blur and the noise.
constexpr double kStep_px = 4;             ///< between samples along the line: blur makes nearer ones alike
constexpr double kMaxSteps = 50;           ///< on a long line they lie further apart: so many determine it well
constexpr float kWeak = 0.3f;              ///< of the line's usual gradient: less is another edge, or none
constexpr float kSecond = 0.4f;            ///< of the strongest gradient of a profile: less is no candidate
constexpr float kMinGradient = 32 * 2.0f;  ///< 2 grey levels a pixel, in units of gradientsAcross()
constexpr double kInlier_px = 0.8;         ///< of a sample's edge from the fitted line: three times its noise
constexpr double kMinSupport = 0.5;        ///< of the samples
constexpr double kFloor_px = 0.25;         ///< systematic error of an edge: blur, sampling, lens model
constexpr double kBlur_px = 1;             ///< a blurred edge is predicted less exactly by so much
constexpr double kMaxTilt_px = 3;          ///< between the ends, of the edge from its prediction

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

/// Local maxima of the profile, the two strongest, by parabola.
void findPeaks(const GradientProfile& profile, int reach, Sample& sample) {
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
  sample.candidates = (sample.gradient[0] > 0) + (sample.gradient[1] > kSecond * sample.gradient[0]);
}

/// Gradient that the line usually has; 0 without any edge.
float usualGradient(const std::vector<Sample>& samples) {
  std::vector<float> gradients;
  gradients.reserve(samples.size());
  for (const Sample& sample : samples)
    if (sample.candidates > 0) gradients.push_back(sample.gradient[0]);
  if (gradients.empty()) return 0;
  return upperMedian(gradients);
}

/// Removes candidates much weaker than the line's own edge.
void dropWeak(Sample& sample, float usual) {
  while (sample.candidates > 0 && sample.gradient[static_cast<std::size_t>(sample.candidates) - 1] < kWeak * usual)
    --sample.candidates;
}

/// Looks across one line at one image for edges.
class Profiler {
 public:
  Profiler(const LineCamera& camera, const cv::Mat& image, double scale, const ImageLine& line)
      : camera_(camera),
        image_(image),
        scale_(scale),
        line_(line),
        d_(line.direction()),
        n_(line.normal()),
        step_valid_px_(camera.scaled(16)) {}

  /// Candidates at `s` along the line, `reach` level pixels to both sides of `centre_px` off it; false where the image
  /// is not used.
  bool look(double s, double centre_px, int reach, Sample& sample) {
    const Eigen::Vector2d u = line_.start + s * d_ + centre_px * n_;
    const auto px = camera_.seenAt(u, line_.axis);
    if (!px) return false;
    if (std::abs(s - step_at_) > step_valid_px_) {
      step_ = camera_.imageJacobian(u, line_.axis) * n_;
      step_at_ = s;
      stride_ = step_.norm();
    }
    if (!camera_.uses(*px, scale_ * ((reach + 1) * std::max(stride_, 1.0) + 2))) return false;
    GradientProfile profile;
    gradientsAcross(image_, *px / scale_, step_, stride_, reach, profile);  // of the level: there a step is scale px
    sample = {};
    sample.s = s;
    findPeaks(profile, reach, sample);
    for (double& offset : sample.offset) offset = offset * scale_ + centre_px;
    return true;
  }

 private:
  const LineCamera& camera_;
  const cv::Mat& image_;
  double scale_;
  const ImageLine& line_;
  Eigen::Vector2d d_, n_, step_{0, 0};  ///< step_: one undistorted pixel across the line, in the image
  double step_valid_px_;                ///< along the line: the lens changes slowly over the angle
  double step_at_ = -1e9, stride_ = 1;
};

std::vector<Sample> sampleProfiles(Profiler& profiler, double length, int reach) {
  std::vector<Sample> samples;
  const double step_px = std::max(kStep_px, length / kMaxSteps);
  const int steps = static_cast<int>(length / step_px);
  const double first = 0.5 * (length - steps * step_px);
  samples.reserve(static_cast<std::size_t>(steps) + 1);
  Sample sample;
  for (int i = 0; i <= steps; ++i)
    if (profiler.look(first + i * step_px, 0, reach, sample)) samples.push_back(sample);
  const float usual = usualGradient(samples);
  for (Sample& s : samples) dropWeak(s, usual);
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
  constexpr double kBin_px = 0.5;  // votes go to three bins: about twice the inliers' limit
  const int middle = static_cast<int>(std::ceil(search_px / kBin_px));  // the bin of no shift
  const int bins = 2 * middle + 1;
  Fit best;
  double best_score = -1;
  std::vector<double> votes;
  for (const double tilt : {0.0, -0.5 * kMaxTilt_px, 0.5 * kMaxTilt_px, -kMaxTilt_px, kMaxTilt_px}) {
    votes.assign(static_cast<std::size_t>(bins) + 2, 0.0);  // one more at both ends spares the checks
    for (const Sample& sample : samples)
      for (int c = 0; c < sample.candidates; ++c) {
        const double shift = sample.offset[static_cast<std::size_t>(c)] - tilt * (sample.s / length - 0.5);
        const double place = shift / kBin_px + middle + 0.5;
        if (place < 0 || place >= bins) continue;
        const int bin = static_cast<int>(place);
        const auto k = static_cast<std::size_t>(bin);
        votes[k] += 0.5;
        votes[k + 1] += 1.0;
        votes[k + 2] += 0.5;
      }
    for (int bin = 0; bin < bins; ++bin) {
      const double shift = kBin_px * (bin - middle);
      const double score = votes[static_cast<std::size_t>(bin) + 1] *
                           (1.0 - 0.25 * (std::abs(shift) + 0.5 * std::abs(tilt)) / (search_px + 0.5 * kMaxTilt_px));
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

/// Walks outward from `s` by `step_px` while the edge goes on, over at most one place without it; returns how far.
/// What lies beyond the segment does not change the fit: an edge that meets it at an acute angle would rotate it.
double grow(Profiler& profiler, const Fit& fit, double s, double step_px, double limit_px, float usual,
            double tolerance_px) {
  double reached = s;
  Sample sample;
  for (int i = 1, missed = 0; i * std::abs(step_px) <= limit_px && missed < 2; ++i) {
    const double at = s + i * step_px;
    if (!profiler.look(at, fit.at(at), 1, sample)) break;
    dropWeak(sample, usual);
    const bool seen = std::abs(nearest(sample, fit, sample.fitted)) < tolerance_px;
    missed = seen ? 0 : missed + 1;
    if (seen) reached = at;
  }
  return reached;
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
  Profiler profiler(camera_, pyramid.image(level), scale, line);
  std::vector<Sample> samples = sampleProfiles(profiler, length, reach);
  if (samples.size() < 5) return std::nullopt;
  Fit fit = vote(samples, length, search_px);
  const double tolerance_px = kInlier_px * scale, rms = leastSquares(samples, fit, tolerance_px);
  if (rms > tolerance_px) return std::nullopt;

  const int end = static_cast<int>(samples.size()) - 1;
  const int first = firstSupported(samples, 0, end, 1), last = firstSupported(samples, end, 0, -1);
  if (last - first < 3) return std::nullopt;
  const auto seen = std::count_if(samples.begin() + first, samples.begin() + last + 1,
                                  [](const Sample& sample) { return sample.inlier; });
  RefinedLine refined;
  refined.support = static_cast<double>(seen) / (last - first + 1);
  if (refined.support < kMinSupport) return std::nullopt;

  double from = samples[static_cast<std::size_t>(first)].s, to = samples[static_cast<std::size_t>(last)].s;
  const double step_px = (to - from) / (last - first);
  const float usual = usualGradient(samples);
  if (first == 0) from = grow(profiler, fit, from, -step_px, grow_px, usual, tolerance_px);
  if (last == end) to = grow(profiler, fit, to, step_px, grow_px, usual, tolerance_px);
  const Eigen::Vector2d d = line.direction(), n = line.normal();
  refined.line = {line.start + from * d + fit.at(from) * n, line.start + to * d + fit.at(to) * n, line.axis};
  // The ends of a fitted line vary twice as much as its middle.
  refined.sigma_px = std::hypot(kFloor_px * scale, 2 * rms / std::sqrt(static_cast<double>(seen)));
  return refined;
}

std::optional<ImageLine> EdgeRefiner::orient(const cv::Mat& image, const ImageLine& line) const {
  double balance = 0, strength = 0;
  const Eigen::Vector2d n = line.normal();
  for (int i = 1; i <= 5; ++i) {
    const Eigen::Vector2d u = line.at(0.2 * i - 0.1);
    const auto px = camera_.seenAt(u, line.axis);
    if (!px || !camera_.uses(*px, 4)) continue;
    const Eigen::Vector2d step = (camera_.imageJacobian(u, line.axis) * n).normalized();
    float strongest = 0;
    GradientProfile profile;
    gradientsAcross(image, *px, step, 1, 1, profile);
    for (int k = 0; k < 5; ++k)
      if (const float g = profile[static_cast<std::size_t>(k)]; std::abs(g) > std::abs(strongest)) strongest = g;
    balance += strongest;
    strength += std::abs(strongest);
  }
  if (std::abs(balance) < 0.3 * strength || strength == 0) return std::nullopt;
  return balance > 0 ? line : ImageLine{line.end, line.start, line.axis};
}

}  // namespace lintel
