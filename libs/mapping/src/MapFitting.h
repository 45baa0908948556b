// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LineMerging.h"
#include "PointFitting.h"
#include "lintel/mapping/LineFitting.h"
#include "lintel/mapping/LineMap.h"
#include "lintel/mapping/MapParams.h"
#include "lintel/mapping/PointJoin.h"

namespace lintel {

/// Estimates and merges the landmarks of a material with its cameras as they are.
class MapFitting {
 public:
  MapFitting(const MapParams& params, MapMaterial& material);

  /// Every point and line anew from all its views, outliers included, as they may fit the present poses.
  void fitAll();

  /// Joins estimates of the same landmark; returns how many were joined to others.
  int merge(const MergeAllowance& allowance);

  /// The same, of lines only.
  int mergeLines(const MergeAllowance& allowance = {});

  /// See joinPoints().
  int join(const std::vector<PointJoin>& joins, double most_px, double sigma_px);

  /// Ties degenerate lines to groups of parallel lines whose directions are known.
  void tie();

  /// See alignToGroups().
  void align();

  const KeyframeCameras& cameras() const { return cameras_; }

 private:
  std::vector<MapGroup> groups() const;

  const MapParams& params_;
  MapMaterial& material_;
  KeyframeCameras cameras_;
  LineFitParams line_;
  PointFitParams point_;
};

}  // namespace lintel
