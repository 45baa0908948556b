// SPDX-License-Identifier: BSD-3-Clause
#include "landmarks/LineDegeneracy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "TestWindow.h"
#include "landmarks/LineTriangulation.h"
#include "lintel/geometry/SmallMatrices.h"

namespace lintel {
namespace {

using namespace test;

/// A line 1 m from the origin (phi = 45 degrees) with independent, equal uncertainties.
const OrthonormalLine kLine{Eigen::Quaterniond::Identity(), M_PI / 4};

Eigen::Matrix4d informationOf(double sx, double sy, double sz, double sphi) {
  return Eigen::Vector4d(1 / (sx * sx), 1 / (sy * sy), 1 / (sz * sz), 1 / (sphi * sphi)).asDiagonal();
}

TEST(LineUncertainty, TheDirectionsTurnsAreAboutXAndZ) {
  EXPECT_NEAR(uncertaintyOf(kLine, informationOf(0.02, 0.5, 0.01, 0.1), 0).direction_rad, 0.02, 1e-9);
  EXPECT_NEAR(uncertaintyOf(kLine, informationOf(0.01, 0.5, 0.03, 0.1), 0).direction_rad, 0.03, 1e-9);
}

TEST(LineUncertainty, TheFootMovesByPsiYTimesDistanceAndByPhi) {
  EXPECT_NEAR(uncertaintyOf(kLine, informationOf(1e-4, 0.05, 1e-4, 1e-4), 0).distance_m, 0.05, 1e-6);
  // r = cot(phi): dr = dphi / sin^2(phi) = 2 dphi
  EXPECT_NEAR(uncertaintyOf(kLine, informationOf(1e-4, 1e-4, 1e-4, 0.03), 0).distance_m, 0.06, 1e-6);
  const OrthonormalLine far{Eigen::Quaterniond::Identity(), std::atan(1.0 / 5)};
  EXPECT_NEAR(uncertaintyOf(far, informationOf(1e-6, 0.01, 1e-6, 1e-6), 0).distance_m, 0.05, 1e-4);
}

TEST(LineUncertainty, AwayFromTheFootTheDirectionCountsToo) {
  const LineUncertainty u = uncertaintyOf(kLine, informationOf(0.02, 1e-5, 1e-5, 1e-5), 4);
  EXPECT_NEAR(u.distance_m, 0.08, 1e-6);
}

TEST(LineUncertainty, WhatNobodySawIsHuge) {
  Eigen::Matrix4d information = informationOf(0.01, 0.01, 0.01, 0.01);
  information.row(0).setZero();
  information.col(0).setZero();
  EXPECT_GT(uncertaintyOf(kLine, information, 0).direction_rad, 100);
  EXPECT_LT(uncertaintyOf(kLine, information, 0).distance_m, 0.03);
}

/// Largest standard deviation of a cloud of error vectors.
double worstSigma(const std::vector<Eigen::Vector3d>& errors) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& e : errors) covariance += e * e.transpose() / static_cast<double>(errors.size());
  return std::sqrt(symmetricEigen(covariance).values[2]);
}

/// The sigmas that a line gets against the scatter of the lines that noisy sightings give.
void compareWithMonteCarlo(const std::vector<Pose>& poses, const Segment3& segment_w) {
  const double sigma_px = 0.5;
  EstimatorParams params;
  params.factors.line_sigma_px = sigma_px;
  params.factors.line_loss_width = 1e3;  // least squares: what the sigma assumes
  params.degeneracy.max_sigma_direction_rad = params.degeneracy.max_sigma_distance = 10;
  const auto triangulated = [&](const std::function<Eigen::Vector2d()>& noise) {
    SlidingWindow window = windowAt(poses);
    for (FrameId k = 0; k < poses.size(); ++k) seeLine(window, 1, k, segment_w, noise(), noise());
    EXPECT_TRUE(triangulateLine(window, params, window.lines[1]));
    return window.lines[1];
  };
  const LineTrack clean = triangulated([] { return Eigen::Vector2d::Zero(); });
  std::mt19937 random(11);
  std::normal_distribution<double> gauss(0, sigma_px);
  std::vector<Eigen::Vector3d> directions, positions;
  for (int i = 0; i < 1500; ++i) {
    const PluckerLine line = lineInWorld(triangulated([&] { return Eigen::Vector2d(gauss(random), gauss(random)); }));
    Eigen::Vector3d d = line.d.normalized();
    if (d.dot(segment_w.direction()) < 0) d = -d;
    directions.push_back(d - segment_w.direction());
    const Eigen::Vector3d p = line.nearestPoint() - segment_w.midpoint();
    positions.push_back(p - d * d.dot(p));  // across the line, at the middle of what was seen
  }
  EXPECT_NEAR(clean.sigma_direction_rad / worstSigma(directions), 1, 0.1);
  EXPECT_NEAR(clean.sigma_distance_m / worstSigma(positions), 1, 0.1);
}

TEST(LineUncertainty, TwoCamerasBesideEachOtherAsMonteCarlo) {
  compareWithMonteCarlo({at(0, 0, 0), at(0.6, 0, 0)}, {{0.4, -0.8, 4}, {0.4, 0.8, 4}});
}

