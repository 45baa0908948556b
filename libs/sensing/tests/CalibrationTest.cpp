// SPDX-License-Identifier: BSD-3-Clause
#include "lintel/sensing/Calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "TinyEuroc.h"
#include "lintel/sensing/RigReport.h"

namespace lintel {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A camera that looks along the IMU's x axis; its image's right is -y, its down is -z. One matrix and, by hand, its
/// inverse: p_b = (z_c, -x_c, -y_c) + (0.1, 0.2, 0.3).
constexpr const char* kCamFromImu = "[[0, -1, 0, 0.2], [0, 0, -1, 0.3], [1, 0, 0, -0.1], [0, 0, 0, 1]]";
constexpr const char* kImuFromCam = "[[0, 0, 1, 0.1], [-1, 0, 0, 0.2], [0, -1, 0, 0.3], [0, 0, 0, 1]]";

std::string noise(const std::string& indent) {
  return indent + "gyroscope_noise_density: 1.0e-04\n" + indent + "gyroscope_random_walk: 2.0e-05\n" + indent +
         "accelerometer_noise_density: 3.0e-03\n" + indent + "accelerometer_random_walk: 4.0e-04\n";
}

std::string chain(const std::string& pose_key, const char* pose) {
  return "cam0:\n  cam_overlaps: [1]\n  camera_model: pinhole\n  distortion_coeffs: [-0.3, 0.1, 0.001, 0.002]\n"
         "  distortion_model: radtan\n  intrinsics: [20, 21, 16, 12]\n  resolution: [32, 24]\n"
         "  rostopic: /cam0/image_raw\n  timeshift_cam_imu: 0.005\n  " +
         pose_key + ": " + pose +
         "\ncam1:\n  camera_model: pinhole\n  distortion_coeffs: [0.1, 0.1, 0.1, 0.1]\n"
         "  distortion_model: equidistant\n  intrinsics: [30, 31, 16, 12]\n  resolution: [32, 24]\n"
         "  rostopic: /cam1/image_raw\n  T_cam_imu: " +
         kCamFromImu + "\n";
}

class CalibrationTest : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    test::writeText(folder_ / name, text);
    return folder_ / name;
  }
  std::string error(const std::vector<std::string>& files) {
    try {
      readCalibration(files);
    } catch (const RecordingError& e) {
      return e.what();
    }
    return "";
  }
  /// The camera that all forms describe.
  static void expectCamera(const CameraCalibration& camera) {
    const Camera model = camera.make();
    EXPECT_EQ(model.width, 32);
    EXPECT_EQ(model.height, 24);
    EXPECT_EQ(model.fx, 20);
    EXPECT_EQ(model.fy, 21);
    EXPECT_EQ(model.cx, 16);
    EXPECT_EQ(model.cy, 12);
    EXPECT_EQ(model.lens[0], -0.3);
    EXPECT_EQ(model.lens[3], 0.002);
    ASSERT_TRUE(camera.T_b_c);
    const Eigen::Vector3d p_b = *camera.T_b_c * Eigen::Vector3d(1, 2, 3);
    EXPECT_LT((p_b - Eigen::Vector3d(3.1, -0.8, -1.7)).norm(), 1e-12);
    EXPECT_EQ(camera.time_shift_s, 0.005);
  }
  test::TempFolder folder_;
};

TEST_F(CalibrationTest, KalibrsCameraFromImuIsInverted) {
  const Calibration read = readCalibration({write("camchain-imucam.yaml", chain("T_cam_imu", kCamFromImu)),
                                            write("imu.yaml", "rostopic: /imu0\nupdate_rate: 150.0\n" + noise(""))});
  ASSERT_EQ(read.cameras.size(), 2U);
  expectCamera(read.cameras[0]);
  EXPECT_EQ(read.cameras[0].topic, "/cam0/image_raw");
  EXPECT_EQ(read.imu_topic, "/imu0");
  EXPECT_EQ(read.imu_rate_hz, 150);
  ASSERT_TRUE(read.imu_noise);
  EXPECT_EQ(read.imu_noise->gyro_noise, 1e-4);
  EXPECT_EQ(read.imu_noise->gyro_walk, 2e-5);
  EXPECT_EQ(read.imu_noise->accel_noise, 3e-3);
  EXPECT_EQ(read.imu_noise->accel_walk, 4e-4);
}

