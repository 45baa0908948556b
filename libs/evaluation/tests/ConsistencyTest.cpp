// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/evaluation/Consistency.h"

#include <gmock/gmock.h>

#include <random>

#include "lintel/geometry/Rotation.h"
#include "lintel/testing/TempFolder.h"

namespace lintel {
namespace {

constexpr double kSigma_m = 0.1, kSigma_rad = 0.02;

/// A flight whose errors are drawn from its covariances; the estimate's world is another one.
struct DrawnFlight {
  StampedPoses truth, estimate;
  std::vector<PoseCovariance> covariances;

  explicit DrawnFlight(double errors_times = 1, int poses = 2000) {
    std::mt19937_64 engine(7);
    std::normal_distribution<double> normal;
    const auto draw = [&](double sigma) {
      return Eigen::Vector3d(sigma * normal(engine), sigma * normal(engine), sigma * normal(engine));
    };
    const Pose T_e_w{expRotation({0, 0, 2}), {4, -3, 1}};
    for (int i = 0; i < poses; ++i) {
      const std::int64_t t_ns = i * std::int64_t{50000000};
      const Pose T_w_b{expRotation({0.3, -0.9, 0.01 * i}), {std::sin(0.1 * i), std::cos(0.07 * i), 0.001 * i}};
      const double scale = i == 0 ? 0 : errors_times;
      truth.emplace_back(t_ns, T_w_b);
      Pose T = T_e_w * T_w_b;
      T.p += draw(scale * kSigma_m);
      T.q = T.q * expRotation(draw(scale * kSigma_rad));
      estimate.emplace_back(t_ns, T);
      PoseCovariance covariance = PoseCovariance::Identity();
      covariance.topLeftCorner<3, 3>() *= i == 0 ? 0 : kSigma_m * kSigma_m;
      covariance.bottomRightCorner<3, 3>() *= i == 0 ? 0 : kSigma_rad * kSigma_rad;
      covariances.push_back(covariance);
    }
  }
};

TEST(Consistency, TrueCovariancesAreFoundTrue) {
  const DrawnFlight flight;
  const Consistency c = evaluateConsistency(flight.estimate, flight.covariances, flight.truth);
  EXPECT_EQ(c.poses, flight.truth.size() - 1) << "the first one is what the others are relative to";
  EXPECT_EQ(c.pieces, 1u);
  EXPECT_NEAR(c.position.mean, 3, 0.2);
  EXPECT_NEAR(c.yaw.mean, 1, 0.15);
  EXPECT_NEAR(c.roll_pitch.mean, 2, 0.2);
  for (const SquaredErrorSummary& s : {c.position, c.yaw, c.roll_pitch}) EXPECT_NEAR(s.inside, 0.95, 0.02);
  EXPECT_NEAR(c.position.low, 0.2158, 1e-4);  // tables of the chi-square
  EXPECT_NEAR(c.position.high, 9.3484, 1e-4);
}

TEST(Consistency, ErrorsTwiceAsLargeAreFourTimesTooMuch) {
  const DrawnFlight flight(2);
  const Consistency c = evaluateConsistency(flight.estimate, flight.covariances, flight.truth);
  EXPECT_NEAR(c.position.mean, 12, 0.8);
  EXPECT_NEAR(c.yaw.mean, 4, 0.6);
  EXPECT_LT(c.position.inside, 0.6);
}

TEST(Consistency, TheTruthIsTakenAtTheEstimatesTimes) {
  DrawnFlight flight;
  // turning by 2 rad/s, 5 m/s fast: the nearest true pose is up to 5 mrad and 12 mm from that of the estimate's time
  const auto poseAt = [](std::int64_t t_ns) {
    const double t_s = 1e-9 * static_cast<double>(t_ns);
    return Pose{expRotation({0, 0, 2 * t_s}), {5 * t_s, 0, 0}};
  };
  flight.truth.clear();
  for (int i = 0; i < 2001; ++i)
    flight.truth.emplace_back(i * std::int64_t{5000000}, poseAt(i * std::int64_t{5000000}));
  for (std::size_t i = 0; i < flight.estimate.size(); ++i) {
    const auto t_ns = static_cast<std::int64_t>(i) * 4900000;
    flight.estimate[i] = {t_ns, poseAt(t_ns)};
  }
  const Consistency c = evaluateConsistency(flight.estimate, flight.covariances, flight.truth);
  EXPECT_LT(c.position.mean, 1e-9);
  EXPECT_LT(c.yaw.mean, 1e-9);
}

TEST(Consistency, EveryPieceIsLaidOnTheTruthAtItsBeginning) {
  DrawnFlight flight;
  const std::size_t begin = 1000;
  const Pose elsewhere{expRotation({0, 0, -1}), {7, 7, 0}};
  for (std::size_t i = begin; i < flight.estimate.size(); ++i) {
    flight.estimate[i].second = elsewhere * (i == begin ? flight.truth[i].second : flight.estimate[i].second);
    if (i > begin) continue;
    flight.covariances[i].setZero();
  }
  for (std::size_t i = begin + 1; i < flight.estimate.size(); ++i) {
    // what is left of the estimate's own world
    const Pose T_e_w{expRotation({0, 0, 2}), {4, -3, 1}};
    flight.estimate[i].second = elsewhere * T_e_w.inverse() * elsewhere.inverse() * flight.estimate[i].second;
  }
  const Consistency c = evaluateConsistency(flight.estimate, flight.covariances, flight.truth);
  EXPECT_EQ(c.pieces, 2u);
  EXPECT_NEAR(c.position.mean, 3, 0.2);
}

TEST(Consistency, ReadsTriangleAndWholeMatrix) {
  const test::TempFolder folder;
  const StampedPoses poses{{1'000'000'000, Pose()}, {2'000'000'000, {expRotation({0, 0.4, 0}), {1, 0, 0}}}};
  std::string triangle = "# timestamp\n", whole;
  for (int row = 1; row <= 2; ++row) {
    triangle += std::to_string(row) + ".000000000";
    whole += std::to_string(row) + ".000000000";
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        const std::string value = "," + std::to_string(i == j ? 1.0 + i : 0.01 * (i + j));
        whole += value;
        if (j >= i) triangle += value;
      }
    triangle += "\n";
    whole += "\n";
  }
  const auto a = readCovariances(folder.write("a.csv", triangle), poses);
  const auto b = readCovariances(folder.write("b.csv", whole), poses);
  ASSERT_EQ(a.size(), 2u);
  EXPECT_NEAR(a[0](0, 1), 0.01, 1e-12);
  EXPECT_NEAR(a[0](5, 5), 4, 1e-12) << "yaw turns about the body's z";
  for (int i = 0; i < 2; ++i) EXPECT_LT((a[i] - b[i]).norm(), 1e-12);
}

/// A first pose, whose heading is known by definition: in Euler's angles its variance is a difference of large ones.
TEST(Consistency, RoundedCovariancesOfAFirstPoseAreRead) {
  const test::TempFolder folder;
  std::string row = "1.500000000";
  for (int i = 0; i < 15; ++i) row += ",0";
  row += ",5.770741098e-10,-1.566353242e-08,3.378416272e-07,4.029797615e-04,-9.149690515e-06,1.972832181e-04\n";
  EXPECT_EQ(readCovariances(folder.write("c.csv", row), {{1'500'000'000, Pose()}}).size(), 1u);
}

TEST(Consistency, CovariancesOfAnotherTrajectoryAreRefused) {
  const test::TempFolder folder;
  std::string row = "1.500000000";
  for (int i = 0; i < 21; ++i) row += ",1";
  const auto fails = [&](const std::string& text, const StampedPoses& poses, const char* what) {
    try {
      readCovariances(folder.write("c.csv", text), poses);
      FAIL() << "accepted";
    } catch (const EvaluationError& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr(what));
    }
  };
  fails(row + "\n", {{1'000'000'000, Pose()}}, "c.csv:1: is not the time of pose 1");
  fails(row + "\n", {{1'500'000'000, Pose()}, {2'000'000'000, Pose()}}, "ends after 1 of 2 poses");
  fails("1.5,2,3\n", {{1'500'000'000, Pose()}}, "21 or 36 numbers");
  std::string strong = row, lopsided = "1.500000000";
  strong.replace(strong.find(",1,1") + 2, 2, ",2");
  fails(strong + "\n", {{1'500'000'000, Pose()}}, "is no covariance");
  for (int i = 0; i < 36; ++i) lopsided += i % 7 == 0 ? ",1" : i == 1 ? ",0.5" : ",0";
  fails(lopsided + "\n", {{1'500'000'000, Pose()}}, "is no covariance");
}

}  // namespace
}  // namespace lintel
