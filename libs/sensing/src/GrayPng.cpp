// SPDX-License-Identifier: BSD-3-Clause
#include "GrayPng.h"

#include <libdeflate.h>

#include <cstring>
#include <memory>
#include <string_view>

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

bool isPng(const std::vector<std::uint8_t>& file) {
  return file.size() >= 8 && std::memcmp(file.data(), kSignature, 8) == 0;
}

/// Calls `visit(type, data, size)` for each chunk; false where a check sum is wrong or the last chunk is missing.
template <class Visit>
bool forEachChunk(const std::vector<std::uint8_t>& file, const Visit& visit) {
  for (std::size_t at = 8; at + 12 <= file.size();) {
    const std::uint8_t* chunk = &file[at];
    const std::size_t size = number(chunk);
    if (size > file.size() - at - 12 || libdeflate_crc32(0, chunk + 4, size + 4) != number(chunk + 8 + size))
      return false;
    const std::string_view type(reinterpret_cast<const char*>(chunk) + 4, 4);
    visit(type, chunk + 8, size);
    if (type == "IEND") return true;
    at += size + 12;
  }
  return false;
}

/// Header and compressed rows of an image of the kind that is read here.
bool readChunks(const std::vector<std::uint8_t>& file, GrayImage& image, std::vector<std::uint8_t>& compressed) {
  compressed.reserve(file.size());
  const bool whole = forEachChunk(file, [&](std::string_view type, const std::uint8_t* data, std::size_t size) {
    if (type == "IHDR" && !readHeader(data, size, image)) image.width = 0;
    if (type == "IDAT" && image.width > 0) compressed.insert(compressed.end(), data, data + size);
  });
  return whole && image.width > 0;
}

}  // namespace

bool isDamagedPng(const std::vector<std::uint8_t>& file) {
  return isPng(file) && !forEachChunk(file, [](std::string_view, const std::uint8_t*, std::size_t) {});
}

std::optional<GrayImage> decodeGrayPng(const std::vector<std::uint8_t>& file) {
  GrayImage image;
  std::vector<std::uint8_t> compressed;
  if (!isPng(file) || !readChunks(file, image, compressed)) return std::nullopt;
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  const std::size_t size = (width + 1) * height;
  const std::unique_ptr<std::uint8_t[]> rows(new std::uint8_t[size]);  // all of it is overwritten
  const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> inflater(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  // without a place for the size, anything but exactly this many bytes is an error
  if (!inflater || libdeflate_zlib_decompress(inflater.get(), compressed.data(), compressed.size(), rows.get(), size,
                                              nullptr) != LIBDEFLATE_SUCCESS)
    return std::nullopt;
  if (!unfilterGray(rows.get(), width, height, image.pixels)) return std::nullopt;
  return image;
}

}  // namespace lintel