TEST_F(CalibrationTest, OpenVinsFilesAreFoundFromItsConfiguration) {
  write("kalibr_imucam_chain.yaml", "%YAML:1.0\n\n" + chain("T_imu_cam", kImuFromCam));
  write("kalibr_imu_chain.yaml", "%YAML:1.0\n\nimu0:\n  rostopic: /imu0\n  update_rate: 200.0\n" + noise("  "));
  const Calibration read = readCalibration({write("estimator_config.yaml",
                                                  "%YAML:1.0\nmax_clones: 11\n"
                                                  "relative_config_imu: \"kalibr_imu_chain.yaml\"\n"
                                                  "relative_config_imucam: \"kalibr_imucam_chain.yaml\"\n")});
  EXPECT_EQ(read.form, "OpenVINS");
  expectCamera(read.cameras.at(0));
  EXPECT_EQ(read.imu_noise->accel_noise, 3e-3);
}

constexpr const char* kVinsCamera =
    "model_type: PINHOLE\ncamera_name: camera\nimage_width: 32\nimage_height: 24\n"
    "distortion_parameters:\n   k1: -0.3\t\n   k2: 0.1\n   p1: 0.001\n   p2: 0.002\n"
    "projection_parameters:\n   fx: 20\n   fy: 21\n   cx: 16\n   cy: 12\n";

TEST_F(CalibrationTest, VinsMonoHasDiscreteNoise) {
  const Calibration read = readCalibration({write(
      "euroc.yaml", "%YAML:1.0\nimu_topic: \"/imu0\"\nimage_topic: \"/cam0/image_raw\"\n" + std::string(kVinsCamera) +
                        "extrinsicRotation: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
                        "   data: [0, 0, 1,\n     -1, 0, 0,\n     0, -1, 0]\n"
                        "extrinsicTranslation: !!opencv-matrix\n   rows: 3\n   cols: 1\n   dt: d\n"
                        "   data: [0.1, 0.2, 0.3]\nacc_n: 0.08\ngyr_n: 0.004\nacc_w: 0.00004\n"
                        "gyr_w: 2.0e-6\ntd: 0.005\n")});
  EXPECT_EQ(read.form, "VINS");
  expectCamera(read.cameras.at(0));
  EXPECT_EQ(read.cameras[0].topic, "/cam0/image_raw");
  EXPECT_NEAR(read.imu_noise->accel_noise, 0.08 / std::sqrt(200.0), 1e-12);
  EXPECT_NEAR(read.imu_noise->gyro_noise, 0.004 / std::sqrt(200.0), 1e-12);
}

TEST_F(CalibrationTest, VinsFusionNamesFilesOfCameras) {
  write("cam0_pinhole.yaml", "%YAML:1.0\n---\n" + std::string(kVinsCamera));
  const Calibration read =
      readCalibration({write("euroc_mono_imu.yaml",
                             "%YAML:1.0\n\nimu: 1\nnum_of_cam: 1\nimage0_topic: \"/cam0/image_raw\"\n"
                             "cam0_calib: \"cam0_pinhole.yaml\"\nbody_T_cam0: !!opencv-matrix\n   rows: 4\n"
                             "   cols: 4\n   dt: d\n   data: [0, 0, 1, 0.1, -1, 0, 0, 0.2,\n"
                             "          0, -1, 0, 0.3, 0, 0, 0, 1]\ntd: 0.005\n")});
  expectCamera(read.cameras.at(0));
  EXPECT_FALSE(read.imu_noise);
}

TEST_F(CalibrationTest, OpenCvHasTheCameraAlone) {
  const Calibration read =
      readCalibration({write("camera.yml",
                             "%YAML:1.0\n---\nimage_width: 32\nimage_height: 24\n"
                             "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
                             "   data: [ 20., 0., 16., 0., 21., 12., 0., 0., 1. ]\n"
                             "distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n"
                             "   data: [ -0.3, 0.1, 0.001, 0.002, 0. ]\n")});
  const Camera camera = read.cameras.at(0).make();
  EXPECT_EQ(camera.fy, 21);
  EXPECT_EQ(camera.cx, 16);
  EXPECT_EQ(camera.lens[2], 0.001);
  EXPECT_FALSE(read.cameras[0].T_b_c);
}

