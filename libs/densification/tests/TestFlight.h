// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>

#include "lintel/densification/Densifier.h"
#include "lintel/geometry/Segment.h"

namespace lintel::test {

/// Keyframes that look along the world's z from places about the origin, points on a wall 5 m away, and the edges that
/// their images would have of segments in space.
class TestFlight {
 public:
  explicit TestFlight(std::size_t keyframes = 16) : random_(7) {
    material.rig.camera = {752, 480, 458, 457, 367, 248, -0.28, 0.07, 2e-4, 2e-5};
    for (FrameId id = 0; id < keyframes; ++id) {
      const double a = 0.7 * static_cast<double>(id);
      RetiredKeyframe k;
      k.id = id;
      k.t_ns = 1000 + static_cast<std::int64_t>(id) * 200'000'000;
      k.T_w_b.p = {0.1 * a * std::cos(a), 0.08 * a * std::sin(a), 0.05 * std::sin(2 * a)};
      material.keyframes.push_back(k);
      edges[k.t_ns];
    }
    for (TrackId id = 0; id < 60; ++id) {
      PointRecord point;
      point.id = id, point.known = true;
      point.p_w = {between(-2, 2), between(-1.5, 1.5), between(4.5, 5.5)};
      for (const RetiredKeyframe& k : material.keyframes)
        point.views.push_back({static_cast<std::uint32_t>(k.id), pixelOf(k, point.p_w).cast<float>(), true});
      material.points.push_back(point);
    }
  }

  double between(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }

  Eigen::Vector2d pixelOf(const RetiredKeyframe& k, const Eigen::Vector3d& p_w) const {
    return material.rig.camera.project(k.T_w_b.inverse() * p_w);
  }

  /// What a keyframe sees of a segment, whose brighter side is that of start x end.
  EdgeSegment edgeOf(const RetiredKeyframe& k, const Segment3& segment_w, double noise_px = 0.2) {
    std::normal_distribution<double> noise(0, noise_px);
    const Eigen::Vector2d start_px = pixelOf(k, segment_w.start), end_px = pixelOf(k, segment_w.end);
    const Eigen::Vector2d along = (end_px - start_px).normalized(), across(-along.y(), along.x());
    EdgeSegment edge;
    edge.start_px = (start_px + noise(random_) * across + between(0, 3) * along).cast<float>();
    edge.end_px = (end_px + noise(random_) * across - between(0, 3) * along).cast<float>();
    edge.sigma_px = 0.3f;
    return edge;
  }

  /// Adds the edges of a segment to every image.
  void show(const Segment3& segment_w) {
    for (const RetiredKeyframe& k : material.keyframes) edges[k.t_ns].push_back(edgeOf(k, segment_w));
  }

  /// Adds edges at random places to every image.
  void showNoise(int each) {
    for (const RetiredKeyframe& k : material.keyframes)
      for (int i = 0; i < each; ++i) {
        const Eigen::Vector2d at(between(30, 700), between(30, 440));
        const double angle = between(0, 2 * M_PI), length = between(20, 80);
        const Eigen::Vector2d end = at + length * Eigen::Vector2d(std::cos(angle), std::sin(angle));
        edges[k.t_ns].push_back({at.cast<float>(), end.cast<float>(), 0.3f});
      }
  }

  /// A tracked line, seen by the first `views` keyframes.
  LineRecord trackedLine(TrackId id, const Segment3& segment_w, std::size_t views) {
    LineRecord line;
    line.id = id;
    for (std::size_t k = 0; k < views; ++k) {
      const EdgeSegment edge = edgeOf(material.keyframes[k], segment_w);
      line.views.push_back({material.keyframes[k].id, id, edge.start_px, edge.end_px, 0.3f, true});
    }
    return line;
  }

  /// Segments on and before the wall, in many directions.
  std::vector<Segment3> someSegments() {
    std::vector<Segment3> segments;
    for (int i = 0; i < 12; ++i) {
      const Eigen::Vector3d at(-1.5 + 0.27 * i, i % 2 ? 0.6 : -0.6, 4 + 0.1 * i);
      const double angle = 0.5 + i;
      segments.push_back({at, at + 0.5 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.3)});
    }
    return segments;
  }

  MapMaterial material;
  ImageEdges edges;
  DensifyParams params;
  MapParams map;

 private:
  std::mt19937 random_;
};

/// How far the ends of a line's segment are from the line through another.
inline double distanceTo(const Segment3& a, const Segment3& line) {
  const Eigen::Vector3d d = line.direction();
  return std::max((a.start - line.start).cross(d).norm(), (a.end - line.start).cross(d).norm());
}

}  // namespace lintel::test
