// SPDX-License-Identifier: BSD-3-Clause
#include "TexturePainter.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "lintel/simulation/Random.h"

namespace lintel {

namespace {

/// Periodic value noise: `cells_x` by `cells_y` random values over the tile, cubic between them; about -1 to 1.
cv::Mat1f latticeNoise(int size, int cells_x, int cells_y, RandomStream& random) {
  constexpr int kPad = 4;  // wrapped border, so that the interpolation is periodic
  cv::Mat1f cells(cells_y, cells_x);
  for (float& value : cells) value = static_cast<float>(random.uniform(-1, 1));
  cv::Mat1f padded, grown;
  cv::copyMakeBorder(cells, padded, kPad, kPad, kPad, kPad, cv::BORDER_WRAP);
  const int sx = size / cells_x, sy = size / cells_y;
  cv::resize(padded, grown, {padded.cols * sx, padded.rows * sy}, 0, 0, cv::INTER_CUBIC);
  return grown(cv::Rect(kPad * sx, kPad * sy, size, size)).clone();
}

cv::Mat1f octaves(int size, int first_cells, int last_cells, float falloff, RandomStream& random) {
  cv::Mat1f sum(size, size, 0.0f);
  float amplitude = 1;
  for (int cells = first_cells; cells <= last_cells && cells <= size; cells *= 2, amplitude *= falloff) {
    sum += amplitude * latticeNoise(size, cells, cells, random);
  }
  return sum;
}

/// A filled random convex-ish polygon, drawn at all wrapped places.
void wrappedPolygon(cv::Mat1f& tile, double radius_px, float value, RandomStream& random) {
  const int size = tile.cols, corners = 3 + random.index(4);
  const double cx = random.uniform(0, size), cy = random.uniform(0, size), start = random.uniform(0, 6.28);
  std::vector<cv::Point> shape;
  for (int i = 0; i < corners; ++i) {
    const double angle = start + 6.2832 * (i + random.uniform(-0.25, 0.25)) / corners,
                 r = radius_px * random.uniform(0.6, 1.2);
    shape.emplace_back(cvRound(16 * (cx + r * std::cos(angle))), cvRound(16 * (cy + r * std::sin(angle))));
  }
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      std::vector<cv::Point> moved = shape;
      for (cv::Point& p : moved) p += cv::Point(16 * dx * size, 16 * dy * size);
      cv::fillConvexPoly(tile, moved, cv::Scalar(value), cv::LINE_AA, 4);
    }
  }
}

void scatter(cv::Mat1f& tile, int count, double smallest_px, double largest_px, float contrast, RandomStream& random) {
  for (int i = 0; i < count; ++i) {
    const double radius = smallest_px * std::pow(largest_px / smallest_px, random.uniform());
    const float value = 1 + contrast * static_cast<float>(random.uniform(-1, 1));
    wrappedPolygon(tile, radius, value, random);
  }
}

cv::Mat1f paint(const Material& m, RandomStream& random) {
  const int n = m.resolution_px;
  return 1 + 0.03f * octaves(n, 4, n / 4, 0.8f, random);
}

cv::Mat1f plaster(const Material& m, RandomStream& random) {
  const int n = m.resolution_px;
  const double px_per_m = n / m.tile_m;
  cv::Mat1f tile(n, n, 1.0f);
  scatter(tile, static_cast<int>(14 * m.tile_m * m.tile_m), 0.015 * px_per_m, 0.07 * px_per_m, 0.45f,
          random);  // stains
  return tile + 0.07f * octaves(n, 4, n / 2, 0.85f, random);
}

cv::Mat1f terrazzo(const Material& m, RandomStream& random) {
  const int n = m.resolution_px;
  const double px_per_m = n / m.tile_m;
  cv::Mat1f tile(n, n, 1.0f);
  scatter(tile, static_cast<int>(120 * m.tile_m * m.tile_m), 0.01 * px_per_m, 0.06 * px_per_m, 0.55f, random);
  return tile + 0.05f * octaves(n, 8, n / 2, 0.8f, random);
}

