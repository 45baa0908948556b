// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/pages/RunReport.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <sstream>

#include "LoopSection.h"
#include "RunAdvice.h"
#include "RunTables.h"
#include "lintel/core/Version.h"
#include "lintel/pages/EvalReport.h"
#include "lintel/pages/Plots.h"
#include "lintel/reporting/HtmlPage.h"
#include "lintel/reporting/Progress.h"

namespace lintel {

namespace {

constexpr double kGap = std::numeric_limits<double>::quiet_NaN();

StampedPoses stampedPoses(const std::vector<OdometryPose>& trajectory) {
  StampedPoses poses;
  for (const OdometryPose& pose : trajectory) poses.emplace_back(pose.t_ns, pose.T_w_b);
  return poses;
}

/// Lines of `text` that are not in `other`, with the keys above them.
std::string differences(const std::string& text, const std::string& other) {
  const auto dotted = [](const std::string& yaml) {
    std::vector<std::string> lines, path;
    std::istringstream in(yaml);
    for (std::string line; std::getline(in, line);) {
      const std::size_t depth = line.find_first_not_of(' ') / 2, colon = line.find(':');
      if (colon == std::string::npos) continue;
      path.resize(depth);
      path.push_back(line.substr(2 * depth, colon - 2 * depth));
      if (line.find_first_not_of(' ', colon + 1) == std::string::npos) continue;
      std::string key;
      for (const std::string& part : path) key += (key.empty() ? "" : ".") + part;
      lines.push_back(key + " =" + line.substr(colon + 1));
    }
    return lines;
  };
  const std::vector<std::string> known = dotted(other);
  std::string result;
  for (const std::string& line : dotted(text))
    if (std::find(known.begin(), known.end(), line) == known.end()) result += line + "\n";
  return result;
}

/// The name of a recording.
std::string nameOf(const std::string& input) {
  std::filesystem::path path = std::filesystem::absolute(input + "/.").lexically_normal().parent_path();
  if (path.filename() == "mav0") path = path.parent_path();
  return path.filename().string();
}

class Report {
 public:
  Report(const RunRecord& record, const OdometryResult& result, const RunSeries& series)
      : record_(record),
        result_(result),
        frames_(series.frames()),
        series_(series),
        page_("Run on " + nameOf(record.input)),
        poses_(stampedPoses(result.trajectory)),
        refined_(stampedPoses(result.refined_trajectory)) {
    if (!frames_.empty()) t0_ns_ = frames_.front().t_ns;
    if (poses_.empty() || record.groundtruth.empty()) return;
    TrajectoryErrorParams params;
    params.from_ns = result.statistics.first_frame_ns;
    params.to_ns = result.statistics.last_frame_ns;
    const StampedPoses truth = atImageStamps(record.groundtruth, result.time_offset_s);
    try {
      errors_ = evaluateTrajectory(poses_, truth, params);
      if (!refined_.empty()) refined_errors_ = evaluateTrajectory(refined_, truth, params);
      if (knowsCovariances()) consistency_ = evaluateConsistency(poses_, covariances(), truth, params);
    } catch (const EvaluationError& error) {
      truth_fault_ = error.what();
    }
  }

  std::string text() {
    summary();
    trajectory();
    loopSection(page_, result_);
    map();
    tracking();
    biases();
    calibration();
    timing();
    input();
    return page_.text();
  }

 private:
  bool knowsCovariances() const {
    return std::any_of(result_.trajectory.begin(), result_.trajectory.end(),
                       [](const OdometryPose& pose) { return pose.covariance.back() > 0; });
  }

  std::vector<PoseCovariance> covariances() const {
    std::vector<PoseCovariance> covariances;
    for (const OdometryPose& pose : result_.trajectory) covariances.push_back(covarianceOf(pose));
    return covariances;
  }

  double secondsAt(const RunFrame& frame) const { return 1e-9 * static_cast<double>(frame.t_ns - t0_ns_); }

  /// A curve over time; only frames in the window where `window_only`.
  template <class Value>
  Curve over(const std::string& title, bool window_only, const Value& value) const {
    Curve curve{title, {}};
    for (const RunFrame& frame : frames_) {
      if (frame.lost) curve.points.push_back({kGap, kGap});
      if (frame.in_window || !window_only) curve.points.push_back({secondsAt(frame), value(frame)});
    }
    curve.points = thinned(curve.points);
    return curve;
  }

