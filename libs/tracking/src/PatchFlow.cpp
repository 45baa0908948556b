// SPDX-License-Identifier: BSD-3-Clause
#include "PatchFlow.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core/hal/intrin.hpp>

#include "lintel/core/ForAvx2.h"

namespace lintel {
namespace {

constexpr int kLanes = 8;             ///< pixels that are treated at once
constexpr int kWeightBits = 14;       ///< of bilinear weights
constexpr int kGreyBits = 5;          ///< interpolated grey levels are 32 times the image's
constexpr float kGreyScale = 32;      // 2^kGreyBits
constexpr float kGradientScale = 64;  ///< see Template::differentiate

/// Columns of a patch with what fills it up to whole vectors.
int paddedColumns(int window_px) { return (window_px + kLanes - 1) / kLanes * kLanes; }

/// Bilinear weights of a place between four pixels, in pairs as the products need them.
class Weights {
 public:
  Weights(float fx, float fy) {
    const float one = 1 << kWeightBits;
    const int w00 = cvRound((1 - fx) * (1 - fy) * one), w01 = cvRound(fx * (1 - fy) * one),
              w10 = cvRound((1 - fx) * fy * one), w11 = (1 << kWeightBits) - w00 - w01 - w10;
    upper_ = pair(w00, w01);
    lower_ = pair(w10, w11);
  }

  /// Eight interpolated pixels, the first one between `p` and its neighbours to the right and below.
  cv::v_int16x8 interpolate(const unsigned char* p, std::size_t step) const {
    cv::v_int16x8 left, right;
    cv::v_zip(load(p), load(p + 1), left, right);
    cv::v_int32x4 a = cv::v_dotprod(left, upper_), b = cv::v_dotprod(right, upper_);
    cv::v_zip(load(p + step), load(p + step + 1), left, right);
    a = cv::v_dotprod(left, lower_, a), b = cv::v_dotprod(right, lower_, b);
    return cv::v_rshr_pack<kWeightBits - kGreyBits>(a, b);
  }

 private:
  static cv::v_int16x8 pair(int first, int second) {
    return cv::v_reinterpret_as_s16(cv::v_setall_s32((first & 0xffff) + second * 0x10000));
  }
  static cv::v_int16x8 load(const unsigned char* p) { return cv::v_reinterpret_as_s16(cv::v_load_expand(p)); }

  cv::v_int16x8 upper_, lower_;
};

/// A patch's upper left pixel and the rest of its place.
struct Corner {
  int x, y;
  float fx, fy;
};

/// False when the patch does not touch the image.
bool cornerOf(const cv::Point2f& centre, int window_px, const cv::Mat& image, Corner& corner) {
  const float half = 0.5f * static_cast<float>(window_px - 1), x = centre.x - half, y = centre.y - half;
  const auto least = static_cast<float>(-window_px);
  if (!(x >= least && y >= least && x < static_cast<float>(image.cols) && y < static_cast<float>(image.rows)))
    return false;
  corner.x = cvFloor(x), corner.y = cvFloor(y);
  corner.fx = x - static_cast<float>(corner.x), corner.fy = y - static_cast<float>(corner.y);
  return true;
}

/// Adds four sums of a row to floating-point ones.
void add(const cv::v_int32x4& row, cv::v_float32x4& sum) {
  sum = cv::v_muladd(cv::v_cvt_f32(row), cv::v_setall_f32(1), sum);
}

/// A sum of products of 16 bits. What 32 bits hold of it, the products of up to kAtOnce vectors, is added up before.
class Sum {
 public:
  static constexpr int kAtOnce = 32;  ///< of at most 8160 x 4080 in pairs

  void product(const cv::v_int16x8& a, const cv::v_int16x8& b) { part_ = cv::v_dotprod(a, b, part_); }
  void carry() {
    add(part_, total_);
    part_ = cv::v_setzero_s32();
  }
  float value() const { return cv::v_reduce_sum(total_); }

