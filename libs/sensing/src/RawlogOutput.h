// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "lintel/core/FolderLock.h"

namespace lintel {

/// The files of a rawlog while it is written: NAME.rawlog.part and NAME_Images.part, which take their final names only
/// when all is done and vanish otherwise.
class RawlogOutput {
 public:
  /// Throws std::runtime_error when the name does not end in .rawlog, the files exist and must not be replaced, the
  /// folder is missing, or another run is writing the same rawlog.
  RawlogOutput(const std::string& rawlog, bool external_images, bool overwrite);
  ~RawlogOutput();
  RawlogOutput(const RawlogOutput&) = delete;
  RawlogOutput& operator=(const RawlogOutput&) = delete;

  std::string file() const { return rawlog_ + ".part"; }
  std::string imagesFolder() const { return images_ + ".part"; }
  const std::string& finalImagesFolder() const { return images_; }

  /// Gives the files their final names. Throws std::runtime_error; what was there before is then still there.
  void commit();

 private:
  void checkExisting(bool overwrite) const;
  void lockFile();
  void removeParts() const;

  std::string rawlog_, images_;
  bool external_images_, committed_ = false;
  std::optional<FolderLock> lock_;  // of file()
};

}  // namespace lintel