  void summary() {
    if (!result_.fault().empty()) page_.warnings({"Not to be trusted: " + result_.fault() + "."});
    const OdometryStatistics& s = result_.statistics;
    const double duration_s = 1e-9 * static_cast<double>(s.last_frame_ns - s.first_frame_ns);
    double path_m = 0;
    for (std::size_t i = 1; i < poses_.size(); ++i) path_m += (poses_[i].second.p - poses_[i - 1].second.p).norm();
    Table table{"summary", "", {"", ""}, {}, {}};
    table.rows.push_back({"recording", std::to_string(s.frames) + " frames, " + fixedText(duration_s, 1) + " s"});
    table.rows.push_back(
        {"poses", std::to_string(s.frames_with_pose) + " of " + std::to_string(s.frames) +
                      (s.first_pose_s >= 0 ? ", first after " + fixedText(s.first_pose_s, 1) + " s" : "")});
    table.rows.push_back({"travelled", fixedText(path_m, 1) + " m"});
    if (errors_)
      table.rows.push_back({"position error (RMSE)", fixedText(errors_->position_m.rmse, 4) + " m, at most " +
                                                         fixedText(errors_->position_m.max, 4) + " m"});
    const std::string beside = result_.lines_beside > 0
                                   ? " (" + std::to_string(result_.lines_beside) + " more run beside better seen ones)"
                                   : "";
    table.rows.push_back({"map", std::to_string(result_.map.lines.size()) + " lines" + beside + ", " +
                                     std::to_string(result_.map.points.size()) + " points, " +
                                     std::to_string(result_.map.keyframes.size()) + " keyframes"});
    const std::string& verdict = result_.refinement.verdict;
    table.rows.push_back({"refinement", verdict.empty() ? "left out" : verdict});
    table.rows.push_back({"starts anew", std::to_string(s.resets)});
    table.rows.push_back({"speed", fixedText(static_cast<double>(s.frames) / std::max(record_.costs.wall_s, 1e-3), 0) +
                                       " frames/s, " + durationText(record_.costs.wall_s)});
    page_.table(table);
    const auto advice = adviceFor(result_, record_.calibration, series_, record_.recording_warnings);
    page_.warnings(advice);
    if (advice.empty()) page_.paragraph("Nothing out of the ordinary was noticed.");
  }

  void trajectory() {
    page_.heading("Trajectory");
    if (poses_.empty()) return page_.paragraph("There is none.");
    std::vector<NamedTrajectory> drawn;
    StampedPoses estimate = poses_;
    if (errors_) {
      drawn.push_back({"truth", part(record_.groundtruth), ""});
      estimate = moved(poses_, errors_->S_truth_estimate);
    }
    drawn.push_back({"causal", estimate, ""});
    if (refined_errors_) drawn.push_back({"refined", moved(refined_, refined_errors_->S_truth_estimate), ""});
    NamedErrors errors;
    if (errors_) errors.emplace_back("causal", *errors_);
    if (refined_errors_) errors.emplace_back("refined", *refined_errors_);
    page_.beginGallery();
    page_.figure(topView(drawn), errors_ ? "From above, laid onto the ground truth" : "From above");
    page_.figure(heightOverTime(drawn, t0_ns_), "Height over time");
    if (errors_) page_.figure(errorOverTime(errors), "Position error over time");
    if (errors_) page_.figure(relativeErrorBoxes(errors), "Relative errors: median, middle half, from 5 % to 95 %");
    page_.figure(speed(), "Speed over time");
    page_.endGallery();
    if (errors_) errorTable();
    if (consistency_) consistencySection(*consistency_, page_);
    const std::string& fault = truth_fault_.empty() ? record_.truth_fault : truth_fault_;
    if (!errors_)
      page_.paragraph(fault.empty() ? "The recording carries no ground truth: no errors can be given."
                                    : "The ground truth could not be used: " + fault);
  }

  void errorTable() {
    Table table{"errors", "Against the ground truth of the recording", {"figure", "causal"}, {}, {}};
    for (const auto& row : trajectoryRows(*errors_)) table.rows.push_back({row[0], row[1]});
    if (refined_errors_) {
      table.columns.emplace_back("refined");
      const auto refined = trajectoryRows(*refined_errors_);
      for (std::size_t i = 0; i < refined.size(); ++i) table.rows[i].emplace_back(refined[i][1]);
    }
    page_.table(table);
  }

