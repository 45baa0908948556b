// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/simulation/EurocWriter.h"

#include <fstream>
#include <iomanip>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "EurocSensorYaml.h"

namespace lintel {

namespace {

/// A text file whose every write is checked at the end.
class TextFile {
 public:
  explicit TextFile(const std::filesystem::path& path) : path_(path), stream_(path) {
    if (!stream_) fail();
    stream_.imbue(std::locale::classic());
  }
  std::ofstream& out() { return stream_; }
  void close() {
    stream_.close();
    if (!stream_) fail();
  }

 private:
  [[noreturn]] void fail() const {
    throw std::runtime_error(path_.string() + ": cannot be written, is the disk full?");
  }

  std::filesystem::path path_;
  std::ofstream stream_;
};

std::ostream& operator<<(std::ostream& out, const Eigen::Vector3d& v) {
  return out << v.x() << ',' << v.y() << ',' << v.z();
}

void writeText(const std::filesystem::path& path, const std::string& text) {
  TextFile file(path);
  file.out() << text;
  file.close();
}

}  // namespace

EurocWriter::EurocWriter(const std::filesystem::path& folder) : mav0_(folder / "mav0") {
  for (const char* sub : {"cam0/data", "imu0", "state_groundtruth_estimate0", "lines0", "scene0"}) {
    std::filesystem::create_directories(mav0_ / sub);
  }
}

void EurocWriter::writeSensors(const Rig& rig) const {
  writeText(mav0_ / "body.yaml", "comment: made by lintel-sim\n");
  writeText(mav0_ / "cam0/sensor.yaml", cameraYaml(rig));
  writeText(mav0_ / "imu0/sensor.yaml", imuYaml(rig));
  writeText(mav0_ / "state_groundtruth_estimate0/sensor.yaml", groundTruthYaml());
}

void EurocWriter::writeImage(std::int64_t t_ns, const GrayImage& image) const {
  const std::filesystem::path path = mav0_ / "cam0/data" / (std::to_string(t_ns) + ".png");
  const cv::Mat pixels(image.height, image.width, CV_8UC1,
                       const_cast<std::uint8_t*>(image.pixels.data()));  // only read
  std::vector<std::uint8_t> png;
  if (!cv::imencode(".png", pixels, png, {cv::IMWRITE_PNG_COMPRESSION, 1})) {
    throw std::runtime_error(path.string() + ": cannot be encoded");
  }
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  file.close();
  if (!file) throw std::runtime_error(path.string() + ": cannot be written, is the disk full?");
}

void EurocWriter::writeImageList(const std::vector<std::int64_t>& stamps) const {
  TextFile file(mav0_ / "cam0/data.csv");
  file.out() << "#timestamp [ns],filename\n";
  for (const std::int64_t t_ns : stamps) file.out() << t_ns << ',' << t_ns << ".png\n";
  file.close();
}

void EurocWriter::writeImu(const std::vector<ImuSample>& samples) const {
  TextFile file(mav0_ / "imu0/data.csv");
  file.out() << "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
                "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n"
             << std::setprecision(17);
  for (const ImuSample& s : samples) file.out() << s.t_ns << ',' << s.gyro << ',' << s.accel << '\n';
  file.close();
}

void EurocWriter::writeGroundTruth(const std::vector<InertialTruth>& truth) const {
  TextFile file(mav0_ / "state_groundtruth_estimate0/data.csv");
  file.out() << "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], "
                "v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], "
                "b_w_RS_S_x [rad s^-1], b_w_RS_S_y [rad s^-1], b_w_RS_S_z [rad s^-1], "
                "b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], b_a_RS_S_z [m s^-2]\n"
             << std::setprecision(17);
  for (const InertialTruth& t : truth) {
    const Eigen::Quaterniond& q = t.state.T_w_b.q;
    file.out() << t.t_ns << ',' << t.state.T_w_b.p << ',' << q.w() << ',' << q.x() << ',' << q.y() << ',' << q.z()
               << ',' << t.state.v_w_b << ',' << t.bias_gyro << ',' << t.bias_accel << '\n';
  }
  file.close();
}

void EurocWriter::writeLines(const std::vector<TrueLine>& lines) const {
  TextFile file(mav0_ / "lines0/data.csv");
  file.out() << "#id,x0 [m],y0 [m],z0 [m],x1 [m],y1 [m],z1 [m],direction_group,kind,frames_seen\n"
             << std::setprecision(9);
  std::size_t id = 0;
  for (const TrueLine& l : lines) {
    file.out() << id++ << ',' << l.line.segment_w.start << ',' << l.line.segment_w.end << ',' << l.direction_group
               << ',' << l.line.kind << ',' << l.frames_seen << '\n';
  }
  file.close();
}

void EurocWriter::writeScene(const Scene& scene) const {
  std::size_t faces = 0, vertices = 0;
  for (const Patch& p : scene.patches) {
    faces += p.triangle ? 1 : 2;
    vertices += p.triangle ? 3 : 4;
  }
  TextFile file(mav0_ / "scene0/scene.ply");
  auto& out = file.out();
  out << "ply\nformat ascii 1.0\nelement vertex " << vertices
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << faces
      << "\nproperty list uchar uint vertex_indices\nend_header\n"
      << std::setprecision(9);
  const auto vertex = [&](const Eigen::Vector3d& v) { out << v.x() << ' ' << v.y() << ' ' << v.z() << '\n'; };
  for (const Patch& p : scene.patches) {
    vertex(p.corner);
    vertex(p.corner + p.edge_u);
    if (!p.triangle) vertex(p.corner + p.edge_u + p.edge_v);
    vertex(p.corner + p.edge_v);
  }
  std::size_t first = 0;
  for (const Patch& p : scene.patches) {
    out << "3 " << first << ' ' << first + 1 << ' ' << first + 2 << '\n';
    if (!p.triangle) out << "3 " << first << ' ' << first + 2 << ' ' << first + 3 << '\n';
    first += p.triangle ? 3 : 4;
  }
  file.close();
}

}  // namespace lintel
