// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/sensing/EurocToRawlog.h"

#include <mrpt/obs/CObservation.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "Bag.h"
#include "GzStream.h"
#include "PlainStream.h"
#include "RawlogFile.h"
#include "RawlogNote.h"
#include "RawlogOutput.h"
#include "RawlogSources.h"
#include "lintel/sensing/Recording.h"

namespace lintel {
namespace {

namespace fs = std::filesystem;

/// One conversion: merges the sensors by time.
class Conversion {
 public:
  Conversion(const std::string& folder, const std::string& rawlog, const EurocToRawlogParams& params,
             const EurocToRawlogProgress& progress)
      : path_(folder),
        params_(params),
        progress_(progress),
        output_(rawlog, !params.embed, params.overwrite),
        placer_(output_.imagesFolder(), params.copy) {}

  EurocToRawlogSummary run();

 private:
  struct Lane {
    std::unique_ptr<RawlogSource> source;
    std::size_t* count;  ///< in the summary
    bool image;
  };
  std::vector<std::string> cameras() const;
  bool isPlainEuroc() const;
  void openLanes();
  void openFolder();
  void openAny();
  void addCamera(const std::string& label);
  void write(GzOutput& file);
  std::size_t countImages(const std::string& label) const;

  std::string path_, mav0_;
  const EurocToRawlogParams& params_;
  const EurocToRawlogProgress& progress_;
  RawlogOutput output_;
  ImagePlacer placer_;
  RawlogNote note_;
  std::vector<Lane> lanes_;
  WarningLog log_;
  WarningSink warn_ = [this](Fault fault, std::string text) { log_.add({fault, std::move(text)}); };
  std::size_t images_done_ = 0, images_total_ = 0;
  EurocToRawlogSummary summary_;
};

std::vector<std::string> Conversion::cameras() const {
  if (!params_.cameras.empty()) return params_.cameras;
  std::set<std::string> found;
  for (const auto& entry : fs::directory_iterator(mav0_)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("cam", 0) == 0 && fs::exists(entry.path() / "data.csv")) found.insert(name);
  }
  if (found.empty()) throw RecordingError(mav0_ + ": holds no camera (cam0/data.csv): give an EuRoC folder");
  return {found.begin(), found.end()};
}

std::size_t Conversion::countImages(const std::string& label) const {
  EurocImageList list(mav0_ + "/" + label);
  std::size_t count = 0;
  while (list.next([](Fault, const std::string&) {})) ++count;
  return count;
}

void Conversion::addCamera(const std::string& label) {
  const std::string folder = mav0_ + "/" + label;
  if (summary_.images.count(label) > 0) throw RecordingError(label + " is named twice: name each camera once");
  if (!fs::is_directory(folder)) throw RecordingError(folder + ": no such camera: name others with --cameras");
  const EurocCamera camera = loadEurocCamera(folder + "/sensor.yaml");
  note_.camera_rates_hz[label] = camera.rate_hz;
  if (camera.line_delay_s != 0) note_.line_delays_s[label] = camera.line_delay_s;
  images_total_ += countImages(label);
  ImagePlacer* placer = params_.embed ? nullptr : &placer_;
  lanes_.push_back({makeImageSource(folder, label, camera, placer), &summary_.images[label], true});
}

/// An EuRoC folder that says all of itself: its files are linked as they are.
bool Conversion::isPlainEuroc() const {
  if (!params_.recording.calibration.empty() || isFilm(path_) || isBag(path_) || isImageFolder(path_)) return false;
  return !fs::is_directory(path_) || fs::exists(fs::path(findMav0(path_)) / "imu0" / "sensor.yaml");
}

void Conversion::openLanes() {
  if (fs::path(path_).extension() == ".rawlog") throw RecordingError(path_ + ": is a rawlog already");
  isPlainEuroc() ? openFolder() : openAny();
}

void Conversion::openAny() {
  RecordingParams recording = params_.recording;
  const std::shared_ptr<SensorStream> stream = openStream(path_, recording);
  for (const Warning& warning : stream->openingWarnings()) log_.add(warning);
  const Rig& rig = stream->rig();
  const std::string label = "cam0";
  note_.imu_noise = rig.imu_noise;  // and no axes of the accelerometer: the stream's samples are corrected
  note_.imu_rate_hz = rig.imu_rate_hz;
  note_.camera_rates_hz[label] = rig.camera_rate_hz;
  if (rig.line_delay_s != 0) note_.line_delays_s[label] = rig.line_delay_s;
  mav0_ = path_;
  images_total_ = stream->countFrames(recording);
  lanes_.push_back({makeImuSource(stream), &summary_.imu_samples, false});
  lanes_.push_back(
      {makeImageSource(stream, label, params_.embed ? "" : output_.imagesFolder()), &summary_.images[label], true});
}

void Conversion::openFolder() {
  mav0_ = findMav0(path_);
  const std::string imu_folder = mav0_ + "/imu0", truth = mav0_ + "/state_groundtruth_estimate0/data.csv";
  const EurocImu imu = loadEurocImu(imu_folder + "/sensor.yaml");
  note_.imu_noise = imu.noise;
  note_.axes = imu.axes;
  note_.imu_rate_hz = imu.rate_hz;
  if (fs::exists(truth)) lanes_.push_back({makeGroundtruthSource(truth), &summary_.groundtruth_poses, false});
  lanes_.push_back({makeImuSource(imu_folder, "imu0", imu), &summary_.imu_samples, false});
  for (const std::string& label : cameras()) addCamera(label);
}

void Conversion::write(GzOutput& file) {
  const auto finished = [this](const Lane& lane) { return !lane.source->advance(warn_); };
  lanes_.erase(std::remove_if(lanes_.begin(), lanes_.end(), finished), lanes_.end());
  bool first = true;
  while (!lanes_.empty()) {
    const auto earliest = std::min_element(
        lanes_.begin(), lanes_.end(), [](const Lane& a, const Lane& b) { return a.source->t_ns() < b.source->t_ns(); });
    const std::int64_t t_ns = earliest->source->t_ns();
    if (first) writeObservation(file, *makeComment(formatNote(note_), t_ns));
    if (first) summary_.first_ns = t_ns;
    first = false;
    summary_.last_ns = t_ns;
    if (const auto observation = earliest->source->make(warn_)) {
      writeObservation(file, *observation);
      ++*earliest->count;
    }
    if (earliest->image && progress_) progress_(++images_done_, images_total_);
    if (finished(*earliest)) lanes_.erase(earliest);
  }
}

EurocToRawlogSummary Conversion::run() {
  openLanes();
  GzOutput file(output_.file(), params_.compress_level);
  write(file);
  file.close();
  for (const auto& [label, count] : summary_.images)
    if (count == 0) throw RecordingError(mav0_ + "/" + label + ": no image could be read: nothing written");
  if (summary_.imu_samples == 0) throw RecordingError(mav0_ + "/imu0: no IMU sample could be read: nothing written");
  output_.commit();
  if (!params_.embed) summary_.images_folder = output_.finalImagesFolder();
  summary_.linked = placer_.linked();
  summary_.copied = placer_.copied();
  summary_.warnings = log_.lines();
  return summary_;
}

}  // namespace

EurocToRawlogSummary eurocToRawlog(const std::string& folder, const std::string& rawlog,
                                   const EurocToRawlogParams& params, const EurocToRawlogProgress& progress) {
  if (params.compress_level < 0 || params.compress_level > 9)
    throw std::invalid_argument("compress_level must be 0 to 9");
  return Conversion(folder, rawlog, params, progress).run();
}

}  // namespace lintel
