// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

namespace lintel {

/// Decodes a video's pictures one after the other. The decoders come with a hundred libraries, which made a third of
/// the time that every program takes to start: they are linked to a module (FilmModule.cpp) that Film loads when a
/// video is opened.
class FilmReader {
 public:
  virtual ~FilmReader() = default;

  /// Goes on to the next picture. False at the end.
  virtual bool advance() = 0;

  /// The picture that advance() came to, 8 bits; empty when it cannot be decoded.
  virtual cv::Mat grey() = 0;
};

/// The module's function lintel_open_film: null when no video can be read from the file.
using OpenFilm = FilmReader*(const char* path);

}  // namespace lintel
