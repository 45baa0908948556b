// SPDX-License-Identifier: BSD-3-Clause
#include "RawlogOutput.h"

#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace lintel {

namespace fs = std::filesystem;

namespace {

void renameOrThrow(const std::string& from, const std::string& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) throw std::runtime_error(to + ": cannot be written: " + error.message());
}

}  // namespace

RawlogOutput::RawlogOutput(const std::string& rawlog, bool external_images, bool overwrite)
    : rawlog_(rawlog), external_images_(external_images) {
  const fs::path path(rawlog);
  if (path.extension() != ".rawlog" || path.stem().empty())
    throw std::runtime_error(rawlog + ": the output's name must end in .rawlog: MRPT's tools expect it");
  // MRPT looks for external images under exactly this name.
  images_ = (path.parent_path() / (path.stem().string() + "_Images")).string();
  const fs::path parent = fs::absolute(path).parent_path();
  if (!fs::is_directory(parent)) throw std::runtime_error(parent.string() + ": no such folder: create it first");
  checkExisting(overwrite);
  lockFile();
  std::error_code error;
  fs::remove_all(imagesFolder(), error);
  if (!external_images_) return;
  fs::create_directory(imagesFolder(), error);
  if (error) throw std::runtime_error(imagesFolder() + ": cannot be created: " + error.message());
}

void RawlogOutput::checkExisting(bool overwrite) const {
  const bool rawlog_exists = fs::exists(rawlog_), images_exist = fs::exists(images_);
  if (rawlog_exists && !overwrite)
    throw std::runtime_error(rawlog_ + ": exists already: choose another name or overwrite it with -w");
  // Without its rawlog the folder may belong to something else: never replaced.
  if (external_images_ && images_exist && !rawlog_exists)
    throw std::runtime_error(images_ + ": exists already, without its rawlog: remove it or choose another name");
}

/// The file is made for it: it is written anew in any case.
void RawlogOutput::lockFile() {
  std::ofstream(file(), std::ios::app).close();
  std::error_code error;
  if (!fs::exists(file(), error))
    throw std::runtime_error(file() + ": cannot be made: choose a place you may write to");
  lock_.emplace(file());
}

void RawlogOutput::removeParts() const {
  std::error_code ignored;
  fs::remove(file(), ignored);
  fs::remove_all(imagesFolder(), ignored);
}

RawlogOutput::~RawlogOutput() {
  if (!committed_) removeParts();
}

void RawlogOutput::commit() {
  const std::string old_images = images_ + ".old";
  const bool replace = external_images_ && fs::exists(images_);
  std::error_code ignored;
  if (replace) {
    fs::remove_all(old_images, ignored);
    renameOrThrow(images_, old_images);
  }
  try {
    if (external_images_) renameOrThrow(imagesFolder(), images_);
    renameOrThrow(file(), rawlog_);
  } catch (...) {
    if (external_images_) fs::rename(images_, imagesFolder(), ignored);
    if (replace) fs::rename(old_images, images_, ignored);
    throw;
  }
  committed_ = true;
  if (replace) fs::remove_all(old_images, ignored);
}

}  // namespace lintel
