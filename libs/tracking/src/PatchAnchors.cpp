// SPDX-License-Identifier: BSD-3-Clause
#include "PatchAnchors.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "GreyLevels.h"

namespace lintel {
namespace {

// Lengths are pixels of the image: they are errors of optical flow, which do not depend on the focal length.
constexpr int kMaxIterations = 6;          ///< a patch that needs more has no match nearby
constexpr float kConverged_px = 0.01f;     ///< far below the error of a patch's place
constexpr float kMaxShift_px = 1.5f;       ///< from where optical flow has led: five times its error
constexpr float kLeastCorrelation = 0.8f;  ///< of a patch with what is seen: less is something else, or occluded
constexpr float kLeastNorm = 20;           ///< of a patch, mean taken out: 1.5 grey levels rms are noise
constexpr float kLeastArea = 0.6f,
                kMostArea = 1.6f;                ///< of the view of a patch; beyond: a new patch, as resolutions differ
constexpr float kNoise = 0.05f, kShear = 0.02f;  ///< of a pixel of a patch of norm 1; of the linear part in a step

/// Takes brightness and contrast out; false without any texture.
template <class Patch>
bool normalise(Patch& patch) {
  patch.array() -= patch.mean();
  const float norm = patch.norm();
  if (norm < kLeastNorm) return false;
  patch /= norm;
  return true;
}

/// Grey levels of a square of 2 Half + 1 places a side, row by row, at place + A offset; false where it leaves the
/// image.
template <int Half>
bool sampleSquare(const cv::Mat& image, const cv::Point2f& place, const Eigen::Matrix2f& A, float* grey) {
  constexpr int kSide = 2 * Half + 1;
  const float reach_x = (std::abs(A(0, 0)) + std::abs(A(0, 1))) * Half,
              reach_y = (std::abs(A(1, 0)) + std::abs(A(1, 1))) * Half;
  const auto last_x = static_cast<float>(image.cols - 1), last_y = static_cast<float>(image.rows - 1);
  if (!(place.x - reach_x >= 0 && place.y - reach_y >= 0 && place.x + reach_x < last_x && place.y + reach_y < last_y))
    return false;
  constexpr std::size_t kPlaces = std::size_t{kSide} * kSide;
  std::array<float, kPlaces> x, y;
  std::size_t at = 0;
  for (int v = -Half; v <= Half; ++v) {
    x[at] = place.x + A(0, 1) * static_cast<float>(v) - A(0, 0) * Half;
    y[at] = place.y + A(1, 1) * static_cast<float>(v) - A(1, 0) * Half;
    for (++at; at % kSide != 0; ++at) x[at] = x[at - 1] + A(0, 0), y[at] = y[at - 1] + A(1, 0);
  }
  greyLevels<0>(image, kPlaces, x, y, grey);
  return true;
}

}  // namespace

bool PatchAnchors::sample(const cv::Mat& image, const Warp& warp, Patch& patch) {
  return sampleSquare<kHalf>(image, warp.place, warp.A, patch.data());
}

bool PatchAnchors::makeAnchor(const cv::Mat& image, const cv::Point2f& px, Anchor& anchor) {
  anchor.A.setIdentity();
  anchor.failures = 0;
  constexpr int kAround = kSide + 2;  // gradients need a pixel more
  Eigen::Matrix<float, kAround, kAround, Eigen::RowMajor> around;
  if (!sampleSquare<kHalf + 1>(image, px, Eigen::Matrix2f::Identity(), around.data())) return false;
  const auto shifted = [&](int dx, int dy) -> Patch {
    const Eigen::Matrix<float, kSide, kSide, Eigen::RowMajor> square = around.block<kSide, kSide>(1 + dy, 1 + dx);
    return Eigen::Map<const Patch>(square.data());
  };
  anchor.patch = shifted(0, 0);
  const float mean = anchor.patch.mean();
  const float norm = (anchor.patch.array() - mean).matrix().norm();
  if (!normalise(anchor.patch)) return false;
  const Patch gx = (shifted(1, 0) - shifted(-1, 0)) / (2 * norm), gy = (shifted(0, 1) - shifted(0, -1)) / (2 * norm);
  int k = 0;
  for (int v = -kHalf; v <= kHalf; ++v)
    for (int u = -kHalf; u <= kHalf; ++u, ++k) {
      const auto fu = static_cast<float>(u), fv = static_cast<float>(v);
      anchor.J.row(k) << gx[k], gy[k], gx[k] * fu, gx[k] * fv, gy[k] * fu, gy[k] * fv;
    }
  for (int c = 0; c < kParameters; ++c) {
    anchor.J.col(c).array() -= anchor.J.col(c).mean();
    anchor.J.col(c) -= anchor.patch * anchor.patch.dot(anchor.J.col(c));
  }
  Eigen::Matrix<float, kParameters, kParameters> H = anchor.J.transpose() * anchor.J;
  H.diagonal().tail<4>().array() += kNoise * kNoise / (kPixels * kShear * kShear);
  const Eigen::LDLT<Eigen::Matrix<float, kParameters, kParameters>> ldlt(H);
  anchor.inverse = ldlt.solve(Eigen::Matrix<float, kParameters, kParameters>::Identity());
  return anchor.inverse.allFinite();
}

bool PatchAnchors::alignPatch(const Anchor& anchor, const cv::Mat& image, Warp& warp) {
  const cv::Point2f start = warp.place;
  Patch seen;
  for (int i = 0; i < kMaxIterations; ++i) {
    if (!sample(image, warp, seen) || !normalise(seen)) return false;
    const Eigen::Matrix<float, kParameters, 1> step = anchor.inverse * (anchor.J.transpose() * (seen - anchor.patch));
    Eigen::Matrix2f turned;
    turned << 1 + step[2], step[3], step[4], 1 + step[5];
    warp.A = warp.A * turned.inverse();
    const Eigen::Vector2f shift = warp.A * step.head<2>();
    warp.place -= cv::Point2f(shift.x(), shift.y());
    if (!(std::hypot(warp.place.x - start.x, warp.place.y - start.y) < kMaxShift_px) || !(warp.A.determinant() > 0.1f))
      return false;
    if (shift.norm() < kConverged_px) return seen.dot(anchor.patch) > kLeastCorrelation;
  }
  return sample(image, warp, seen) && normalise(seen) && seen.dot(anchor.patch) > kLeastCorrelation;
}

void PatchAnchors::add(TrackId id, const cv::Mat& image, const cv::Point2f& px) {
  if (!makeAnchor(image, px, anchors_[id])) anchors_.erase(id);
}

AnchorVerdict PatchAnchors::align(TrackId id, const cv::Mat& image, cv::Point2f& px) {
  const auto it = anchors_.find(id);
  if (it == anchors_.end()) return AnchorVerdict::kUnsure;
  Warp warp{px, it->second.A};
  if (!alignPatch(it->second, image, warp))
    return ++it->second.failures > max_failures_ ? AnchorVerdict::kLost : AnchorVerdict::kUnsure;
  px = warp.place;
  it->second.A = warp.A;
  it->second.failures = 0;
  const float area = warp.A.determinant();
  if (area < kLeastArea || area > kMostArea) add(id, image, px);
  return AnchorVerdict::kHeld;
}

void PatchAnchors::keepOnly(const std::vector<PointObservation>& points) {
  auto point = points.begin();
  for (auto it = anchors_.begin(); it != anchors_.end();) {
    while (point != points.end() && point->id < it->first) ++point;
    it = point != points.end() && point->id == it->first ? std::next(it) : anchors_.erase(it);
  }
}

}  // namespace lintel
