// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <type_traits>

#include "lintel/geometry/Camera.h"

namespace lintel {

// The field list of a params struct names each value with what it may be:
//
//   template <class F> void fields(F&& field) {
//     field("keyframes", keyframes, Range{4, 100});
//     field("min_length_px", min_length_px, ReferencePixels{20, 10000});
//     field("mode", mode, OneOf{"flow descriptor"});
//     field("enabled", enabled);   // true or false
//     field("points", points);     // a struct with fields of its own
//   }

/// Limits of a number, both allowed.
struct Range {
  double low, high;
};

/// Limits of a length in pixels that stands for an angle: it is meant for a camera with the focal length
/// kReferenceFocal_px, and scaledTo() turns it into the pixels of another one. Lengths that come from the pixel grid
/// itself (noise, patches, interpolation) are a plain Range: they are the same for every camera.
struct ReferencePixels : Range {};

/// The texts that are allowed, with blanks between them.
struct OneOf {
  const char* words;
};

/// EuRoC's cameras, for which the defaults were chosen [px].
constexpr double kReferenceFocal_px = 458;

/// How many pixels of `camera` see the angle that one pixel sees at the reference focal length. In steps of a quarter,
/// so that a new calibration of the same camera does not change every limit a little; at least a quarter.
double pixelScale(const Camera& camera);

/// What is allowed, in words: "4 to 100", "20 to 10000 at 458 px", "flow, descriptor", "true, false".
std::string allowedText(const Range& range);
std::string allowedText(const ReferencePixels& range);
std::string allowedText(const OneOf& words);
std::string allowedText();

/// Throw std::invalid_argument "KEY = VALUE, must be ..." when a value is not allowed.
void checkAllowed(const std::string& key, double value, const Range& range);
void checkAllowed(const std::string& key, const std::string& value, const OneOf& words);

/// Whether a field is a value, not a struct with fields of its own.
template <class T>
constexpr bool isParamValue = std::is_arithmetic_v<T> || std::is_same_v<T, std::string>;

/// Checks every field of a params struct; the compiler sees to it that every number and text has limits.
class RangeCheck {
 public:
  explicit RangeCheck(std::string path) : path_(std::move(path)) {}

  template <class T, class... Allowed>
  void operator()(const char* key, T& value, const Allowed&... allowed) {
    if constexpr (isParamValue<T>) {
      static_assert(sizeof...(Allowed) == (std::is_same_v<T, bool> ? 0 : 1), "a number or text needs its limits");
      if constexpr (sizeof...(Allowed) == 1) checkAllowed(path_ + key, value, allowed...);
    } else {
      value.fields(RangeCheck(path_ + key + "."));
    }
  }

 private:
  std::string path_;
};

/// Throws std::invalid_argument, naming key and limits, for the first value of `params` that is not allowed. `path`
/// comes before the keys: "estimator.".
template <class Params>
void checkRanges(Params params, const std::string& path) {
  params.fields(RangeCheck(path));
}

/// Multiplies the ReferencePixels of a params struct.
class PixelScaling {
 public:
  explicit PixelScaling(double scale) : scale_(scale) {}

  template <class T, class... Allowed>
  void operator()(const char*, T& value, const Allowed&...) {
    if constexpr (!isParamValue<T>)
      value.fields(*this);
    else if constexpr ((std::is_same_v<Allowed, ReferencePixels> || ...))
      value *= scale_;
  }

 private:
  double scale_;
};

/// `params` with its ReferencePixels in pixels of `camera`.
template <class Params>
Params scaledTo(const Camera& camera, Params params) {
  params.fields(PixelScaling(pixelScale(camera)));
  return params;
}

}  // namespace lintel
