// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/programs/Euroc2Rawlog.h"

#include <cstdio>
#include <filesystem>
#include <ostream>
#include <string>

#include "CommandLine.h"
#include "ProgramMain.h"
#include "RecordingOptions.h"
#include "StopSignals.h"
#include "lintel/core/Formatted.h"
#include "lintel/reporting/Progress.h"
#include "lintel/sensing/EurocToRawlog.h"

namespace lintel {
namespace {

class Euroc2Rawlog {
 public:
  static constexpr const char* kName = "euroc2rawlog";

  Euroc2Rawlog(std::ostream& out, std::ostream& err) : out_(out), err_(err) { addOptions(); }

  int run(int argc, const char* const* argv) {
    if (const auto exit_code = line_.parse(argc, argv, out_, err_)) return *exit_code;
    if (std::filesystem::path(output_).extension() != ".rawlog")
      throw UsageError("-o must name a file ending in .rawlog");
    const EurocToRawlogSummary summary = convert();
    for (const std::string& warning : summary.warnings) err_ << kName << ": warning: " << oneLine(warning) << "\n";
    if (!quiet_) print(summary);
    return 0;
  }

 private:
  void addOptions() {
    line_.option("-i,--input", input_, "EuRoC folder (.../mav0 or its parent), ROS bag, film or folder of images")
        .required()
        .type("INPUT");
    line_.option("-o,--output", output_, "Rawlog to write").required().type("FILE.rawlog");
    line_.flag("-w,--overwrite", params_.overwrite, "Replace an existing rawlog and its image folder");
    line_.flag("-q,--quiet", quiet_, "Print warnings and errors only");
    line_.option("-z,--compress-level", params_.compress_level, "gzip level of the rawlog, 0 = not compressed")
        .range(0, 9)
        .showDefault();
    const auto embed = line_.flag("--embed", params_.embed, "Put the images into the rawlog instead of FILE_Images/");
    line_.flag("--copy", params_.copy, "Copy the images into FILE_Images/ instead of linking them").excludes(embed);
    addRecordingOptions(line_, params_.recording);
    line_.option("--cameras", params_.cameras, "Cameras of an EuRoC folder to write, e.g. cam0,cam1; all by default")
        .separatedBy(',')
        .type("CAMERAS");
  }

  EurocToRawlogSummary convert() {
    const StopSignals stop;
    Progress progress(err_, progressStyleFor(err_, quiet_), "writing " + output_, "images", 0);
    return eurocToRawlog(input_, output_, params_, [&](std::size_t done, std::size_t total) {
      stop.check();
      progress.update(done, total);
    });
  }

  void print(const EurocToRawlogSummary& summary) const {
    const std::string duration = formatted("%.2f s", static_cast<double>(summary.last_ns - summary.first_ns) * 1e-9);
    out_ << output_ << ": " << duration << ", ";
    for (const auto& [label, count] : summary.images) out_ << count << " images " << label << ", ";
    out_ << summary.imu_samples << " samples imu0";
    if (summary.groundtruth_poses > 0) out_ << ", " << summary.groundtruth_poses << " poses groundtruth";
    out_ << "\n";
    if (summary.images_folder.empty() || summary.linked + summary.copied == 0) return;
    out_ << summary.images_folder << ": " << summary.linked << " images linked, " << summary.copied << " copied\n";
  }

  std::ostream& out_;
  std::ostream& err_;
  CommandLine line_{kName, "Writes a recording as an MRPT rawlog."};
  std::string input_, output_;
  EurocToRawlogParams params_;
  bool quiet_ = false;
};

}  // namespace

int runEuroc2Rawlog(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  return programMain(Euroc2Rawlog::kName, err, [&] { return Euroc2Rawlog(out, err).run(argc, argv); });
}

}  // namespace lintel
