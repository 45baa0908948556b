// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/core/ParamRange.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>

namespace lintel {

namespace {

/// All digits of what people write.
std::string numberText(double value) {
  std::ostringstream text;
  text << std::setprecision(10) << value;
  return text.str();
}

}  // namespace

double pixelScale(const Camera& camera) {
  return std::max(0.25, std::round(4 * camera.meanFocal() / kReferenceFocal_px) / 4);
}

std::string allowedText(const Range& range) { return numberText(range.low) + " to " + numberText(range.high); }

std::string allowedText(const ReferencePixels& range) {
  return allowedText(static_cast<const Range&>(range)) + " at " + numberText(kReferenceFocal_px) + " px";
}

std::string allowedText(const OneOf& words) {
  std::istringstream all(words.words);
  std::string text;
  for (std::string word; all >> word;) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string allowedText() { return "true, false"; }

void checkAllowed(const std::string& key, double value, const Range& range) {
  if (value >= range.low && value <= range.high) return;  // not so for NaN
  throw std::invalid_argument(key + " = " + numberText(value) + ", must be from " + allowedText(range));
}

void checkAllowed(const std::string& key, const std::string& value, const OneOf& words) {
  std::istringstream all(words.words);
  for (std::string word; all >> word;)
    if (word == value) return;
  throw std::invalid_argument(key + " = " + value + ", must be one of " + allowedText(words));
}

}  // namespace lintel
