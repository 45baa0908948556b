// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/ImageRenderer.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "LightMap.h"
#include "MipTexture.h"
#include "PixelRays.h"
#include "RayCaster.h"
#include "TexturePainter.h"
#include "lintel/simulation/SegmentView.h"

namespace lintel {

namespace {

constexpr float kBackground = 0.02f;

}  // namespace

class ImageRenderer::Impl {
 public:
  Impl(const Scene& scene, const Camera& camera) : scene_(scene), rays_(scene_), pixels_(camera), view_(camera) {
    for (const Material& m : scene_.materials) textures_.emplace_back(paintTexture(m), m.resolution_px, m.tile_m);
    for (const Patch& p : scene_.patches) {
      const Material& m = scene_.materials.at(static_cast<std::size_t>(p.material));
      patches_.push_back({p.normal().cast<float>(), static_cast<float>(p.edge_u.norm()),
                          static_cast<float>(p.edge_v.norm()), static_cast<float>(p.texture_origin_m.x()),
                          static_cast<float>(p.texture_origin_m.y()), static_cast<float>(m.albedo * p.tint),
                          &textures_[static_cast<std::size_t>(p.material)], LightMap(scene_, p, rays_)});
    }
  }

  Radiance render(const std::function<Pose(int row)>& T_w_c, const EdgeSampling& edges) const {
    const int width = pixels_.width(), height = pixels_.height();
    std::vector<View> views;
    for (int y = 0; y < height; ++y) {
      const Pose pose = T_w_c(y);
      views.push_back({pose.p.cast<float>(), pose.R().cast<float>()});
    }
    Radiance image(static_cast<std::size_t>(width) * height);
    std::vector<int> patch_of(image.size());
    for (int y = 0; y < height; ++y) castRow(views[static_cast<std::size_t>(y)], y, image, patch_of);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (surfacesMeet(patch_of, x, y))
          image[static_cast<std::size_t>(y) * width + x] = supersample(views[static_cast<std::size_t>(y)], x, y, edges);
      }
    }
    return image;
  }

  std::vector<bool> visibleLines(const Pose& T_w_c) const {
    const Pose T_c_w = T_w_c.inverse();
    std::vector<bool> visible;
    for (const SceneLine& line : scene_.lines) {
      int seen = 0;
      for (const double s : {0.1, 0.3, 0.5, 0.7, 0.9}) {
        const Eigen::Vector3d p_w = line.segment_w.start + s * (line.segment_w.end - line.segment_w.start);
        if (view_.project(T_c_w * p_w) && !rays_.occluded(T_w_c.p, p_w, 0.02)) ++seen;
      }
      visible.push_back(seen >= 2);
    }
    return visible;
  }

 private:
  /// What shading needs of a patch, in floats.
  struct ShadedPatch {
    Eigen::Vector3f normal;
    float length_u, length_v, origin_u, origin_v, albedo;
    const MipTexture* texture;
    LightMap light;
  };
  struct View {
    Eigen::Vector3f origin;
    Eigen::Matrix3f R_w_c;
  };

  static void setDirection(RayCaster::Packet& packet, int i, const Eigen::Vector3f& d) {
    packet.x[i] = d.x();
    packet.y[i] = d.y();
    packet.z[i] = d.z();
  }

  void castRow(const View& view, int y, Radiance& image, std::vector<int>& patch_of) const {
    constexpr int kPacket = RayCaster::kPacket;
    RayCaster::Packet packet;
    std::array<Eigen::Vector3f, kPacket> directions;
    std::array<RayHit, kPacket> hits;
    const int width = pixels_.width();
    for (int x = 0; x < width; x += kPacket) {
      for (int i = 0; i < kPacket; ++i) {
        directions[i] = view.R_w_c * pixels_.direction(std::min(x + i, width - 1), y);
        setDirection(packet, i, directions[i]);
      }
      rays_.cast(view.origin, packet, hits);
      for (int i = 0; i < kPacket && x + i < width; ++i) {
        const std::size_t at = static_cast<std::size_t>(y) * width + x + i;
        image[at] = shade(hits[i], directions[i], pixels_.angle());
        patch_of[at] = hits[i].patch;
      }
    }
  }

  bool surfacesMeet(const std::vector<int>& patch_of, int x, int y) const {
    const int width = pixels_.width(), height = pixels_.height();
    const int own = patch_of[static_cast<std::size_t>(y) * width + x];
    for (int yy = std::max(0, y - 1); yy <= std::min(height - 1, y + 1); ++yy) {
      for (int xx = std::max(0, x - 1); xx <= std::min(width - 1, x + 1); ++xx) {
        if (patch_of[static_cast<std::size_t>(yy) * width + xx] != own) return true;
      }
    }
    return false;
  }

  float supersample(const View& view, int x, int y, const EdgeSampling& edges) const {
    constexpr int kPacket = RayCaster::kPacket;
    const int samples = edges.rows * edges.columns;
    const float rows = static_cast<float>(edges.rows), columns = static_cast<float>(edges.columns);
    const float angle_rad = pixels_.angle() / std::sqrt(rows * columns);
    RayCaster::Packet packet;
    std::array<Eigen::Vector3f, kPacket> directions;
    std::array<RayHit, kPacket> hits;
    float sum = 0;
    for (int first = 0; first < samples; first += kPacket) {
      for (int i = 0; i < kPacket; ++i) {
        const int row = (first + i) / edges.columns, column = (first + i) % edges.columns;
        const float dx = (static_cast<float>(column) + 0.5f) / columns - 0.5f;
        const float dy = (static_cast<float>(row) + 0.5f) / rows - 0.5f;
        directions[i] = view.R_w_c * pixels_.direction(x, y, dx, dy);
        setDirection(packet, i, directions[i]);
      }
      rays_.cast(view.origin, packet, hits);
      for (int i = 0; i < kPacket; ++i) sum += shade(hits[i], directions[i], angle_rad);
    }
    return sum / static_cast<float>(samples);
  }

  /// `angle_rad`: what one sample covers.
  float shade(const RayHit& hit, const Eigen::Vector3f& direction, float angle_rad) const {
    if (hit.patch < 0) return kBackground;
    const ShadedPatch& p = patches_[static_cast<std::size_t>(hit.patch)];
    const float length = direction.norm(), cosine = std::max(0.05f, std::abs(p.normal.dot(direction)) / length);
    const float footprint = hit.distance * length * angle_rad / std::sqrt(cosine);
    const float texture = p.texture->at(p.origin_u + hit.a * p.length_u, p.origin_v + hit.b * p.length_v, footprint);
    return p.albedo * texture * p.light.at(hit.a, hit.b);
  }

  Scene scene_;
  RayCaster rays_;
  PixelRays pixels_;
  ViewTest view_;
  std::vector<MipTexture> textures_;
  std::vector<ShadedPatch> patches_;
};

ImageRenderer::ImageRenderer(const Scene& scene, const Camera& camera) : impl_(std::make_unique<Impl>(scene, camera)) {}
ImageRenderer::~ImageRenderer() = default;
Radiance ImageRenderer::render(const Pose& T_w_c, const EdgeSampling& edges) const {
  return impl_->render([&](int) { return T_w_c; }, edges);
}
Radiance ImageRenderer::render(const std::function<Pose(int row)>& T_w_c, const EdgeSampling& edges) const {
  return impl_->render(T_w_c, edges);
}
std::vector<bool> ImageRenderer::visibleLines(const Pose& T_w_c) const { return impl_->visibleLines(T_w_c); }

}  // namespace lintel
