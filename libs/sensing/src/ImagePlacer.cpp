// SPDX-License-Identifier: BSD-3-Clause
#include "ImagePlacer.h"

#include <filesystem>
#include <stdexcept>

namespace lintel {

namespace fs = std::filesystem;

void ImagePlacer::place(const std::string& source, const std::string& name) {
  const fs::path target = fs::path(folder_) / name;
  std::error_code error;
  if (!copy_) {
    const fs::path original = fs::canonical(source, error);  // a link to a link would break with it
    if (!error) fs::create_hard_link(original, target, error);
    if (error) {
      error.clear();
      fs::create_symlink(fs::absolute(source), target, error);
    }
    if (!error) {
      ++linked_;
      return;
    }
    error.clear();
  }
  fs::copy_file(source, target, error);
  if (error) throw std::runtime_error(target.string() + ": cannot be written: " + error.message());
  ++copied_;
}

}  // namespace lintel
