// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/opengl/CCamera.h>
#include <mrpt/opengl/CGridPlaneXY.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "GzipStream.h"
#include "Writers.h"

namespace lintel {

namespace {

using namespace mrpt::opengl;

constexpr float kLineWidth_px = 2, kPointSize_px = 2;

mrpt::img::TColor colourOf(Rgb c) { return {c.r, c.g, c.b}; }

/// One CSetOfLines per colour: MRPT's has only one.
void addSegments(const DrawnPart& part, CSetOfObjects& scene) {
  std::map<Rgb, CSetOfLines::Ptr> by_colour;
  for (const DrawnSegment& s : part.segments) {
    auto& lines = by_colour[s.colour];
    if (!lines) {
      lines = CSetOfLines::Create();
      lines->setColor_u8(colourOf(s.colour));
      lines->setLineWidth(kLineWidth_px);
    }
    lines->appendLine(s.start.x(), s.start.y(), s.start.z(), s.end.x(), s.end.y(), s.end.z());
  }
  for (const auto& [colour, lines] : by_colour) {
    lines->setName(part.name);
    scene.insert(lines);
  }
}

void addPointCloud(const DrawnPart& part, CSetOfObjects& scene) {
  auto cloud = CPointCloudColoured::Create();
  cloud->setName(part.name);
  cloud->setPointSize(kPointSize_px);
  cloud->reserve(part.points.size());
  for (const DrawnPoint& point : part.points) {
    const Eigen::Vector3f p = point.p.cast<float>();
    cloud->insertPoint({p.x(), p.y(), p.z(), point.colour.r, point.colour.g, point.colour.b});
  }
  scene.insert(cloud);
}

void addGround(const Drawing& drawing, COpenGLScene& scene) {
  const auto& core = drawing.core;
  const double extent = std::max(core.diagonal().norm(), 1e-3),
               step = std::pow(10.0, std::floor(std::log10(extent))) / 2;
  const auto down = [&](double v) { return static_cast<float>(std::floor(v / step) * step); };
  const auto up = [&](double v) { return static_cast<float>(std::ceil(v / step) * step); };
  auto grid = CGridPlaneXY::Create(down(core.min().x()), up(core.max().x()), down(core.min().y()), up(core.max().y()),
                                   static_cast<float>(core.min().z()), static_cast<float>(step));
  grid->setColor_u8({205, 205, 205});
  grid->setName("Ground");
  scene.insert(grid);
}

void lookAtMap(const Drawing& drawing, COpenGLScene& scene) {
  auto& camera = scene.getViewport()->getCamera();
  const Eigen::Vector3f centre = drawing.core.center().cast<float>();
  camera.setPointingAt(centre.x(), centre.y(), centre.z());
  camera.setZoomDistance(static_cast<float>(1.3 * std::max(drawing.core.diagonal().norm(), 1e-3)));
  camera.setAzimuthDegrees(-60);
  camera.setElevationDegrees(35);
  scene.enableFollowCamera(true);  // else SceneViewer3D keeps a camera of its own, 20 m from the origin
}

}  // namespace

OutputFiles sceneFiles(const Drawing& drawing, const std::string& path) {
  COpenGLScene scene;
  addGround(drawing, scene);
  for (const DrawnPart& part : drawing.parts) {
    auto objects = CSetOfObjects::Create();
    if (!part.segments.empty()) addSegments(part, *objects);
    if (!part.points.empty()) addPointCloud(part, *objects);
    objects->setName(part.name);
    scene.insert(objects);
  }
  lookAtMap(drawing, scene);
  GzipStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << scene;
  return {{path, stream.finish()}};
}

}  // namespace lintel