TEST_F(CalibrationTest, ACameraIsChosenByLabelOrTopic) {
  const Calibration read = readCalibration({write("chain.yaml", chain("T_cam_imu", kCamFromImu))});
  EXPECT_EQ(chooseCamera(read, "")->label, "cam0");
  EXPECT_EQ(chooseCamera(read, "cam1")->label, "cam1");
  EXPECT_EQ(chooseCamera(read, "/cam1/image_raw")->label, "cam1");
  EXPECT_THROW(chooseCamera(read, "cam2"), RecordingError);
  EXPECT_EQ(chooseCamera(read, "cam1")->make().model, LensModel::kEquidistant);
}

TEST_F(CalibrationTest, FaultsNameFileAndKey) {
  EXPECT_THAT(error({folder_ / "none.yaml"}), HasSubstr("none.yaml: missing"));
  EXPECT_THAT(error({write("empty.yaml", "")}), HasSubstr("empty.yaml: empty or no YAML map"));
  EXPECT_THAT(error({write("other.yaml", "a: 1\n")}), HasSubstr("no calibration of a known form"));
  EXPECT_THAT(error({write("bad.yaml", "cam0: [1\n")}), HasSubstr("not valid YAML"));
  const std::string whole = chain("T_cam_imu", kCamFromImu);
  std::string scaled = whole;
  scaled.replace(scaled.find("[[0, -1"), 7, "[[0, -9");
  EXPECT_THAT(error({write("scaled.yaml", scaled)}), AllOf(HasSubstr("cam0.T_cam_imu"), HasSubstr("no rotation")));
  std::string nan = whole;
  nan.replace(nan.find("0.005"), 5, ".nan");
  EXPECT_THAT(error({write("nan.yaml", nan)}), HasSubstr("cam0.timeshift_cam_imu must be a number"));
  // cut anywhere: an error of one line or a calibration, never anything else
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_EQ(error({write("cut.yaml", whole.substr(0, size))}).find('\n'), std::string::npos) << size;
}

TEST_F(CalibrationTest, ARigIsWrittenAndReadBack) {
  Rig rig;
  rig.camera = {32, 24, 20.1, 21.7, 16.3, 12.9, -0.3, 0.1, 0.001, 1.0 / 3};
  rig.T_b_c = {Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized())), {0.1, -0.2, 1e-9}};
  rig.imu_noise = {1e-4 / 3, 2e-5, 3e-3 / 7, 4e-4};
  rig.camera_rate_hz = 30;
  rig.imu_rate_hz = 400;
  rig.axes.A << 0.001, 0.02, 0, -0.05, 1.0 / 300, 0.03, 0, 0.007, -0.002;
  rig.axes.G << -0.02, 1.0 / 700, 0, 1.0 / 700, 0, 0.003, 0, 0.003, 0.011;
  for (const std::string form : {"kalibr", "vins"}) {
    SCOPED_TRACE(form);
    const Calibration read = readCalibration({write(form + ".yaml", writeCalibration(rig, -0.0125, form))});
    const CameraCalibration& camera = read.cameras.at(0);
    EXPECT_EQ(camera.make().fx, rig.camera.fx);
    EXPECT_EQ(camera.make().lens[3], rig.camera.lens[3]);
    EXPECT_EQ(camera.time_shift_s, -0.0125);
    EXPECT_LT(camera.T_b_c->q.angularDistance(rig.T_b_c.q), 1e-11);
    EXPECT_EQ(camera.T_b_c->p, rig.T_b_c.p);
    EXPECT_NEAR(read.imu_noise->gyro_noise, rig.imu_noise.gyro_noise, 1e-18);
    EXPECT_NEAR(read.imu_noise->accel_walk, rig.imu_noise.accel_walk, 1e-18);
    ASSERT_TRUE(read.axes);
    EXPECT_EQ(read.axes->A, rig.axes.A);
    EXPECT_EQ(read.axes->G, rig.axes.G);
  }
  EXPECT_THAT(rigInWords(rig), AllOf(HasSubstr("its axes are wrong by up to 5 %"), HasSubstr("by up to 2 %")));
}

