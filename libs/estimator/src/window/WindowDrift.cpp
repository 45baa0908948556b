// SPDX-License-Identifier: BSD-3-Clause
// How the drift of the held frame begins and is carried on (WindowCovariance.h).
#include <Eigen/Cholesky>
#include <algorithm>

#include "window/WindowCovariance.h"
#include "window/WindowGauge.h"

namespace lintel {

StateCovariance WindowCovariance::start(SlidingWindow& window, FrameId first) const {
  const WindowFrame &oldest = window.frames.front(), &frame = window.frame(first);
  WorldDrift drift;
  drift.by_state[poseOf(frame)] = -gaugeOf(frame);
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(marginals_.size(), 4);
  place(poseOf(frame), gaugeOf(frame), F);
  place(poseOf(oldest), -gaugeOf(oldest), F);
  const Eigen::MatrixXd half = halves(F);
  drift.covariance = half.transpose() * half;
  window.drift = std::move(drift);
  drift_of_.reset();
  StateCovariance open = StateCovariance::Identity();  // without position and yaw
  open.topLeftCorner<3, 3>().setZero();
  const Eigen::Vector3d up_b = frame.T_w_b().R().row(2);
  open.block<3, 3>(3, 3) -= up_b * up_b.transpose();
  return open * of(window, frame) * open.transpose();
}

void WindowCovariance::holdNext(SlidingWindow& window) const {
  const WindowFrame &oldest = window.frames[0], &next = window.frames[1];
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(marginals_.size(), 4);
  place(poseOf(next), gaugeOf(next), F);
  place(poseOf(oldest), -gaugeOf(oldest), F);
  const Eigen::MatrixXd half = halves(F) + halvesOfDrift(window);
  window.drift.covariance = independentDrift(window) + half.transpose() * half;
}

void WindowCovariance::forget(SlidingWindow& window, FrameId leaving) const {
  const auto leaves = [leaving](const BlockKey& key) {
    return key.kind == BlockKey::kDirection ||
           (key.id == leaving && (key.kind == BlockKey::kPose || key.kind == BlockKey::kMotion));
  };
  std::map<BlockKey, WorldDrift::Rows>& by_state = window.drift.by_state;
  if (std::none_of(by_state.begin(), by_state.end(), [&](const auto& entry) { return leaves(entry.first); })) return;
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < information_.blocks.size(); ++i)
    for (Eigen::Index row = information_.offsets[i]; row < information_.offsets[i + 1]; ++row)
      if (leaves(information_.blocks[i])) rows.push_back(row);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(marginals_.size(), 4);
  for (const auto& [key, columns] : by_state) place(key, columns, K);
  Eigen::MatrixXd H = information_.H(rows, rows);
  drift_of_.reset();
  H.diagonal().array() += kInformationFloor;
  K -= information_.H(Eigen::all, rows) * H.llt().solve(Eigen::MatrixXd(K(rows, Eigen::all)));
  by_state.clear();
  for (std::size_t i = 0; i < information_.blocks.size(); ++i)
    if (!leaves(information_.blocks[i]))
      by_state[information_.blocks[i]] =
          K.middleRows(information_.offsets[i], information_.offsets[i + 1] - information_.offsets[i]).transpose();
}

}  // namespace lintel
