// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lintel/mapping/LineFitting.h"
#include "lintel/mapping/MapParams.h"

namespace lintel {

/// What two lines may differ in and still be one.
struct MergeAllowance {
  /// The same edge seen on a later pass may be off by so much, as the trajectory drifted in between. Such a pair is
  /// joined only where no third line that differs from its partner lies nearly as close to either. An adjustment can
  /// then align the passes.
  double drift_px = 0;
  /// The brighter side is the other one. Along an edge that has different things behind it contrast changes; but the
  /// other edge of a board has it, too, and one line at another depth may explain the views of both where poses are
  /// not known well. Such a pair is joined only where positions and directions agree within their covariances.
  bool contrast = false;
};

/// Joins lines that are estimates of the same edge: pieces of it, and tracks of it with different identities. Two lines
/// are one when they are nearly parallel, close to each other, overlap or nearly touch, were never seen side by side in
/// one image, the same side is the brighter one, and one line explains the views of both. The merged line has all views
/// and the lowest id. Lines without an estimate stay as they are. Returns the number of lines that were joined to
/// others.
int mergeLines(const KeyframeCameras& cameras, const LineFitParams& fit, const MergeParams& params,
               const MergeAllowance& allowance, std::vector<LineRecord>& lines);

}  // namespace lintel