  StampedPoses part(const StampedPoses& truth) const {
    StampedPoses result;
    for (const auto& pose : truth)
      if (pose.first >= result_.statistics.first_frame_ns && pose.first <= result_.statistics.last_frame_ns)
        result.push_back(pose);
    return result;
  }

  Figure speed() const {
    Figure figure{"", "time [s]", "speed [m/s]"};
    figure.curves = {over("", true, [](const RunFrame& f) { return f.speed_m_s; })};
    figure.height_px = 260;
    figure.from_zero = true;
    return figure;
  }

  void map() {
    page_.heading("Map");
    if (result_.map.lines.empty()) return page_.paragraph("It holds no lines.");
    page_.beginGallery();
    if (!record_.map_picture.empty()) page_.picture(record_.map_picture, "Preview");
    page_.figure(mapFromAbove(result_.map, {}, {}, poses_), "From above");
    page_.endGallery();
    std::size_t degenerate = 0, constrained = 0, mapped = 0;
    double length_m = 0;
    for (const MapLine& line : result_.map.lines) {
      degenerate += line.degenerate;
      constrained += line.constrained;
      mapped += line.mapped;
      length_m += line.segment_w.length();
    }
    page_.paragraph(std::to_string(result_.map.lines.size()) + " lines of " + fixedText(length_m, 1) + " m in all, " +
                    std::to_string(degenerate) + " degenerate, " + std::to_string(constrained) +
                    " with a direction taken from their group." +
                    (mapped > 0 ? " " + std::to_string(mapped) + " of them tracking had missed: they were found in " +
                                      std::to_string(result_.densification.images) + " images afterwards."
                                : ""));
  }

  void tracking() {
    page_.heading("Tracking");
    Figure image{"", "time [s]", "in the image"}, window{"", "time [s]", "used by the estimator"};
    image.curves = {over("points", false, [](const RunFrame& f) { return double(f.points_tracked); }),
                    over("lines", false, [](const RunFrame& f) { return double(f.lines_tracked); })};
    window.curves = {over("points", true, [](const RunFrame& f) { return double(f.points_used); }),
                     over("well determined lines", true, [](const RunFrame& f) { return double(f.lines_used); }),
                     over("degenerate lines", true, [](const RunFrame& f) { return double(f.lines_degenerate); })};
    Figure degenerate{"", "time [s]", "degenerate lines"};
    degenerate.curves = {
        over("all", true, [](const RunFrame& f) { return double(f.lines_degenerate); }),
        over("direction unknown", true, [](const RunFrame& f) { return double(f.lines_direction_unknown); }),
        over("distance unknown", true, [](const RunFrame& f) { return double(f.lines_distance_unknown); }),
        over("through the epipole", true, [](const RunFrame& f) { return double(f.lines_through_epipole); }),
        over("constrained", true, [](const RunFrame& f) { return double(f.lines_constrained); })};
    page_.beginGallery();
    for (Figure* figure : {&image, &window, &degenerate}) {
      figure->from_zero = true;
      figure->height_px = 300;
    }
    page_.figure(image, "Points and lines tracked in the image");
    page_.figure(window, "Points and lines in the window, and lines whose own views leave direction or depth open");
    page_.figure(degenerate, "Degenerate lines by their reason, and those held by lines parallel to them");
    page_.endGallery();
    const FrontEndStatistics& f = result_.statistics.front_end;
    page_.table(
        {"tracks",
         "",
         {"", "points", "lines"},
         {{"median life [frames]", fixedText(f.points.lifetimes.median(), 0), fixedText(f.lines.lifetimes.median(), 0)},
          {"seen in 10 frames or more [%]", fixedText(100 * f.points.lifetimes.shareOfAtLeast(10), 1),
           fixedText(100 * f.lines.lifetimes.shareOfAtLeast(10), 1)}},
         {}});
  }

  /// A bias over time, with a band of one standard deviation to both sides.
  template <class Value>
  std::vector<Curve> biasCurves(const std::string& name, const std::string& colour, const Value& value) const {
    Curve band{"", {}, CurveStyle::kBand, colour};
    for (const RunFrame& frame : frames_) {
      if (!frame.in_window || !frame.bias_sigma) continue;
      for (const int side : {1, -1})
        band.points.push_back({secondsAt(frame), value(frame.bias) + side * value(*frame.bias_sigma)});
    }
    Curve curve = over(name, true, [&](const RunFrame& f) { return value(f.bias); });
    curve.colour = colour;
    return {band, curve};
  }

