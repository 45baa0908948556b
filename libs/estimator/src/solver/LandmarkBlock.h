// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "lintel/factors/ImageFactor.h"
#include "lintel/factors/TrackLoss.h"
#include "lintel/factors/TrackNoise.h"
#include "solver/CameraEquations.h"
#include "solver/CameraPairs.h"
#include "solver/Factor.h"
#include "solver/PanelSquare.h"
#include "solver/SightingRows.h"

namespace lintel {

/// What a landmark's linearisation needs for a moment, one after the other.
struct LandmarkScratch {
  std::vector<SightingRows> rows, weighted_rows;
  std::vector<CameraRows> camera_rows;
  std::vector<Eigen::Vector2d> residuals, whitened;
  std::vector<double> weights, information;
  SightingProducts products;
};

/// A point or a line that is eliminated: its residuals, its part of the normal equations, and its last elimination.
///
/// The errors of its sightings are correlated (TrackNoise); by which kind of noise, the residuals of the first
/// linearisation decide. With r the residuals of all, whitened ones are L^-1 r; the loss counts for each of these, the
/// track's for their sum. In the normal equations sightings i and j then meet with the weight in row i and column j of
/// the information L^-T diag(weights) L^-1: its rows are weighted by three passes over them, L^-1, weights, L^-T.
template <class Target>
struct LandmarkBlock {
  static constexpr int T = Target::kTangent, kSize = Target::kSize;
  static constexpr BlockKey::Kind kKind = kKindOf<Target>;
  static_assert(Target::kRows == 2, "what SightingRows is for");
  struct Sighting {
    const ImageFactor<Target>* factor = nullptr;
    int camera = 0;
    double t_s = 0;
  };

  double* block = nullptr;
  const Eigen::Vector3d* origin_w = nullptr;
  const ceres::LossFunction* loss = nullptr;  ///< of a sighting
  const TrackNoise* noise = &kWhiteNoise;
  std::vector<Sighting> sightings;  ///< the earliest first
  const Factor* tie = nullptr;      ///< ties a line to a direction
  int direction = -1;               ///< its place among the kept targets

  Eigen::Matrix<double, T, T> H, inverse_root;
  Eigen::Matrix<double, T, 1> b, step;
  Eigen::Matrix<double, Eigen::Dynamic, T> W, Y;  ///< the landmark's columns of H, in the rows of its cameras, of the
                                                  ///< correction and of its direction; the same times inverse_root
  std::vector<RowRun> runs;                       ///< where these rows lie in CameraEquations
  Whitener whitener;                              ///< empty before the first linearisation
  std::optional<double> mean_square;              ///< of the residuals then, of a track that is long enough
  std::vector<Eigen::Index> camera_places;        ///< in CameraEquations

  /// What does not depend on the blocks' values, when all sightings and the tie are there.
  void prepare(const CameraLayout& layout);

  /// The landmark's robust cost at the blocks' present values.
  double cost(const std::vector<CameraView>& views, const double* correction, const CameraLayout& layout,
              LandmarkScratch& scratch) const;

  /// Takes residuals and Jacobians, adds the cameras' part to `eq`; returns the cost.
  double linearise(const std::vector<CameraView>& views, const double* correction, const CameraLayout& layout,
                   LandmarkScratch& scratch, CameraEquations& eq);

  /// Takes the landmark out of `eq`, `damping` times its diagonal added.
  void eliminate(double damping, CameraEquations& eq);

  /// Its reaction to a step of the cameras, in `step`; returns its part of the model's decrease.
  double backSubstitute(const Eigen::VectorXd& camera_step, double damping);

 private:
  using PlusJacobian = Eigen::Matrix<double, kSize, T, Eigen::RowMajor>;
  void chooseNoise(LandmarkScratch& scratch);
  std::optional<double> meanSquare(const std::vector<Eigen::Vector2d>& whitened) const;
  double whitenedCost(const std::vector<Eigen::Vector2d>& whitened, std::vector<double>& weights) const;
  Eigen::Index correctionRow() const { return kCameraTangent * static_cast<Eigen::Index>(sightings.size()); }
  void takeRows(const std::vector<CameraView>& views, const double* correction, LandmarkScratch& scratch) const;
  double weighRows(LandmarkScratch& scratch) const;
  void addProducts(const SightingProducts& products, const CameraLayout& layout, CameraEquations& eq);
  double addTie(const CameraLayout& layout, CameraEquations& eq);
};

/// A residual of an image whose target is kept; it has no loss of its track.
template <class Target>
struct KeptSighting {
  const ImageFactor<Target>* factor = nullptr;
  const ceres::LossFunction* loss = nullptr;
  int camera = 0, target = 0;

  double cost(const std::vector<CameraView>& views, const double* correction, const CameraLayout& layout) const;
  double linearise(const std::vector<CameraView>& views, const double* correction, const CameraLayout& layout,
                   CameraEquations& eq) const;
};

// no factor ties a point to a direction
template <>
double LandmarkBlock<PointTarget>::addTie(const CameraLayout& layout, CameraEquations& eq);
template <>
double LandmarkBlock<LineTarget>::addTie(const CameraLayout& layout, CameraEquations& eq);

// Compiled in PointBlock.cpp, LineBlock.cpp, KeptSighting.cpp.
extern template struct LandmarkBlock<PointTarget>;
extern template struct LandmarkBlock<LineTarget>;
extern template struct KeptSighting<PointTarget>;
extern template struct KeptSighting<LineTarget>;
extern template struct KeptSighting<DirectionTarget>;

}  // namespace lintel