 private:
  cv::v_int32x4 part_ = cv::v_setzero_s32();
  cv::v_float32x4 total_ = cv::v_setzero_f32();
};

/// Rounded.
cv::v_int16x8 quarter(const cv::v_int16x8& a) { return cv::v_shr<2>(cv::v_add_wrap(a, cv::v_setall_s16(2))); }

/// What is looked for: a patch of the first image and its gradients. Pixels beyond the window or the image have zero
/// gradient and do not count.
class Template {
 public:
  explicit Template(int window_px)
      : window_px_(window_px),
        columns_(paddedColumns(window_px)),
        stride_(columns_ + 2),
        grey_(static_cast<std::size_t>(stride_ * (window_px + 2))),
        gx_(static_cast<std::size_t>(columns_ * window_px)),
        gy_(gx_.size()),
        mask_(static_cast<std::size_t>(columns_)) {}

  /// Takes the patch from the image.
  void take(const cv::Mat& image, const Corner& corner) {
    const Weights weights(corner.fx, corner.fy);
    const std::size_t step = image.step[0];
    const unsigned char* row = image.data + (corner.y - 1) * static_cast<std::ptrdiff_t>(step) + (corner.x - 1);
    for (int y = 0; y < window_px_ + 2; ++y, row += step) {
      short* out = grey_.data() + y * stride_;
      for (int x = 0; x < columns_; x += kLanes) cv::v_store(out + x, weights.interpolate(row + x, step));
      const std::ptrdiff_t last = stride_ - kLanes;  // the two columns that are left, some others again
      cv::v_store(out + last, weights.interpolate(row + last, step));
    }
    const auto first_x = std::max(0, 1 - corner.x), end_x = std::min(window_px_, image.cols - 2 - corner.x);
    for (int x = 0; x < columns_; ++x) mask_[static_cast<std::size_t>(x)] = x >= first_x && x < end_x ? -1 : 0;
    first_ = std::max(0, 1 - corner.y), end_ = std::min(window_px_, image.rows - 2 - corner.y);
    pixels_ = static_cast<float>(std::max(0, end_x - first_x) * std::max(0, end_ - first_));
    differentiate();
    takeOutBrightness();
  }

  /// How many times the patch's contrast (standard deviation of its grey levels) what is at `corner` of `image` has.
  float contrast(const cv::Mat& image, const Corner& corner) const {
    const Weights weights(corner.fx, corner.fy);
    const std::size_t step = image.step[0];
    const unsigned char* row = image.data + (corner.y + first_) * static_cast<std::ptrdiff_t>(step) + corner.x;
    const cv::v_int16x8 middle = cv::v_setall_s16(kMiddle), minus_one = cv::v_setall_s16(-1);
    Sum sum, square;
    for (int y = first_; y < end_; ++y, row += step) {
      for (int x = 0; x < columns_; x += kLanes) {
        const cv::v_int16x8 grey =
            cv::v_load(mask_.data() + x) & cv::v_sub_wrap(weights.interpolate(row + x, step), middle);
        sum.product(grey, minus_one);
        square.product(grey, grey);
      }
      if (isFull(y)) sum.carry(), square.carry();
    }
    const float mean = sum.value() / pixels_;
    return std::sqrt(std::max(0.0f, square.value() / pixels_ - mean * mean) / variance_);
  }