cv::Mat1f wood(const Material& m, RandomStream& random) {
  const int n = m.resolution_px;
  cv::Mat1f tile(n, n, 1.0f);
  for (int cells = 16; cells <= n / 4; cells *= 2)
    tile += 0.06f * latticeNoise(n, std::max(4, cells / 16), cells, random);
  const double px_per_m = n / m.tile_m;
  scatter(tile, static_cast<int>(10 * m.tile_m * m.tile_m), 0.008 * px_per_m, 0.025 * px_per_m, 0.5f, random);  // knots
  return tile;
}

cv::Mat1f carton(const Material& m, RandomStream& random) {
  const int n = m.resolution_px;
  cv::Mat1f tile = 1 + 0.05f * octaves(n, 4, n / 4, 0.8f, random);
  const double px_per_m = n / m.tile_m;
  const char* const words[] = {"FRAGILE", "LINTEL", "No 7431", "THIS SIDE UP", "48 PCS", "PLUECKER", "DEBIAN 12"};
  for (int i = 0; i < static_cast<int>(5 * m.tile_m * m.tile_m); ++i) {
    const cv::Point at(static_cast<int>(random.uniform(0, 0.7 * n)),
                       static_cast<int>(random.uniform(0.1 * n, 0.95 * n)));
    cv::putText(tile, words[random.index(7)], at, cv::FONT_HERSHEY_DUPLEX, 0.0035 * px_per_m * random.uniform(0.6, 1.2),
                cv::Scalar(random.uniform(0.2, 0.6)), std::max(1, cvRound(0.008 * px_per_m)), cv::LINE_AA);
  }
  scatter(tile, static_cast<int>(12 * m.tile_m * m.tile_m), 0.01 * px_per_m, 0.05 * px_per_m, 0.4f, random);
  return tile;
}

cv::Mat1f poster(const Material& m, RandomStream& random) {
  const int n = m.resolution_px;
  cv::Mat1f tile(n, n, static_cast<float>(random.uniform(0.7, 1.3)));
  for (int i = 0; i < 26; ++i) {
    const cv::Point at(random.index(n), random.index(n));
    const cv::Scalar value(random.uniform(0.15, 1.6));
    const int size = cvRound(n * random.uniform(0.03, 0.16));
    switch (random.index(4)) {
      case 0:
        cv::circle(tile, at, size, value, random.index(2) ? cv::FILLED : size / 4 + 1, cv::LINE_AA);
        break;
      case 1:
        cv::ellipse(tile, at, {size, size / 2}, random.uniform(0, 180), 0, 360, value, cv::FILLED, cv::LINE_AA);
        break;
      case 2:
        cv::putText(tile, std::string(1, static_cast<char>('A' + random.index(26))), at, cv::FONT_HERSHEY_TRIPLEX,
                    size / 16.0, value, std::max(2, size / 10), cv::LINE_AA);
        break;
      default:
        wrappedPolygon(tile, size, static_cast<float>(value[0]), random);
    }
  }
  return tile + 0.03f * octaves(n, 8, n / 4, 0.8f, random);
}

}  // namespace

std::vector<std::uint8_t> paintTexture(const Material& material) {
  RandomStream random(material.seed, static_cast<std::uint64_t>(material.pattern));
  cv::Mat1f tile;
  switch (material.pattern) {
    case Pattern::kPaint:
      tile = paint(material, random);
      break;
    case Pattern::kPlaster:
      tile = plaster(material, random);
      break;
    case Pattern::kTerrazzo:
      tile = terrazzo(material, random);
      break;
    case Pattern::kWood:
      tile = wood(material, random);
      break;
    case Pattern::kCarton:
      tile = carton(material, random);
      break;
    case Pattern::kPoster:
      tile = poster(material, random);
      break;
  }
  cv::flip(tile, tile, 0);  // pictures are painted from the top, texture coordinates go up
  std::vector<std::uint8_t> values;
  values.reserve(tile.total());
  for (const float value : tile) values.push_back(cv::saturate_cast<std::uint8_t>(128 * value));
  return values;
}

}  // namespace lintel
