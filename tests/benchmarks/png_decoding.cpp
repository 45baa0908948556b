// SPDX-License-Identifier: BSD-3-Clause
//
// png_decoding FOLDER: CPU time of decoding the grey PNG images of a folder (an EuRoC recording's mav0/cam0/data) with
// GrayPng and with the libraries. Every image goes through every decoder before the next one is read, so that all see
// the same machine; whether the pixels agree is checked.
#include <png.h>
#include <spng.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "../../libs/sensing/src/GrayPng.h"
#include "../ToolMain.h"
#include "lintel/core/Quantiles.h"
#include "lintel/core/ThreadTime.h"

namespace lintel {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes withGrayPng(const Bytes& file) {
  auto image = decodeGrayPng(file);
  return image ? std::move(image->pixels) : Bytes();
}

Bytes withSpng(const Bytes& file) {
  const std::unique_ptr<spng_ctx, void (*)(spng_ctx*)> png(spng_ctx_new(0), spng_ctx_free);
  std::size_t size = 0;
  if (spng_set_png_buffer(png.get(), file.data(), file.size()) != 0 ||
      spng_decoded_image_size(png.get(), SPNG_FMT_PNG, &size) != 0)
    return {};
  Bytes pixels(size);
  if (spng_decode_image(png.get(), pixels.data(), size, SPNG_FMT_PNG, 0) != 0) return {};
  return pixels;
}

Bytes withPng(const Bytes& file) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&image, file.data(), file.size()) == 0) return {};
  image.format = PNG_FORMAT_GRAY;
  Bytes pixels(PNG_IMAGE_SIZE(image));
  if (png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr) == 0) return {};
  return pixels;
}

Bytes withOpenCv(const Bytes& file) {
  const cv::Mat image = cv::imdecode(file, cv::IMREAD_GRAYSCALE);
  return {image.datastart, image.dataend};
}

struct Decoder {
  const char* name;
  std::function<Bytes(const Bytes&)> decode;
  std::vector<double> ms;
};

int run(int argc, char** argv) {
  if (argc != 2) throw std::invalid_argument("usage: png_decoding FOLDER");
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1])) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  Decoder decoders[] = {
      {"GrayPng", withGrayPng, {}}, {"libspng", withSpng, {}}, {"libpng", withPng, {}}, {"OpenCV", withOpenCv, {}}};
  for (const auto& path : paths) {
    std::ifstream stream(path, std::ios::binary);
    const Bytes file{std::istreambuf_iterator<char>(stream), {}};
    const Bytes expected = withOpenCv(file);
    for (Decoder& decoder : decoders) {
      const double start_ms = threadTimeMs();
      const Bytes pixels = decoder.decode(file);
      decoder.ms.push_back(threadTimeMs() - start_ms);
      if (pixels != expected) throw std::runtime_error(path.string() + ": other pixels by " + decoder.name);
    }
  }
  std::printf("%zu images, CPU time of one [ms], median (10 %% to 90 %%)\n", paths.size());
  for (Decoder& decoder : decoders)
    std::printf("%-28s %8.3f (%.3f to %.3f)\n", decoder.name, lowerQuantile(decoder.ms, 0.5),
                lowerQuantile(decoder.ms, 0.1), lowerQuantile(decoder.ms, 0.9));
  return 0;
}

}  // namespace
}  // namespace lintel

int main(int argc, char** argv) { return lintel::toolMain("png_decoding", lintel::run, argc, argv); }
