// SPDX-License-Identifier: BSD-3-Clause
#include "Film.h"

#include <dlfcn.h>

#include <filesystem>

#include "FilmReader.h"
#include "ImageFile.h"
#include "SensorStream.h"

namespace lintel {

namespace {

/// The module: in the build tree by the program's run path, else in the prefix of the program or of the libraries.
OpenFilm* loadModule() {
  namespace fs = std::filesystem;
  const std::string name = "lintel_film.so";
  std::error_code error;
  const fs::path programs = fs::read_symlink("/proc/self/exe", error).parent_path();
  std::string reason;
  for (const fs::path& path :
       {fs::path(name), programs / ".." / LINTEL_MODULES_IN_PREFIX / name, fs::path(LINTEL_MODULES) / name}) {
    void* module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (module) return reinterpret_cast<OpenFilm*>(dlsym(module, "lintel_open_film"));
    if (reason.empty() || fs::exists(path, error)) reason = dlerror();
  }
  throw RecordingError("videos cannot be read, a part of Lintel does not load: " + reason);
}

}  // namespace

struct Film::Impl {
  std::string path;
  std::unique_ptr<FilmReader> reader;
  std::size_t next = 0;
};

Film::Film(const std::string& path) : impl_(std::make_unique<Impl>()) {
  static OpenFilm* const open = loadModule();
  impl_->path = path;
  impl_->reader.reset(open(path.c_str()));
  if (!impl_->reader)
    throw RecordingError(path + ": no video that can be read: convert it, for instance with ffmpeg -i FILE film.mkv");
}

Film::~Film() = default;

GrayImage Film::picture(std::size_t index) {
  const auto fault = [&] {
    return ImageFault(impl_->path + ": picture " + std::to_string(index + 1) +
                      " is missing (the film is shorter than its table of times, or cut)");
  };
  if (index < impl_->next) throw fault();
  for (; impl_->next <= index; ++impl_->next)
    if (!impl_->reader->advance()) throw fault();
  const cv::Mat grey = impl_->reader->grey();
  if (grey.empty()) throw fault();
  return grayImageOf(grey);
}

}  // namespace lintel