  void biases() {
    page_.heading("IMU biases");
    Figure gyro{"", "time [s]", "gyroscope [rad/s]"}, accel{"", "time [s]", "accelerometer [m/s^2]"};
    for (int axis = 0; axis < 3; ++axis) {
      const std::string name(1, "xyz"[axis]);
      const auto gyroOf = [axis](const ImuBias& bias) { return bias.gyro[axis]; };
      const auto accelOf = [axis](const ImuBias& bias) { return bias.accel[axis]; };
      for (Curve& curve : biasCurves(name, plotColour(static_cast<std::size_t>(axis)), gyroOf))
        gyro.curves.push_back(curve);
      for (Curve& curve : biasCurves(name, plotColour(static_cast<std::size_t>(axis)), accelOf))
        accel.curves.push_back(curve);
    }
    gyro.height_px = accel.height_px = 300;
    page_.beginGallery();
    page_.figure(gyro, "Bias of the gyroscope; the band is one standard deviation to both sides");
    page_.figure(accel, "Bias of the accelerometer; the band is one standard deviation to both sides");
    page_.endGallery();
  }

  void calibration() {
    page_.heading("Calibration");
    page_.table(calibrationTable(record_, result_));
  }

  void timing() {
    page_.heading("Timing");
    const OdometryStatistics& s = result_.statistics;
    Figure figure{"", "frame", "CPU time [ms]"};
    Table table{"timing", "CPU time a frame [ms]", {"stage", "mean", "median", "95 %", "max"}, {}, {}};
    for (const auto& [name, clock] : {std::pair<std::string, const StageClock*>{"decoding", &s.decoding},
                                      {"tracking", &s.tracking},
                                      {"estimation", &s.estimation},
                                      {"mapping", &s.mapping}}) {
      std::vector<double> ms = clock->ms();
      if (ms.empty()) continue;
      Curve curve{name, {}, CurveStyle::kDots};
      for (std::size_t i = 0; i < ms.size(); ++i) curve.points.push_back({double(i), ms[i]});
      curve.points = thinned(curve.points);
      figure.curves.push_back(curve);
      const ErrorStatistics stats = statisticsOf(ms);
      table.rows.push_back({name, fixedText(stats.mean, 2), fixedText(stats.median, 2), fixedText(stats.p95, 2),
                            fixedText(stats.max, 2)});
    }
    figure.from_zero = true;
    figure.height_px = 300;
    page_.table(table);
    page_.figure(figure, "CPU time of each frame");
    page_.table(costsTable(record_, result_));
  }

  void input() {
    page_.heading("What went in");
    const Rig& rig = record_.calibration;
    std::ostringstream noise;
    noise << rig.imu_noise.gyro_noise << ", " << rig.imu_noise.accel_noise;
    page_.table({"input",
                 "",
                 {"", ""},
                 {{"recording", record_.input},
                  {"camera", std::to_string(rig.camera.width) + "x" + std::to_string(rig.camera.height) + ", " +
                                 fixedText(rig.camera_rate_hz, 1) + " Hz"},
                  {"IMU", fixedText(rig.imu_rate_hz, 0) + " Hz, noise of gyroscope and accelerometer " + noise.str()},
                  {"lintel-vio", version()}},
                 {}});
    const std::string changed = differences(record_.configuration, record_.defaults);
    page_.paragraph(changed.empty() ? "Every option has its default." : "Options that differ from their defaults:");
    if (!changed.empty()) page_.preformatted(changed);
    page_.folded("The whole configuration", record_.configuration);
  }

  const RunRecord& record_;
  const OdometryResult& result_;
  const std::vector<RunFrame>& frames_;
  const RunSeries& series_;
  HtmlPage page_;
  StampedPoses poses_, refined_;
  std::int64_t t0_ns_ = 0;
  std::optional<TrajectoryErrors> errors_, refined_errors_;
  std::optional<Consistency> consistency_;
  std::string truth_fault_;
};

}  // namespace

std::string runReport(const RunRecord& record, const OdometryResult& result, const RunSeries& series) {
  return Report(record, result, series).text();
}

}  // namespace lintel