TEST(RigDoubts, NameWhatIsStrange) {
  Rig rig;
  rig.camera = {752, 480, 458, 457, 367, 248, -0.28, 0.07, 0, 0};
  EXPECT_THAT(rigDoubts(rig, 0.003), IsEmpty());
  Rig millimetres = rig;
  millimetres.T_b_c.p = {21.6, -64.7, 9.8};
  EXPECT_THAT(rigDoubts(millimetres), ElementsAre(HasSubstr("millimetres")));
  Rig degrees = rig;
  degrees.imu_noise.gyro_noise = 0.02;  // deg/s/sqrt(Hz)
  EXPECT_THAT(rigDoubts(degrees), ElementsAre(AllOf(HasSubstr("gyroscope's noise"), HasSubstr("unit"))));
  Rig halved = rig;
  halved.camera.width = 376;
  halved.camera.height = 240;
  EXPECT_THAT(rigDoubts(halved), Contains(HasSubstr("another image size")));
  EXPECT_THAT(rigDoubts(rig, 5.0), ElementsAre(HasSubstr("milliseconds")));
}

/// At rest the specific force points up: along -y of an upright camera.
TEST(MountingDoubts, AnInvertedPoseAndGShow) {
  Rig rig;
  Eigen::Matrix3d R_b_c;  // EuRoC's: the IMU's x axis points up
  R_b_c << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  rig.T_b_c.q = Eigen::Quaterniond(R_b_c);
  EXPECT_THAT(mountingDoubts(rig, {9.7, 0.2, -1}), IsEmpty());
  EXPECT_THAT(mountingDoubts(rig, {1, 0, 0}), ElementsAre(HasSubstr("in g?")));
  EXPECT_THAT(mountingDoubts(rig, {0.01, 0, 0}), ElementsAre(HasSubstr("gravity must not be taken out")));
  rig.T_b_c = rig.T_b_c.inverse();
  EXPECT_THAT(mountingDoubts(rig, {9.7, 0.2, -1}), ElementsAre(HasSubstr("is the inverse given?")));
}

TEST_F(CalibrationTest, RigsAreReportedWithAndWithoutARecording) {
  RecordingParams params;
  params.calibration = {write("chain.yaml", chain("T_cam_imu", kCamFromImu))};
  EXPECT_EQ(reportRig("", params).time_shift_s, 0.005);
  test::TinyEuroc().write(folder_.path().string());
  EXPECT_EQ(reportRig(folder_.path().string(), {}).rig.camera.width, 32);
  EXPECT_EQ(reportRig(folder_.path().string(), params).rig.camera.fx, 20);
  params.calibration = {write("imu.yaml", noise(""))};
  EXPECT_THROW(reportRig("", params), RecordingError);
}

TEST(RigInWords, SaysWhereTheCameraLooks) {
  Rig rig;
  rig.camera = {752, 480, 458, 457, 367, 248, -0.28, 0.07, 0, 0};
  Eigen::Matrix3d R_b_c;
  R_b_c << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  rig.T_b_c = {Eigen::Quaterniond(R_b_c), {0.1, 0, 0}};
  EXPECT_THAT(rigInWords(rig, -0.05),
              AllOf(HasSubstr("looks along the IMU's +x"), HasSubstr("down is the IMU's -z"), HasSubstr("- 50 ms")));
}

/// The folder's calibration is replaced, the IMU moved to the images' clock.
TEST_F(CalibrationTest, ReplacesThatOfARecording) {
  test::TinyEuroc().write(folder_.path().string());
  RecordingParams params;
  params.calibration = {write("chain.yaml", chain("T_cam_imu", kCamFromImu))};
  const auto recording = openRecording(folder_.path().string(), params);
  EXPECT_EQ(recording->rig().camera.fx, 20);
  EXPECT_NEAR(recording->rig().T_b_c.p.z(), 0.3, 1e-15);
  recording->next();
  const std::int64_t t_ns = recording->next()->imu.back().t_ns;
  const ImuSample sample = test::readAll(*recording).steps.front().imu.back();
  EXPECT_GT(sample.t_ns, t_ns);
  // what the IMU measured at the image's time + 5 ms of its own clock
  EXPECT_LT((sample.gyro - test::TinyEuroc::gyroAt(sample.t_ns + 5000000)).norm(), 1e-7);
  // without its own calibration the recording can be read all the same
  std::filesystem::remove(folder_ / "mav0/cam0/sensor.yaml");
  const auto bare = test::readAll(folder_.path().string(), params);
  EXPECT_EQ(bare.steps.size(), 20U);
  EXPECT_THAT(bare.warnings, Contains(HasSubstr("noise densities")));
}

}  // namespace
}  // namespace lintel
