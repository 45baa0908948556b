// SPDX-License-Identifier: BSD-3-Clause
#include "GrayPng.h"

#include <libdeflate.h>

#include <cstring>
#include <memory>

#include "PngFilters.h"

namespace lintel {

namespace {

constexpr std::uint8_t kSignature[8] = {137, 'P', 'N', 'G', 13, 10, 26, 10};
constexpr std::size_t kMaxPixels = std::size_t{1} << 28;

std::uint32_t number(const std::uint8_t* p) {
  return (std::uint32_t{p[0]} << 24) | (std::uint32_t{p[1]} << 16) | (std::uint32_t{p[2]} << 8) | p[3];
}

/// Size of an image of the kind that is read here: 8-bit grey, not interlaced.
bool readHeader(const std::uint8_t* data, std::size_t size, GrayImage& image) {
  if (size != 13) return false;
  const std::uint32_t width = number(data), height = number(data + 4);
  constexpr std::uint8_t kGray[5] = {8, 0, 0, 0, 0};  // depth, colour, compression, filters, interlace
  if (std::memcmp(data + 8, kGray, 5) != 0 || width == 0 || height == 0 || width > kMaxPixels / height) return false;
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  return true;
}

/// Header and compressed rows of a file whose check sums are right.
bool readChunks(const std::vector<std::uint8_t>& file, GrayImage& image, std::vector<std::uint8_t>& compressed) {
  if (file.size() < 8 || std::memcmp(file.data(), kSignature, 8) != 0) return false;
  compressed.reserve(file.size());
  for (std::size_t at = 8; at + 12 <= file.size();) {
    const std::uint8_t* chunk = &file[at];
    const std::size_t size = number(chunk);
    if (size > file.size() - at - 12 || libdeflate_crc32(0, chunk + 4, size + 4) != number(chunk + 8 + size)) return false;
    const auto is = [&](const char* type) { return std::memcmp(chunk + 4, type, 4) == 0; };
    if (is("IHDR") && !readHeader(chunk + 8, size, image)) return false;
    if (is("IDAT")) compressed.insert(compressed.end(), chunk + 8, chunk + 8 + size);
    if (is("IEND")) return image.width > 0;
    at += size + 12;
  }
  return false;
}

}  // namespace

std::optional<GrayImage> decodeGrayPng(const std::vector<std::uint8_t>& file) {
  GrayImage image;
  std::vector<std::uint8_t> compressed;
  if (!readChunks(file, image, compressed)) return std::nullopt;
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  std::vector<std::uint8_t> rows((width + 1) * height);
  const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> inflater(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  // without a place for the size, anything but exactly this many bytes is an error
  if (!inflater || libdeflate_zlib_decompress(inflater.get(), compressed.data(), compressed.size(), rows.data(),
                                              rows.size(), nullptr) != LIBDEFLATE_SUCCESS)
    return std::nullopt;
  if (!unfilterGray(rows, width, height, image.pixels)) return std::nullopt;
  return image;
}

}  // namespace lintel
