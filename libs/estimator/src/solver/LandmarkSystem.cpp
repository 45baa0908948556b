// SPDX-License-Identifier: BSD-3-Clause
#include "solver/LandmarkSystem.h"

#include <algorithm>
#include <limits>

#include "lintel/core/Quantiles.h"
#include "lintel/factors/StructuralFactor.h"

namespace lintel {

namespace {

bool isTie(const Factor& factor) {
  return factor.blocks.size() == 2 && factor.blocks[0].kind == BlockKey::kLine &&
         factor.blocks[1].kind == BlockKey::kDirection &&
         dynamic_cast<const LineDirectionFactor*>(factor.cost) != nullptr;
}

/// Points and lines that a factor touches which is neither an image's nor the only tie of its line.
std::set<BlockKey> stayingLandmarks(const std::vector<Factor>& factors) {
  std::set<BlockKey> tied, staying;
  for (const Factor& factor : factors) {
    if (isImageFactor(factor) || (isTie(factor) && tied.insert(factor.blocks[0]).second)) continue;
    for (const BlockKey& key : factor.blocks)
      if (isLandmark(key)) staying.insert(key);
  }
  return staying;
}

template <class Landmarks, class F>
void eachLandmark(Landmarks& landmarks, F&& f) {
  for (auto& point : std::get<0>(landmarks).blocks) f(point);
  for (auto& line : std::get<1>(landmarks).blocks) f(line);
}

template <class Kept, class F>
void eachKept(const Kept& kept, F&& f) {
  std::apply([&f](const auto&... kinds) { (std::for_each(kinds.begin(), kinds.end(), f), ...); }, kept);
}

}  // namespace

LandmarkSystem::LandmarkSystem(SlidingWindow& window, const std::vector<Factor>& factors,
                               const std::map<FrameId, int>& camera_of, const std::set<BlockKey>& staying)
    : correction_(window.correction.data()),
      motions_(camera_of.size()),
      seeing_(camera_of.size(), false),
      staying_(stayingLandmarks(factors)) {
  staying_.insert(staying.begin(), staying.end());
  layout_.cameras = static_cast<int>(camera_of.size());
  for (const Factor& factor : factors) {
    if (addSighting<PointTarget>(window, factor, camera_of) || addSighting<LineTarget>(window, factor, camera_of) ||
        addSighting<DirectionTarget>(window, factor, camera_of))
      continue;
    if (isTie(factor) && staying_.count(factor.blocks[0]) == 0) {
      auto& line = landmarkOf<LineTarget>(window, factor.blocks[0].id);
      line.tie = &factor;
      line.direction = keep(window, factor.blocks[1]);
    } else {
      others_.push_back(&factor);
    }
  }
  eachLandmark(landmarks_, [&](auto& landmark) { landmark.prepare(layout_); });
}

/// False when the factor is no residual of an image that sees such a target.
template <class Target>
bool LandmarkSystem::addSighting(SlidingWindow& window, const Factor& factor, const std::map<FrameId, int>& camera_of) {
  const ImageFactor<Target>* image = imageFactorOf<Target>(factor);
  if (!image) return false;
  const int camera = camera_of.at(factor.blocks.front().id);
  seeing_[static_cast<std::size_t>(camera)] = true;
  motions_[static_cast<std::size_t>(camera)] = image->motion();
  const BlockKey& key = factor.blocks.back();
  if constexpr (!std::is_same_v<Target, DirectionTarget>) {
    if (staying_.count(key) == 0) {
      LandmarkBlock<Target>& landmark = landmarkOf<Target>(window, key.id);
      landmark.loss = factor.loss;
      landmark.noise = factor.noise;
      auto& sighting = landmark.sightings.emplace_back();
      sighting.factor = image;
      sighting.camera = camera;
      sighting.t_s =
          1e-9 * static_cast<double>(window.frames[static_cast<std::size_t>(camera)].t_ns - window.frames.front().t_ns);
      return true;
    }
  }
  std::get<std::vector<KeptSighting<Target>>>(kept_).push_back({image, factor.loss, camera, keep(window, key)});
  return true;
}

template <class Target>
LandmarkBlock<Target>& LandmarkSystem::landmarkOf(SlidingWindow& window, TrackId id) {
  auto& [blocks, places] = std::get<Landmarks<Target>>(landmarks_);
  const auto [it, is_new] = places.emplace(id, blocks.size());
  if (is_new) {
    const BlockKey key{kKindOf<Target>, id};
    blocks.emplace_back().block = window.block(key);
    blocks.back().origin_w = &originOf(window, key);
    blocks.back().sightings.reserve(window.frames.size());
  }
  return blocks[it->second];
}

/// The place of a target that is not eliminated.
int LandmarkSystem::keep(SlidingWindow& window, const BlockKey& key) {
  const auto [it, is_new] = kept_places_.emplace(key, static_cast<int>(layout_.kept.size()));
  if (is_new) {
    layout_.kept.push_back(key);
    layout_.kept_blocks.push_back(window.block(key));
    layout_.kept_offsets.push_back(layout_.kept_offsets.back() + manifoldOf(key.kind)->TangentSize());
  }
  return it->second;
}

std::set<BlockKey> LandmarkSystem::states(const SlidingWindow& window) const {
  std::set<BlockKey> states(layout_.kept.begin(), layout_.kept.end());
  for (std::size_t k = 0; k < seeing_.size(); ++k)
    if (seeing_[k])
      states.insert({{BlockKey::kPose, window.frames[k].id}, {BlockKey::kExtrinsics, 0}, {BlockKey::kCorrection, 0}});
  return states;
}

ResidualLevels LandmarkSystem::levels() const {
  ResidualLevels levels;
  const auto take = [](const auto& blocks, std::vector<double>& to) {
    for (const auto& block : blocks)
      if (block.mean_square) to.push_back(*block.mean_square);
  };
  take(std::get<0>(landmarks_).blocks, levels.points);
  take(std::get<1>(landmarks_).blocks, levels.lines);
  return levels;
}

double LandmarkSystem::cost(const std::vector<CameraView>& views) const {
  double sum = 0;
  LandmarkScratch scratch;
  eachLandmark(landmarks_, [&](const auto& part) { sum += part.cost(views, correction_, layout_, scratch); });
  eachKept(kept_, [&](const auto& part) { sum += part.cost(views, correction_, layout_); });
  return sum;
}

double LandmarkSystem::linearise(const std::vector<CameraView>& views) {
  direct_.H.setZero(layout_.size(), layout_.size());
  direct_.b.setZero(layout_.size());
  double sum = 0;
  LandmarkScratch scratch;
  eachLandmark(landmarks_, [&](auto& part) { sum += part.linearise(views, correction_, layout_, scratch, direct_); });
  eachKept(kept_, [&](auto& part) { sum += part.linearise(views, correction_, layout_, direct_); });
  return sum;
}

const CameraEquations& LandmarkSystem::eliminate(double damping) {
  reduced_ = direct_;
  eachLandmark(landmarks_, [&](auto& landmark) { landmark.eliminate(damping, reduced_); });
  return reduced_;
}

double LandmarkSystem::backSubstitute(const Eigen::VectorXd& camera_step, double damping) {
  double decrease = 0;
  eachLandmark(landmarks_, [&](auto& landmark) { decrease += landmark.backSubstitute(camera_step, damping); });
  return decrease;
}

double LandmarkSystem::medianDistance(const Eigen::Vector3d& from_w) const {
  std::vector<double> distances;
  eachLandmark(landmarks_, [&](const auto& landmark) {
    distances.push_back(landmarkDistance(landmark.kKind, *landmark.origin_w - from_w, landmark.block));
  });
  return distances.empty() ? std::numeric_limits<double>::infinity() : upperMedian(distances);
}

void LandmarkSystem::apply(const ScaleStep& scale, std::vector<double>& saved) {
  eachLandmark(landmarks_, [&](auto& landmark) {
    const auto at = saved.size();
    saved.insert(saved.end(), landmark.block, landmark.block + landmark.kSize);
    scale.plus(landmark.kKind, *landmark.origin_w, saved.data() + at, landmark.step.data(), landmark.block);
  });
}

std::size_t LandmarkSystem::revert(const std::vector<double>& saved, std::size_t at) {
  eachLandmark(landmarks_, [&](auto& landmark) {
    std::copy_n(saved.begin() + static_cast<std::ptrdiff_t>(at), landmark.kSize, landmark.block);
    at += static_cast<std::size_t>(landmark.kSize);
  });
  return at;
}

}  // namespace lintel
