// SPDX-License-Identifier: BSD-3-Clause
// Sections of the map file that only merging reads: pieces, the IMU between keyframes, by how much the stamps are off
// between which it is and its correlated noise, the clocks' offsets, what places look like.
#include <algorithm>

#include "MapChecks.h"
#include "MapSections.h"
#include "lintel/inertial/Preintegration.h"

namespace lintel {

namespace {

constexpr std::size_t kPieceSize = 8 + 8 + 8 + 8 + 4 + 4, kTextSize = 8, kImuSize = 8 + 1 + 6 * 8 + 4 * 8 + 8,
                      kSampleSize = 8 + 6 * 8 + 1, kSigmaSize = 8 + 8, kViewSize = 4 + 8 + 8,
                      kFeatureSize = 4 + 4 + 8 + 1 + 4 * 8;

enum KeyframeFlag : std::uint8_t { kAtRest = 1 };

/// What is beyond a sensor's range is kept as what a drop-out has left out.
bool isUncertain(const ImuSample& sample) { return sample.bridged || sample.gyro_open > 0 || sample.accel_open > 0; }

void encodeImu(const Preintegration& imu, ByteWriter& out) {
  out.vec3(imu.bias().gyro), out.vec3(imu.bias().accel);
  const ImuNoise& noise = imu.noise();
  out.f64(noise.gyro_noise), out.f64(noise.gyro_walk), out.f64(noise.accel_noise), out.f64(noise.accel_walk);
  out.u64(imu.samples().size());
  for (const ImuSample& s : imu.samples())
    out.i64(s.t_ns), out.vec3(s.gyro), out.vec3(s.accel), out.u8(isUncertain(s) ? 1 : 0);
}

std::shared_ptr<const Preintegration> decodeImu(ByteReader& in) {
  ImuBias bias;
  bias.gyro = in.vec3(), bias.accel = in.vec3();
  ImuNoise noise;
  noise.gyro_noise = in.f64(), noise.gyro_walk = in.f64(), noise.accel_noise = in.f64(), noise.accel_walk = in.f64();
  ImuBatch samples(in.count(kSampleSize));
  for (ImuSample& s : samples) s.t_ns = in.i64(), s.gyro = in.vec3(), s.accel = in.vec3(), s.bridged = in.u8() != 0;
  if (const std::string wrong = wrongSamples(samples); !wrong.empty()) throw ByteReaderError(wrong);
  auto imu = std::make_shared<Preintegration>(bias, noise);
  imu->append(samples);
  return imu;
}

/// What keyframes' IMU has a standard deviation of, by their places; not where it is zero.
template <class SigmaOf>
void encodeSigmas(const LineMap& map, SigmaOf sigmaOf, ByteWriter& out) {
  ByteWriter records;
  std::uint64_t n = 0;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const auto& imu = map.keyframes[k].imu;
    if (!imu || sigmaOf(*imu) <= 0) continue;
    ++n;
    records.u64(k), records.f64(sigmaOf(*imu));
  }
  if (n == 0) return;
  out.u64(n);
  out.append(records);
}

struct SigmaWords {
  std::string what, absurd;
  double below;
};

/// Each into a copy of its keyframe's IMU.
template <class Take>
void decodeSigmas(ByteReader& in, LineMap& map, const SigmaWords& words, Take take) {
  const std::size_t n = in.count(kSigmaSize);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint64_t k = in.u64();
    const double sigma = in.f64();
    if (k >= map.keyframes.size() || !map.keyframes[k].imu)
      throw ByteReaderError("has " + words.what + " of what has no IMU");
    if (!(sigma > 0 && sigma < words.below)) throw ByteReaderError("has " + words.what + " " + words.absurd);
    auto imu = std::make_shared<Preintegration>(*map.keyframes[k].imu);
    take(sigma, *imu);
    map.keyframes[k].imu = imu;
  }
}

}  // namespace

void encodePieces(const LineMap& map, ByteWriter& out) {
  if (map.pieces.empty() && map.recordings.empty() && map.time_offset_s == 0) return;
  out.f64(map.time_offset_s);
  out.u64(map.recordings.size());
  for (const std::string& name : map.recordings) out.text(name);
  out.u64(map.pieces.size());
  for (const MapPiece& piece : map.pieces) {
    out.u64(piece.first_keyframe), out.i64(piece.first_ns), out.i64(piece.last_ns), out.u64(piece.first_pose);
    out.i32(piece.world), out.i32(piece.recording);
  }
}

