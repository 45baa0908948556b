// SPDX-License-Identifier: BSD-3-Clause
#include "Film.h"

#include <cstdlib>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "ImageFile.h"
#include "SensorStream.h"

namespace lintel {

struct Film::Impl {
  std::string path;
  cv::VideoCapture capture;
  std::size_t next = 0;
};

Film::Film(const std::string& path) : impl_(std::make_unique<Impl>()) {
  impl_->path = path;
  // its libraries print beside what is thrown here
  setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  try {
    impl_->capture.open(path, cv::CAP_FFMPEG);
  } catch (const cv::Exception&) {
  }
  if (!impl_->capture.isOpened())
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
    if (!impl_->capture.grab()) throw fault();
  cv::Mat picture, grey;
  if (!impl_->capture.retrieve(picture) || picture.empty()) throw fault();
  if (picture.channels() == 1)
    grey = picture;
  else
    cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  return grayImageOf(grey);
}

}  // namespace lintel
