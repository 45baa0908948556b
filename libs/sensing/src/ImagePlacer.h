// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace lintel {

/// Puts image files into a rawlog's image folder.
class ImagePlacer {
 public:
  ImagePlacer(std::string folder, bool copy) : folder_(std::move(folder)), copy_(copy) {}

  /// Makes `source` available as `name`: as a hard link, or where the disk refuses one (another disk, no permission) as
  /// a symbolic link, or as a copy. Throws std::runtime_error.
  void place(const std::string& source, const std::string& name);

  std::size_t linked() const { return linked_; }
  std::size_t copied() const { return copied_; }

 private:
  std::string folder_;
  bool copy_;
  std::size_t linked_ = 0, copied_ = 0;
};

}  // namespace lintel