TEST(LineUncertainty, ASlantedLineFromManyCamerasAsMonteCarlo) {
  compareWithMonteCarlo({at(0, 0, 0), at(0.3, 0.1, 0), at(0.5, -0.2, 0.2), at(0.7, 0.1, 0.3)},
                        {{-0.5, -0.9, 3.5}, {0.8, 0.5, 4.5}});
}

TEST(LineUncertainty, HalfTheBaselineDoublesTheSigma) {
  EstimatorParams params;
  const auto sigma = [&](double baseline) {
    SlidingWindow window = windowAt({at(0, 0, 0), at(baseline, 0, 0)});
    for (FrameId k : {0u, 1u}) seeLine(window, 1, k, {{0.1, -0.8, 4}, {0.1, 0.8, 4}});
    EXPECT_TRUE(triangulateLine(window, params, window.lines[1]));
    return window.lines[1].sigma_distance_m;
  };
  EXPECT_NEAR(sigma(0.1) / sigma(0.2), 2, 0.05);
}

/// A line seen from some cameras, without its triangulation.
SlidingWindow seen(const std::vector<Pose>& poses, const Segment3& segment_w) {
  SlidingWindow window = windowAt(poses);
  for (FrameId k = 0; k < poses.size(); ++k) seeLine(window, 1, k, segment_w);
  return window;
}

TEST(EpipoleAngle, IsZeroForALineThroughTheEpipole) {
  const SlidingWindow ahead = seen({at(0, 0, 0), at(0, 0, 0.5)}, {{0.7, 1, 3}, {0.7, 1, 9}});  // a rail
  EXPECT_NEAR(epipoleAngle(ahead, ahead.lines.at(1)), 0, 1e-6);
  const SlidingWindow strut = seen({at(0, 0, 0), at(0, 0, 0.5)}, {{0.4, 0.4, 3}, {0.8, 0.8, 4}});  // not parallel to it
  EXPECT_NEAR(epipoleAngle(strut, strut.lines.at(1)), 0, 1e-6);
}

TEST(EpipoleAngle, IsTheAngleBetweenPlaneAndMotion) {
  // moving along x below a line in the plane z = 4 that is turned by 30 degrees against x
  const Segment3 segment{{-0.5 * std::cos(M_PI / 6), -0.5 * std::sin(M_PI / 6), 4},
                         {0.5 * std::cos(M_PI / 6), 0.5 * std::sin(M_PI / 6), 4}};
  const SlidingWindow window = seen({at(-1, 0, 0), at(-0.5, 0, 0), at(0, 0, 0)}, segment);
  EXPECT_NEAR(epipoleAngle(window, window.lines.at(1)), M_PI / 6, 1e-6);
}

TEST(EpipoleAngle, TheLongestWayCountsNotTheNoiseOfShortOnes) {
  // the second camera is a centimetre beside the way
  const SlidingWindow window = seen({at(0, 0, 0), at(0, 0.01, 0.98), at(0, 0, 1)}, {{0.7, 1, 3}, {0.7, 1, 9}});
  EXPECT_NEAR(epipoleAngle(window, window.lines.at(1)), 0, 1e-6);
}

TEST(JudgeLine, EachTestHasItsOwnLimits) {
  const SlidingWindow rail = seen({at(0, 0, 0), at(0, 0, 0.5)}, {{0.7, 1, 3}, {0.7, 1, 9}});
  const SlidingWindow upright = seen({at(0, 0, 0), at(0.5, 0, 0)}, {{0, -1, 4}, {0, 1, 4}});
  DegeneracyParams params;
  LineTrack known = rail.lines.at(1), crosswise = upright.lines.at(1);
  known.sigma_direction_rad = crosswise.sigma_direction_rad = 0.5 * params.max_sigma_direction_rad;
  known.sigma_distance_m = crosswise.sigma_distance_m = 0.5 * params.max_sigma_distance * 4;
  for (const std::string test : {"observability", "epipole", "both"}) {
    params.test = test;
    EXPECT_EQ(judgeLine(rail, params, known, 4),
              test == "observability" ? LineVerdict::kGood : LineVerdict::kThroughEpipole)
        << test;
    EXPECT_EQ(judgeLine(upright, params, crosswise, 4), LineVerdict::kGood) << test;
  }
  LineTrack turned = crosswise, deep = crosswise;
  turned.sigma_direction_rad = 2 * params.max_sigma_direction_rad;
  deep.sigma_distance_m = 2 * params.max_sigma_distance * 4;
  for (const std::string test : {"observability", "epipole", "both"}) {
    params.test = test;
    const bool by_sigma = test != "epipole";
    EXPECT_EQ(judgeLine(upright, params, turned, 4), by_sigma ? LineVerdict::kDirectionUnknown : LineVerdict::kGood);
    EXPECT_EQ(judgeLine(upright, params, deep, 4), by_sigma ? LineVerdict::kDistanceUnknown : LineVerdict::kGood);
  }
}

}  // namespace
}  // namespace lintel
