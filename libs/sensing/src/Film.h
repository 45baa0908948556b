// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "lintel/core/Frame.h"

namespace lintel {

/// The pictures of a video file, in order.
class Film {
 public:
  /// Throws RecordingError when no video can be read from the file.
  explicit Film(const std::string& path);
  ~Film();

  /// Picture `index`, not before one that was given. Throws ImageFault.
  GrayImage picture(std::size_t index);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lintel
