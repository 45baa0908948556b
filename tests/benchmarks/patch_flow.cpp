// SPDX-License-Identifier: BSD-3-Clause
//
// patch_flow FOLDER [CONTRAST]: CPU time and error of following patches with PatchFlow and with OpenCV's
// calcOpticalFlowPyrLK, on the images of a folder (an EuRoC recording's mav0/cam0/data). Each image is followed into
// itself moved by a known rotation and shift, with other noise, brightness and contrast (CONTRAST times what it was,
// 0.97), so that the true places are known. Both get the same pyramids; the time is that of the pyramids of one image,
// with the derivatives that OpenCV needs, and of the flow.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <stdexcept>

#include "../../libs/tracking/src/PatchFlow.h"
#include "../ToolMain.h"
#include "lintel/core/Quantiles.h"
#include "lintel/core/ThreadTime.h"

namespace lintel {
namespace {

/// What is followed, and how.
struct Job {
  const char* name;
  int places, window_px, levels, max_iterations;
  float guess_px;  ///< error of the guess in x and y
};

struct Measured {
  std::vector<double> pyramid_ms, flow_ms, error_px;
  std::size_t followed = 0, all = 0;
};

cv::Mat moved(const cv::Mat& image, const cv::Matx23d& motion, double contrast, cv::RNG& random) {
  cv::Mat result, noise(image.size(), CV_16S);
  cv::warpAffine(image, result, motion, image.size(), cv::INTER_CUBIC, cv::BORDER_REFLECT_101);
  result.convertTo(result, CV_16S, contrast, 4);
  random.fill(noise, cv::RNG::NORMAL, 0, 2);
  result += noise;
  result.convertTo(result, CV_8U);
  return result;
}

void note(const std::vector<unsigned char>& found, const std::vector<cv::Point2f>& to,
          const std::vector<cv::Point2f>& truth, Measured& measured) {
  for (std::size_t i = 0; i < truth.size(); ++i) {
    ++measured.all;
    const double error = cv::norm(to[i] - truth[i]);
    if (!found[i] || error > 2) continue;
    ++measured.followed;
    measured.error_px.push_back(error);
  }
}

/// CPU time of `work` [ms].
template <class Work>
double timeOf(const Work& work) {
  const double start_ms = threadTimeMs();
  work();
  return threadTimeMs() - start_ms;
}

void measure(const Job& job, const cv::Mat& from, const cv::Mat& to, const std::vector<cv::Point2f>& px,
             const std::vector<cv::Point2f>& truth, Measured& own, Measured& opencv) {
  std::vector<cv::Point2f> guesses;
  for (const cv::Point2f& place : job.guess_px > 0 ? truth : px)
    guesses.push_back(place + cv::Point2f(job.guess_px, -job.guess_px));
  std::vector<cv::Mat> from_levels, to_levels;
  std::vector<unsigned char> found;
  {
    const int border = patchBorder(job.window_px);
    const auto build = [&](const cv::Mat& image, std::vector<cv::Mat>& levels) {
      cv::buildOpticalFlowPyramid(image, levels, {border, border}, job.levels - 1, false);
    };
    build(from, from_levels);
    own.pyramid_ms.push_back(timeOf([&] { build(to, to_levels); }));
    const PatchFlowParams params{job.window_px, job.levels, job.max_iterations, 0.03, 1e-3};
    std::vector<cv::Point2f> places = guesses;
    own.flow_ms.push_back(timeOf([&] { found = followPatches(from_levels, to_levels, px, params, places); }));
    note(found, places, truth, own);
  }
  {
    const cv::Size window(job.window_px, job.window_px);
    cv::buildOpticalFlowPyramid(from, from_levels, window, job.levels - 1, true);
    opencv.pyramid_ms.push_back(
        timeOf([&] { cv::buildOpticalFlowPyramid(to, to_levels, window, job.levels - 1, true); }));
    const cv::TermCriteria criteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, job.max_iterations, 0.03);
    std::vector<cv::Point2f> places = guesses;
    opencv.flow_ms.push_back(timeOf([&] {
      cv::calcOpticalFlowPyrLK(from_levels, to_levels, px, places, found, cv::noArray(), window, job.levels - 1,
                               criteria, cv::OPTFLOW_USE_INITIAL_FLOW, 1e-6);
    }));
    note(found, places, truth, opencv);
  }
}

/// 0 without values.
double quantileOf(std::vector<double> values, double q) { return values.empty() ? 0 : lowerQuantile(values, q); }

void print(const char* name, const Measured& measured) {
  std::printf("  %-12s pyramid %.3f ms  flow %.3f ms  followed %.1f %%  error %.3f px (90 %%: %.3f)\n", name,
              quantileOf(measured.pyramid_ms, 0.5), quantileOf(measured.flow_ms, 0.5),
              100.0 * static_cast<double>(measured.followed) / static_cast<double>(measured.all),
              quantileOf(measured.error_px, 0.5), quantileOf(measured.error_px, 0.9));
}

int run(int argc, char** argv) {
  if (argc != 2 && argc != 3) throw std::invalid_argument("usage: patch_flow FOLDER [CONTRAST]");
  const double contrast = argc == 3 ? std::stod(argv[2]) : 0.97;
  cv::setNumThreads(1);
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1])) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  const Job jobs[] = {{"150 corners, 13 px, 4 levels", 150, 13, 4, 20, 0},
                      {"600 corners, 8 px, 1 level, guess off by a pixel", 600, 8, 1, 6, 0.7f}};
  for (const Job& job : jobs) {
    Measured own, opencv;
    cv::RNG random(1);
    for (const auto& path : paths) {
      const cv::Mat image = cv::imread(path.string(), cv::IMREAD_GRAYSCALE);
      if (image.empty()) throw std::runtime_error(path.string() + ": no image");
      const double angle = random.uniform(-0.02, 0.02), c = std::cos(angle), s = std::sin(angle);
      const cv::Matx23d motion(c, -s, random.uniform(-8.0, 8.0), s, c, random.uniform(-8.0, 8.0));
      std::vector<cv::Point2f> corners, px, truth;
      cv::goodFeaturesToTrack(image, corners, job.places, 0.005, 8);
      for (const cv::Point2f& corner : corners) {
        const cv::Vec2d to = motion * cv::Vec3d(corner.x, corner.y, 1);
        if (to[0] < 20 || to[1] < 20 || to[0] > image.cols - 20 || to[1] > image.rows - 20) continue;
        px.push_back(corner);
        truth.emplace_back(static_cast<float>(to[0]), static_cast<float>(to[1]));
      }
      if (!px.empty()) measure(job, image, moved(image, motion, contrast, random), px, truth, own, opencv);
    }
    std::printf("%s, %zu images, medians\n", job.name, paths.size());
    print("PatchFlow", own);
    print("OpenCV", opencv);
  }
  return 0;
}

}  // namespace
}  // namespace lintel

int main(int argc, char** argv) { return lintel::toolMain("patch_flow", lintel::run, argc, argv); }
