// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

#include "TrueEdges.h"
#include "lintel/core/FrameTracks.h"

namespace lintel::truth {

/// Compares tracked lines with true edges.
///
/// A sighting is *anchored* to the true edge nearest to both of its ends, when that is within 1.5 px, shows along at
/// least half of the sighting, and the next other edge is 2 px further off. An identity *switches* when it is anchored
/// to another edge than before, the former edge is more than 4 px away now, and at least two earlier sightings lie on
/// the former edge and more than 4 px away from the new one. (Pieces of one straight edge lie in line, so that passing
/// from one to the next is no switch; nor is a texture's edge, which is no true one, that crosses true edges one by
/// one.) It *leaves* its edge when it is 4 px away from it without being on another one: shadows, textures, contours of
/// round things, which are no true edges.
class IdentityCheck {
 public:
  explicit IdentityCheck(const TrueEdges& edges) : edges_(edges) {}

  void add(const FrameTracks& tracks);

  int identities() const { return static_cast<int>(tracks_.size()); }
  int anchored() const;  ///< identities anchored in at least two frames
  int switched() const;  ///< of them with a switch
  int left() const;      ///< of them that left their edge for at least three frames, without a switch

  /// Distances of ends from the true edge over their sigma, of sightings without another true edge within 6 px.
  struct SigmaRatios {
    std::size_t count = 0;
    double typical = 0;   ///< median / 0.6745: 1 if normally distributed with the given sigmas
    double rms = 0;       ///< of those below 4 px
    double beyond_3 = 0;  ///< share beyond 3 sigma; 0.003 if normally distributed
    double error_px = 0;  ///< median / 0.6745 of the distances themselves
    double within_typical = 0,
           within_rms = 0;  ///< the same of what is left when each line's mean distance is taken away
  };
  SigmaRatios sigmaRatios() const;

  /// A line for every switch.
  void printSwitches(std::ostream& out) const;

 private:
  struct Track {
    int frames = 0, anchored = 0, edge = -1, away = 0;
    bool switched = false;
    std::vector<std::pair<std::int64_t, Eigen::Vector4d>> ends;  ///< of every sighting, undistorted pixels
  };
  struct Switch {
    std::int64_t t_ns;
    TrackId id;
    int from, to;
    Eigen::Vector2d middle_px;
    double off_px;
    std::string history;  ///< of the identity's distance from its former edge, frame by frame
  };
  struct Anchor {
    int edge = -1;
    bool isolated = false;
    double start_px = 0, end_px = 0;  ///< signed distances
  };
  Anchor anchorOf(const Eigen::Vector2d& start, const Eigen::Vector2d& end, const std::vector<SeenEdge>& seen) const;

  /// Number of sightings on `edge` and away from `other`.
  int sightingsOnlyOn(const Track& track, int edge, int other) const;
  /// Signed distances of the last sightings' ends from a true edge.
  std::string historyOf(const Track& track, int edge, std::size_t sightings) const;

  const TrueEdges& edges_;
  std::map<TrackId, Track> tracks_;
  std::vector<Switch> switches_;
  struct Error {
    double px, sigma_px;
  };
  std::map<TrackId, std::vector<Error>> errors_;  ///< signed, of ends: start, end, start, end, ...
};

}  // namespace lintel::truth