void decodePieces(ByteReader& in, LineMap& map) {
  map.time_offset_s = in.f64();
  map.recordings.resize(in.count(kTextSize));
  for (std::string& name : map.recordings) name = in.text();
  map.pieces.resize(in.count(kPieceSize));
  for (MapPiece& piece : map.pieces) {
    piece.first_keyframe = in.u64(), piece.first_ns = in.i64(), piece.last_ns = in.i64(), piece.first_pose = in.u64();
    piece.world = in.i32(), piece.recording = in.i32();
    if (static_cast<std::uint32_t>(piece.world) >= map.pieces.size())
      throw ByteReaderError("names a piece that does not exist");
  }
}

/// Of keyframes that have IMU, by their places.
void encodeImu(const LineMap& map, ByteWriter& out) {
  ByteWriter records;
  std::uint64_t n = 0;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const MapKeyframe& keyframe = map.keyframes[k];
    if (!keyframe.imu) continue;
    ++n;
    records.u64(k);
    records.u8(static_cast<std::uint8_t>((keyframe.at_rest ? kAtRest : 0)));
    encodeImu(*keyframe.imu, records);
  }
  if (n == 0) return;
  out.u64(n);
  out.append(records);
}

void decodeImu(ByteReader& in, LineMap& map) {
  const std::size_t n = in.count(kImuSize);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint64_t k = in.u64();
    if (k >= map.keyframes.size()) throw ByteReaderError("names a keyframe that does not exist");
    map.keyframes[k].at_rest = (in.u8() & kAtRest) != 0;
    map.keyframes[k].imu = decodeImu(in);
  }
}

/// Of keyframes whose images' stamps are off, by their places.
void encodeStamps(const LineMap& map, ByteWriter& out) {
  encodeSigmas(
      map, [](const Preintegration& imu) { return imu.stampSigma(); }, out);
}

void decodeStamps(ByteReader& in, LineMap& map) {
  decodeSigmas(in, map, {"stamps", "that are off by no time that can be", 1}, [](double sigma_s, Preintegration& imu) {
    imu.setStampNoise(sigma_s, Preintegration::Matrix9::Zero());  // the states count it: BatchProblem
  });
}

/// Of keyframes whose accelerometer has correlated noise, by their places.
void encodeCorrelated(const LineMap& map, ByteWriter& out) {
  encodeSigmas(
      map, [](const Preintegration& imu) { return imu.noise().accel_correlated; }, out);
}

void decodeCorrelated(ByteReader& in, LineMap& map) {
  decodeSigmas(in, map, {"noise", "that no accelerometer has", 10}, [](double sigma, Preintegration& imu) {
    imu.raiseNoise({0, 0, 0, 0, sigma});
  });
}

/// Of all keyframes, where the offset between the clocks changes.
void encodeOffsets(const LineMap& map, ByteWriter& out) {
  if (std::all_of(map.keyframes.begin(), map.keyframes.end(),
                  [](const MapKeyframe& keyframe) { return keyframe.offset_change_s == 0; }))
    return;
  out.u64(map.keyframes.size());
  for (const MapKeyframe& keyframe : map.keyframes) out.f64(keyframe.offset_change_s);
}

void decodeOffsets(ByteReader& in, LineMap& map) {
  if (in.count(8) != map.keyframes.size()) throw ByteReaderError("has not one offset for each keyframe");
  for (MapKeyframe& keyframe : map.keyframes) keyframe.offset_change_s = in.f64();
}

void encodeViews(const LineMap& map, ByteWriter& out) {
  if (map.views.empty()) return;
  out.u64(map.views.size());
  for (const MapView& view : map.views) {
    out.i32(view.piece), out.i64(view.looks.t_ns), out.u64(view.looks.features.size());
    for (const PlaceFeature& feature : view.looks.features) {
      out.f32(feature.px.x()), out.f32(feature.px.y()), out.i64(feature.track), out.u8(feature.level);
      for (const std::uint64_t word : feature.descriptor) out.u64(word);
    }
  }
}

void decodeViews(ByteReader& in, LineMap& map) {
  map.views.resize(in.count(kViewSize));
  for (MapView& view : map.views) {
    view.piece = in.i32();
    if (static_cast<std::uint32_t>(view.piece) >= map.pieces.size())
      throw ByteReaderError("names a piece that does not exist");
    view.looks.t_ns = in.i64();
    view.looks.features.resize(in.count(kFeatureSize));
    for (PlaceFeature& feature : view.looks.features) {
      feature.px.x() = in.f32(), feature.px.y() = in.f32(), feature.track = in.i64(), feature.level = in.u8();
      for (std::uint64_t& word : feature.descriptor) word = in.u64();
    }
  }
}

}  // namespace lintel