  /// Sums of (what is at `corner` of `image` less the patch) times the gradients [grey levels^2/px].
  void compare(const cv::Mat& image, const Corner& corner, float& bx, float& by) const {
    const Weights weights(corner.fx, corner.fy);
    const std::size_t step = image.step[0];
    const unsigned char* row = image.data + corner.y * static_cast<std::ptrdiff_t>(step) + corner.x;
    cv::v_float32x4 sum_x = cv::v_setzero_f32(), sum_y = cv::v_setzero_f32();
    for (int y = 0; y < window_px_; ++y, row += step) {
      const short* grey = grey_.data() + (y + 1) * stride_ + 1;
      cv::v_int32x4 row_x = cv::v_setzero_s32(), row_y = cv::v_setzero_s32();
      for (int x = 0, k = y * columns_; x < columns_; x += kLanes, k += kLanes) {
        const cv::v_int16x8 difference = cv::v_sub_wrap(weights.interpolate(row + x, step), cv::v_load(grey + x));
        row_x = cv::v_dotprod(difference, cv::v_load(gx_.data() + k), row_x);
        row_y = cv::v_dotprod(difference, cv::v_load(gy_.data() + k), row_y);
      }
      add(row_x, sum_x);
      add(row_y, sum_y);
    }
    bx = cv::v_reduce_sum(sum_x) / (kGreyScale * kGradientScale);
    by = cv::v_reduce_sum(sum_y) / (kGreyScale * kGradientScale);
  }

  float xx = 0, xy = 0, yy = 0;  ///< of the structure tensor: sums of the gradients' products [grey levels^2/px^2]

 private:
  /// Scharr's gradients. In 16 bits: of differences over two pixels, 32 times grey levels, a quarter is weighted 3, 10,
  /// 3 and divided by 4 again: 64 times the gradient, at most 8160.
  void differentiate() {
    std::fill(gx_.begin(), gx_.end(), static_cast<short>(0));
    std::fill(gy_.begin(), gy_.end(), static_cast<short>(0));
    const cv::v_int16x8 three = cv::v_setall_s16(3), ten = cv::v_setall_s16(10);
    const auto weighted = [&](const cv::v_int16x8& a, const cv::v_int16x8& b, const cv::v_int16x8& c) {
      const cv::v_int16x8 outer = cv::v_mul_wrap(cv::v_add_wrap(a, c), three);
      return quarter(cv::v_add_wrap(outer, cv::v_mul_wrap(b, ten)));
    };
    const auto difference = [](const short* a, const short* b) {
      return quarter(cv::v_sub_wrap(cv::v_load(a), cv::v_load(b)));
    };
    cv::v_float32x4 sum_xx = cv::v_setzero_f32(), sum_xy = cv::v_setzero_f32(), sum_yy = cv::v_setzero_f32();
    for (int y = first_; y < end_; ++y) {
      const short *above = grey_.data() + y * stride_, *here = above + stride_, *below = here + stride_;
      cv::v_int32x4 row_xx = cv::v_setzero_s32(), row_xy = cv::v_setzero_s32(), row_yy = cv::v_setzero_s32();
      for (int x = 0, k = y * columns_; x < columns_; x += kLanes, k += kLanes) {
        const cv::v_int16x8 mask = cv::v_load(mask_.data() + x);
        const cv::v_int16x8 gx =
            cv::v_mul_wrap(mask, weighted(difference(above + x, above + x + 2), difference(here + x, here + x + 2),
                                          difference(below + x, below + x + 2)));
        const cv::v_int16x8 gy =
            cv::v_mul_wrap(mask, weighted(difference(above + x, below + x), difference(above + x + 1, below + x + 1),
                                          difference(above + x + 2, below + x + 2)));
        cv::v_store(gx_.data() + k, gx);
        cv::v_store(gy_.data() + k, gy);
        row_xx = cv::v_dotprod(gx, gx, row_xx);
        row_xy = cv::v_dotprod(gx, gy, row_xy);
        row_yy = cv::v_dotprod(gy, gy, row_yy);
      }
      add(row_xx, sum_xx);
      add(row_xy, sum_xy);
      add(row_yy, sum_yy);
    }
    constexpr float kScale = kGradientScale * kGradientScale;
    xx = cv::v_reduce_sum(sum_xx) / kScale, xy = cv::v_reduce_sum(sum_xy) / kScale,
    yy = cv::v_reduce_sum(sum_yy) / kScale;
  }

