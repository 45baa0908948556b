// SPDX-License-Identifier: BSD-3-Clause
#include "RosMessages.h"

#include <opencv2/imgproc.hpp>

#include "ByteReader.h"
#include "ImageFile.h"
#include "SensorStream.h"

namespace lintel {
namespace {

/// Values of a message: ROS 1 packs them, CDR (ROS 2) aligns them to their size, counted from behind its head of four
/// bytes, and ends texts with a zero.
class MessageReader {
 public:
  MessageReader(const BagMessage& message, BagEncoding encoding)
      : reader_(message.bytes->data(), message.bytes->size()), cdr_(encoding == BagEncoding::kCdr) {
    if (!cdr_) return;
    const auto head = reader_.get<std::uint32_t>();
    const std::uint8_t representation = head >> 8 & 0xff;
    if ((representation & 1) == 0) throw ByteReader::OutOfBytes();  // big-endian: no machine of today writes it
    max_alignment_ = representation < 6 ? 8 : 4;                    // XCDR2 aligns to 4 at most
    reader_ = reader_.part(reader_.remaining());
  }

  template <class T>
  T get() {
    align(sizeof(T));
    return reader_.get<T>();
  }
  template <class T>
  void skip(int count = 1) {
    for (int i = 0; i < count; ++i) get<T>();
  }
  std::string text() {
    align(4);
    std::string value = reader_.text();
    if (cdr_ && !value.empty() && value.back() == '\0') value.pop_back();
    return value;
  }
  ByteReader bytes() { return reader_.part(get<std::uint32_t>()); }

  /// std_msgs/Header. Gives its stamp.
  std::int64_t header() {
    if (!cdr_) skip<std::uint32_t>();  // seq
    const auto seconds = get<std::uint32_t>(), nanoseconds = get<std::uint32_t>();
    text();
    return static_cast<std::int64_t>(seconds) * 1000000000 + nanoseconds;
  }

  Eigen::Vector3d vector() {
    const auto x = get<double>(), y = get<double>(), z = get<double>();
    return {x, y, z};
  }

 private:
  void align(std::size_t size) {
    if (!cdr_) return;
    const std::size_t alignment = size < max_alignment_ ? size : max_alignment_;
    reader_.part((alignment - reader_.position() % alignment) % alignment);
  }

  ByteReader reader_;
  bool cdr_;
  std::size_t max_alignment_ = 8;
};

/// How the pixels of an encoding (sensor_msgs/image_encodings.h) become grey.
struct PixelForm {
  const char* encoding;
  int type;         ///< OpenCV's, of the bytes as they are
  int grey;         ///< OpenCV's conversion; kAsItIs and kOneChannel are not its
  int channel = 0;  ///< with kOneChannel
};
constexpr int kAsItIs = -1, kOneChannel = -2;

constexpr PixelForm kForms[] = {{"mono8", CV_8UC1, kAsItIs},
                                {"8UC1", CV_8UC1, kAsItIs},
                                {"mono16", CV_16UC1, kAsItIs},
                                {"16UC1", CV_16UC1, kAsItIs},
                                {"bgr8", CV_8UC3, cv::COLOR_BGR2GRAY},
                                {"8UC3", CV_8UC3, cv::COLOR_BGR2GRAY},
                                {"rgb8", CV_8UC3, cv::COLOR_RGB2GRAY},
                                {"bgra8", CV_8UC4, cv::COLOR_BGRA2GRAY},
                                {"rgba8", CV_8UC4, cv::COLOR_RGBA2GRAY},
                                {"bayer_rggb8", CV_8UC1, cv::COLOR_BayerBG2GRAY},
                                {"bayer_bggr8", CV_8UC1, cv::COLOR_BayerRG2GRAY},
                                {"bayer_gbrg8", CV_8UC1, cv::COLOR_BayerGR2GRAY},
                                {"bayer_grbg8", CV_8UC1, cv::COLOR_BayerGB2GRAY},
                                {"yuv422", CV_8UC2, kOneChannel, 1},
                                {"uyvy", CV_8UC2, kOneChannel, 1},
                                {"yuv422_yuy2", CV_8UC2, kOneChannel, 0},
                                {"yuyv", CV_8UC2, kOneChannel, 0}};

cv::Mat greyOf(const cv::Mat& pixels, const PixelForm& form) {
  cv::Mat grey;
  if (form.grey == kOneChannel)
    cv::extractChannel(pixels, grey, form.channel);
  else if (form.grey != kAsItIs)
    cv::cvtColor(pixels, grey, form.grey);
  else if (pixels.depth() == CV_16U)  // the upper eight bits, as of a 16-bit PNG
    cv::extractChannel(cv::Mat(pixels.rows, pixels.cols, CV_8UC2, pixels.data, pixels.step), grey, 1);
  else
    grey = pixels;
  return grey;
}

GrayImage rawImage(MessageReader& message, const std::string& where) {
  const auto height = message.get<std::uint32_t>(), width = message.get<std::uint32_t>();
  const std::string encoding = message.text();
  const bool big_endian = message.get<std::uint8_t>() != 0;
  const auto step = message.get<std::uint32_t>();
  const ByteReader data = message.bytes();
  for (const PixelForm& form : kForms) {
    if (encoding != form.encoding) continue;
    const std::uint64_t row = std::uint64_t{width} * CV_ELEM_SIZE(form.type);
    if (width == 0 || height == 0 || width > 65536 || height > 65536 || step < row ||
        data.remaining() < std::uint64_t{step} * (height - 1) + row)
      throw ImageFault(where + ": its pixels are fewer than its size says");
    if (big_endian && CV_MAT_DEPTH(form.type) == CV_16U)
      throw ImageFault(where + ": big-endian pixels are not supported");
    const cv::Mat pixels(static_cast<int>(height), static_cast<int>(width), form.type,
                         const_cast<std::uint8_t*>(data.begin()), step);
    return grayImageOf(greyOf(pixels, form));
  }
  throw ImageFault(where + ": the encoding '" + encoding +
                   "' is not supported: record mono8, bgr8 or compressed images");
}

}  // namespace

std::int64_t stampOf(const BagMessage& message, BagEncoding encoding) {
  return MessageReader(message, encoding).header();
}

ImuSample imuOf(const BagMessage& message, BagEncoding encoding) {
  MessageReader reader(message, encoding);
  ImuSample sample;
  sample.t_ns = reader.header();
  reader.skip<double>(4 + 9);  // orientation and its covariance
  sample.gyro = reader.vector();
  reader.skip<double>(9);
  sample.accel = reader.vector();
  return sample;
}

GrayImage imageOf(const BagMessage& message, const BagTopic& topic, const std::string& where) {
  try {
    MessageReader reader(message, topic.encoding);
    reader.header();
    if (topic.type == "sensor_msgs/Image") return rawImage(reader, where);
    reader.text();  // "jpeg", "png", … : the bytes themselves say it
    const ByteReader data = reader.bytes();
    return decodeGrayImage({data.begin(), data.end()}, where);
  } catch (const ByteReader::OutOfBytes&) {
    throw ImageFault(where + ": the message is cut");
  }
}

}  // namespace lintel
