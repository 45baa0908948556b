// SPDX-License-Identifier: BSD-3-Clause
// The module lintel_film.so: FilmReader by OpenCV's videoio.
#include <cstdlib>
#include <memory>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "FilmReader.h"

namespace lintel {

namespace {

class Capture : public FilmReader {
 public:
  bool open(const std::string& path) {
    try {
      return capture_.open(path, cv::CAP_FFMPEG) && capture_.isOpened();
    } catch (const cv::Exception&) {
      return false;
    }
  }

  bool advance() override { return capture_.grab(); }

  cv::Mat grey() override {
    cv::Mat picture, grey;
    if (!capture_.retrieve(picture) || picture.empty() || picture.channels() == 1) return picture;
    cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
    return grey;
  }

 private:
  cv::VideoCapture capture_;
};

}  // namespace

extern "C" __attribute__((visibility("default"))) FilmReader* lintel_open_film(const char* path) {
  // the decoders print beside what Film throws
  setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  auto reader = std::make_unique<Capture>();
  return reader->open(path) ? reader.release() : nullptr;
}

}  // namespace lintel
