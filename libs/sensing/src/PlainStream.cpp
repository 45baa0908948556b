// SPDX-License-Identifier: BSD-3-Clause
#include "PlainStream.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "Film.h"
#include "ImageFile.h"
#include "TimeTicks.h"

namespace lintel {
namespace {

namespace fs = std::filesystem;

std::string extensionOf(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

bool isOneOf(const std::string& text, std::initializer_list<const char*> list) {
  return std::any_of(list.begin(), list.end(), [&](const char* one) { return text == one; });
}

bool isImage(const fs::path& path) {
  return isOneOf(extensionOf(path), {".png", ".jpg", ".jpeg", ".pgm", ".ppm", ".bmp", ".tif", ".tiff"});
}

/// By number where names are numbers of different lengths: 2.png before 10.png.
bool inOrder(const std::string& a, const std::string& b) {
  const auto digits = [](const std::string& name) {
    const std::string stem = fs::path(name).stem().string();
    const std::size_t last = stem.find_last_not_of("0123456789");
    std::string number = stem.substr(last == std::string::npos ? 0 : last + 1);
    number.erase(0, std::min(number.find_first_not_of('0'), number.size()));
    return std::make_pair(stem.substr(0, last == std::string::npos ? 0 : last + 1), number);
  };
  const auto [head_a, number_a] = digits(a);
  const auto [head_b, number_b] = digits(b);
  if (head_a != head_b) return head_a < head_b;
  if (number_a.size() != number_b.size()) return number_a.size() < number_b.size();
  return number_a != number_b ? number_a < number_b : a < b;
}

/// The folder with the images: itself, or one of those that they usually are in.
fs::path imagesFolder(const fs::path& path) {
  std::error_code ignored;
  for (const char* name : {"", "images", "data", "rgb", "cam0", "cam0/data", "frames"}) {
    fs::path folder = path / name;
    if (!fs::is_directory(folder, ignored)) continue;
    for (const auto& entry : fs::directory_iterator(folder, ignored))
      if (isImage(entry.path())) return folder;
  }
  return {};
}

/// The first of these files that there is.
std::string lookFor(const std::vector<fs::path>& files, const std::string& what, const char* option) {
  std::error_code ignored;
  for (const fs::path& file : files)
    if (fs::is_regular_file(file, ignored)) return file.string();
  throw RecordingError(what + " (looked for " + files.front().string() + "): name it with " + option);
}

std::vector<fs::path> places(const fs::path& path, std::initializer_list<const char*> names) {
  std::vector<fs::path> files;
  const bool film = isFilm(path.string());
  const fs::path stem = path.parent_path() / path.stem();
  for (const char* name : names)
    for (const char* extension : {".csv", ".txt"}) {
      const std::string file = std::string(name) + extension;
      if (film)
        files.emplace_back(stem.string() + "_" + file);
      else
        for (const fs::path& folder : {path, imagesFolder(path)}) files.push_back(folder / file);
    }
  return files;
}

}  // namespace

ImuSource openImuTables(const std::string& files) {
  const std::size_t comma = files.find(',');
  if (comma == std::string::npos) return openImuTable(files, ImuColumns::kBoth);
  ImuJoiner joiner(openImuTable(files.substr(0, comma), ImuColumns::kGyro),
                   openImuTable(files.substr(comma + 1), ImuColumns::kAccel));
  return [joiner](const WarningSink& warn) mutable { return joiner.next(warn); };
}

PlainTables plainTables(const std::string& path, const RecordingParams& params) {
  PlainTables tables{params.times_file, params.imu_file};
  if (tables.times.empty())
    tables.times = lookFor(places(path, {"times", "timestamps", "data"}), path + ": the images' times are missing",
                           "--times FILE");
  if (tables.imu.empty())
    tables.imu =
        lookFor(places(path, {"imu", "imu0", "imu_data"}), path + ": the IMU's samples are missing", "--imu-file FILE");
  return tables;
}

bool isFilm(const std::string& path) {
  return isOneOf(extensionOf(path), {".mp4", ".mkv", ".avi", ".mov", ".webm", ".m4v"});
}

bool isImageFolder(const std::string& path) {
  std::error_code ignored;
  for (const fs::path& folder : {fs::path(path) / "mav0", fs::path(path)})
    if (fs::exists(folder / "imu0", ignored) || fs::exists(folder / "cam0" / "data.csv", ignored)) return false;
  return fs::is_directory(path, ignored) && !imagesFolder(path).empty();
}

PlainStream::PlainStream(const std::string& path, const RecordingParams& params, const GivenCalibration& given)
    : path_(path),
      tables_(plainTables(path, params)),
      images_(readImageTimes(tables_.times)),
      rig_(given.rig(
          [&]() -> Rig {
            throw RecordingError(path + ": images and tables hold no calibration: give it by --calibration " +
                                 "camchain-imucam.yaml (Kalibr), or a file of OpenVINS or VINS");
          },
          warnings_)),
      imu_(openImuTables(tables_.imu)) {
  if (isFilm(path)) {
    const auto film = std::make_shared<Film>(path);
    decode_ = [film](std::size_t index) { return film->picture(index); };
  } else {
    nameImages();
    decode_ = [this](std::size_t index) { return readGrayImage(images_[index].name); };
  }
  if (images_.size() > 2 && !given.cameraRate_hz() && images_.back().t_ns > images_.front().t_ns)
    rig_.camera_rate_hz =
        static_cast<double>(std::llround(1e10 * static_cast<double>(images_.size() - 1) /
                                         static_cast<double>(images_.back().t_ns - images_.front().t_ns))) /
        10;
}

/// Files that the table does not name follow each other in the order of their names.
void PlainStream::nameImages() {
  const fs::path folder = imagesFolder(path_);
  std::vector<std::string> files;
  if (images_.front().name.empty()) {
    for (const auto& entry : fs::directory_iterator(folder))
      if (isImage(entry.path())) files.push_back(entry.path().filename().string());
    std::sort(files.begin(), files.end(), inOrder);
    if (files.size() != images_.size())
      throw RecordingError(tables_.times + ": has " + std::to_string(images_.size()) + " times for " +
                           std::to_string(files.size()) + " images in " + folder.string() +
                           ": write a time and a file's name a line");
  }
  for (std::size_t i = 0; i < images_.size(); ++i) {
    std::string& name = images_[i].name;
    if (name.empty() && !files.empty()) name = files[i];
    std::error_code ignored;
    const fs::path beside = fs::path(tables_.times).parent_path() / name;
    name =
        fs::exists(folder / name, ignored) || !fs::exists(beside, ignored) ? (folder / name).string() : beside.string();
  }
}

std::size_t PlainStream::countFrames(const RecordingParams& params) const {
  const FrameRange range(params, images_.front().t_ns);
  return static_cast<std::size_t>(std::count_if(images_.begin(), images_.end(), [&](const TimedImage& image) {
    return image.t_ns >= range.from_ns && image.t_ns <= range.to_ns;
  }));
}

std::optional<FrameRef> PlainStream::nextFrame(const WarningSink& warn) {
  while (at_ < images_.size()) {
    const std::size_t index = at_++;
    const std::int64_t t_ns = cutToTick(images_[index].t_ns);
    if (!gate_.admit(
            t_ns, [&] { return tables_.times + ": image " + std::to_string(index + 1); }, warn))
      continue;
    return FrameRef{t_ns, [decode = decode_, index] { return decode(index); }};
  }
  return std::nullopt;
}

}  // namespace lintel
