// SPDX-License-Identifier: BSD-3-Clause
// Recordings with something wrong: lintel-vio names the likely cause and does not exit with 0.
#include <functional>
#include <sstream>
#include <vector>

#include "Pipeline.h"

namespace lintel {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A copy of a recording, images linked; the IMU's table and the camera's calibration can be changed.
void copyRecording(const fs::path& recording, const fs::path& copy) {
  fs::create_directories(copy / "mav0/cam0");
  fs::copy(recording / "mav0/imu0", copy / "mav0/imu0");
  for (const char* file : {"data.csv", "sensor.yaml"})
    fs::copy(recording / "mav0/cam0" / file, copy / "mav0/cam0" / file);
  fs::create_directory_symlink(fs::absolute(recording / "mav0/cam0/data"), copy / "mav0/cam0/data");
}

/// Lets `change` have the time [ns] and the numbers of every row of the IMU's table.
void changeImu(const fs::path& copy, const std::function<void(long long&, std::vector<double>&)>& change) {
  const fs::path table = copy / "mav0/imu0/data.csv";
  std::istringstream in(bytesOf(table));
  std::ofstream out(table);
  out.precision(12);
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') {
      out << line << "\n";
      continue;
    }
    std::istringstream row(line);
    long long t_ns = 0;
    row >> t_ns;
    std::vector<double> values(6);
    for (double& value : values) row.ignore() >> value;
    change(t_ns, values);
    out << t_ns;
    for (const double value : values) out << "," << value;
    out << "\n";
  }
}

/// Seven seconds of a recording.
std::string partOf(const fs::path& recording) {
  return shellWord(recording) + " -o " + shellWord(recording / "out") + " --to 7 --export none --no-refine";
}

/// What the program's last line complains of.
std::string complaintIn(const std::string& errors) {
  const std::size_t at = errors.find("not to be trusted: ");
  return at == std::string::npos ? "" : errors.substr(at + 19, errors.find('\n', at) - at - 19);
}

TEST_F(Pipeline, ACameraThatIsTurned) {
  const fs::path copy = folder_ / "camera_turned", yaml = copy / "mav0/cam0/sensor.yaml";
  copyRecording(recording(), copy);
  const std::string text = bytesOf(yaml);
  const std::size_t begin = text.find('[', text.find("T_BS")) + 1, end = text.find(']', begin);
  std::istringstream in(text.substr(begin, end - begin));
  std::vector<double> T(16);
  for (double& value : T) {
    in >> value;
    in.ignore();
  }
  for (std::size_t row = 0; row < 3; ++row) {  // by 90 degrees about its viewing axis
    const double x = T[4 * row], y = T[4 * row + 1];
    T[4 * row] = y;
    T[4 * row + 1] = -x;
  }
  std::ofstream out(yaml);
  out << text.substr(0, begin);
  for (std::size_t i = 0; i < 16; ++i) out << (i ? ", " : "") << T[i];
  out << text.substr(end);
  out.close();
  EXPECT_EQ(run("lintel-vio", partOf(copy)), 1);
  // the fit knows the angle to some degrees
  EXPECT_THAT(complaintIn(bytesOf(folder_ / "lintel-vio.err")),
              ContainsRegex("turned by about (8[4-9]|9[0-6]) degrees about its viewing axis"));
}

TEST_F(Pipeline, AnAccelerometerInG) {
  const fs::path copy = folder_ / "accelerometer_in_g";
  copyRecording(recording(), copy);
  changeImu(copy, [](long long&, std::vector<double>& values) {
    for (std::size_t i = 3; i < 6; ++i) values[i] /= 9.80665;
  });
  EXPECT_EQ(run("lintel-vio", partOf(copy)), 1);
  const std::string complaint = complaintIn(bytesOf(folder_ / "lintel-vio.err"));
  EXPECT_THAT(complaint, HasSubstr("in g, not in m/s^2"));
  EXPECT_THAT(bytesOf(folder_ / "lintel-vio.out"), StartsWith("NOT TO BE TRUSTED: " + complaint));
  EXPECT_THAT(bytesOf(copy / "out/report.html"), HasSubstr("Not to be trusted: "));
}

TEST_F(Pipeline, ClocksThatDiffer) {
  const fs::path copy = folder_ / "clocks_differ";
  copyRecording(recording(), copy);
  changeImu(copy, [](long long& t_ns, std::vector<double>&) { t_ns += 400'000'000; });
  EXPECT_EQ(run("lintel-vio", partOf(copy)), 1);
  EXPECT_THAT(complaintIn(bytesOf(folder_ / "lintel-vio.err")), HasSubstr("clocks of images and IMU differ"));
}

}  // namespace
}  // namespace lintel