  /// Makes the gradients orthogonal to the patch and to an even patch: a change of contrast or brightness moves nothing
  /// (as the inverse compositional algorithm with linear appearance variation does [Baker2003]).
  void takeOutBrightness() {
    variance_ = 0;
    if (!(pixels_ > 0)) return;
    const cv::v_int16x8 middle = cv::v_setall_s16(kMiddle), minus_one = cv::v_setall_s16(-1);
    Sum t, tt, x1, y1, xt, yt;
    for (int y = first_; y < end_; ++y) {
      const short* grey = grey_.data() + (y + 1) * stride_ + 1;
      for (int x = 0, k = y * columns_; x < columns_; x += kLanes, k += kLanes) {
        const cv::v_int16x8 T = cv::v_load(mask_.data() + x) & cv::v_sub_wrap(cv::v_load(grey + x), middle),
                            gx = cv::v_load(gx_.data() + k), gy = cv::v_load(gy_.data() + k);
        t.product(T, minus_one), tt.product(T, T);
        x1.product(gx, minus_one), xt.product(gx, T);
        y1.product(gy, minus_one), yt.product(gy, T);
      }
      if (isFull(y))
        for (Sum* sum : {&t, &tt, &x1, &xt, &y1, &yt}) sum->carry();
    }
    const float mean_t = -t.value() / pixels_, mean_x = -x1.value() / pixels_, mean_y = -y1.value() / pixels_;
    variance_ = tt.value() / pixels_ - mean_t * mean_t;
    if (!(variance_ > 0)) return;
    const float cov_x = xt.value() / pixels_ - mean_x * mean_t, cov_y = yt.value() / pixels_ - mean_y * mean_t;
    const float slope_x = cov_x / variance_, slope_y = cov_y / variance_;
    const auto less = [&](const cv::v_int16x8& gradient, const cv::v_int16x8& T, float slope, float mean) {
      const cv::v_float32x4 s = cv::v_setall_f32(-slope), offset = cv::v_setall_f32(slope * mean_t - mean);
      cv::v_int32x4 g[2], p[2];
      cv::v_expand(gradient, g[0], g[1]);
      cv::v_expand(T, p[0], p[1]);
      for (int half = 0; half < 2; ++half)
        g[half] = cv::v_round(cv::v_cvt_f32(g[half]) + cv::v_muladd(cv::v_cvt_f32(p[half]), s, offset));
      return cv::v_pack(g[0], g[1]);
    };
    for (int y = first_; y < end_; ++y) {
      const short* grey = grey_.data() + (y + 1) * stride_ + 1;
      for (int x = 0, k = y * columns_; x < columns_; x += kLanes, k += kLanes) {
        const cv::v_int16x8 T = cv::v_sub_wrap(cv::v_load(grey + x), middle), mask = cv::v_load(mask_.data() + x);
        short *gx = gx_.data() + k, *gy = gy_.data() + k;
        cv::v_store(gx, mask & less(cv::v_load(gx), T, slope_x, mean_x));
        cv::v_store(gy, mask & less(cv::v_load(gy), T, slope_y, mean_y));
      }
    }
    constexpr float kScale = kGradientScale * kGradientScale;
    xx -= pixels_ * (mean_x * mean_x + cov_x * slope_x) / kScale;
    xy -= pixels_ * (mean_x * mean_y + cov_x * slope_y) / kScale;
    yy -= pixels_ * (mean_y * mean_y + cov_y * slope_y) / kScale;
  }

  /// Whether sums are to be carried after row `y`.
  bool isFull(int y) const {
    const int rows = std::max(1, Sum::kAtOnce / (columns_ / kLanes));
    return (y + 1 - first_) % rows == 0 || y + 1 == end_;
  }

  static constexpr short kMiddle = 4080;  ///< of interpolated grey levels

