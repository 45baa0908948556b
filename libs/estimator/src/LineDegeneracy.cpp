// SPDX-License-Identifier: BSD-3-Clause
#include "LineDegeneracy.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace lintel {

LineUncertainty uncertaintyOf(const OrthonormalLine& line, const Eigen::Matrix4d& information, double along_m) {
  // The axes of U: u1 normal of the plane through origin and line, u2 the direction, -u3 towards the line.
  // U Exp(psi): the direction moves by psi_x along u3 and -psi_z along u1; the foot -r u3 with r = cot(phi) likewise.
  const double sine = std::sin(line.phi), r = std::cos(line.phi) / sine;
  Eigen::Matrix<double, 2, 4> direction, position;
  direction << 0, 0, -1, 0, 1, 0, 0, 0;
  position << 0, -r, -along_m, 0, along_m, 0, 0, 1 / (sine * sine);
  // a floor instead of an inverse that fails: 1e-6 of information is a sigma of 1000 rad
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(information);
  const Eigen::Vector4d variance = solver.eigenvalues().cwiseMax(1e-6).cwiseInverse();
  const Eigen::Matrix4d covariance = solver.eigenvectors() * variance.asDiagonal() * solver.eigenvectors().transpose();
  const auto worst = [&](const Eigen::Matrix<double, 2, 4>& J) {
    const Eigen::Matrix2d c = J * covariance * J.transpose();
    return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(c).eigenvalues()[1]);
  };
  return {worst(direction), worst(position)};
}

}  // namespace lintel