  int window_px_, columns_;
  int first_ = 0, end_ = 0;          ///< rows within the image
  float pixels_ = 0, variance_ = 0;  ///< number of those that count; of the patch
  std::ptrdiff_t stride_;            ///< numbers in a row of `grey_`
  std::vector<short> grey_;          ///< with a ring of one pixel around the patch, as gradients need it
  std::vector<short> gx_, gy_;       ///< `columns_` a row
  std::vector<short> mask_;          ///< of a row: 0 beyond window or image, else -1 as differences are left less right
};

/// Prefetches the rows of a patch into the cache: patches are scattered over the image.
void prefetch(const cv::Mat& image, const cv::Point2f& centre, int window_px) {
  Corner corner{};
  if (!cornerOf(centre, window_px, image, corner)) return;
  const unsigned char* row = image.data + (corner.y - 1) * static_cast<std::ptrdiff_t>(image.step[0]) + (corner.x - 1);
  for (int y = 0; y < window_px + 2; ++y, row += image.step[0]) __builtin_prefetch(row);
}

/// Moves `place` to where the template is in `image`; false when it leaves the image.
bool settle(const Template& patch, const cv::Mat& image, const PatchFlowParams& params, float determinant,
            cv::Point2f& place) {
  constexpr float kSwing_px = 0.01f;  // steps that nearly cancel each other oscillate about the place
  float contrast = 1;
  cv::Point2f before(0, 0);
  for (int i = 0; i < params.max_iterations; ++i) {
    Corner corner{};
    if (!cornerOf(place, params.window_px, image, corner)) return false;
    float bx, by;
    if (i == 0) {
      contrast = patch.contrast(image, corner);
      if (!(contrast > kLeastContrast && contrast < 1 / kLeastContrast)) return false;
    }
    patch.compare(image, corner, bx, by);
    const cv::Point2f step((patch.xy * by - patch.yy * bx) / (determinant * contrast),
                           (patch.xy * bx - patch.xx * by) / (determinant * contrast));
    place += step;
    if (step.dot(step) <= static_cast<float>(params.settled_px * params.settled_px)) break;
    if (i > 0 && std::abs(step.x + before.x) < kSwing_px && std::abs(step.y + before.y) < kSwing_px) {
      place -= 0.5f * step;
      break;
    }
    before = step;
  }
  return true;
}

/// False when the template has too little texture.
bool textured(const Template& patch, const PatchFlowParams& params, float& determinant) {
  determinant = patch.xx * patch.yy - patch.xy * patch.xy;
  const float half = 0.5f * (patch.xx - patch.yy);
  const float least = 0.5f * (patch.xx + patch.yy) - std::sqrt(half * half + patch.xy * patch.xy);
  return least >= static_cast<float>(params.min_texture) * static_cast<float>(params.window_px * params.window_px) &&
         determinant > 0;
}

}  // namespace

int patchBorder(int window_px) { return paddedColumns(window_px) + 3; }

LINTEL_FOR_AVX2_TOO std::vector<unsigned char> followPatches(const std::vector<cv::Mat>& from,
                                                             const std::vector<cv::Mat>& to,
                                                             const std::vector<cv::Point2f>& px,
                                                             const PatchFlowParams& params,
                                                             std::vector<cv::Point2f>& moved) {
  std::vector<unsigned char> found(px.size(), 0);
  Template patch(params.window_px);
  const int levels = std::min({params.levels, static_cast<int>(from.size()), static_cast<int>(to.size())});
  for (std::size_t i = 0; i < px.size(); ++i) {
    if (i + 1 < px.size()) {
      prefetch(from[0], px[i + 1], params.window_px);
      prefetch(to[0], moved[i + 1], params.window_px);
    }
    for (int level = levels - 1; level >= 0; --level) {
      const auto l = static_cast<std::size_t>(level);
      const auto scale = static_cast<float>(1 << level);
      cv::Point2f place = moved[i] / scale;
      Corner corner{};
      float determinant = 0;
      found[i] = 0;
      if (!cornerOf(px[i] / scale, params.window_px, from[l], corner)) continue;
      patch.take(from[l], corner);
      if (!textured(patch, params, determinant)) continue;
      found[i] = settle(patch, to[l], params, determinant, place);
      moved[i] = place * scale;
    }
  }
  return found;
}

}  // namespace lintel
