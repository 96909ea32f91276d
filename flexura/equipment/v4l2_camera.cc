#include "flexura/equipment/v4l2_camera.h"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

#include "flexura/base/names.h"
#include "flexura/base/one_line.h"
#include "flexura/equipment/frame_gaps.h"
#include "flexura/equipment/v4l2_picture.h"
#include "flexura/equipment/wall_clock.h"

namespace flexura {
namespace {

constexpr std::uint32_t wanted_buffers = 4;
constexpr std::uint32_t capture = V4L2_BUF_TYPE_VIDEO_CAPTURE;
constexpr double exposure_unit = 1e-4;  // s, of V4L2_CID_EXPOSURE_ABSOLUTE

// Formats of the device that can become gray or color, best first.
std::vector<std::uint32_t> formats_for(V4l2Format format, PixelKind pixels) {
  switch (format) {
    case V4l2Format::grey:
      return {V4L2_PIX_FMT_GREY};
    case V4l2Format::yuyv:
      return {V4L2_PIX_FMT_YUYV};
    case V4l2Format::rgb:
      return {V4L2_PIX_FMT_RGB24};
    case V4l2Format::mjpeg:
      return {V4L2_PIX_FMT_MJPEG};
    case V4l2Format::automatic:
      break;
  }
  if (pixels == PixelKind::color) return {V4L2_PIX_FMT_RGB24, V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_MJPEG};
  return {V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_RGB24, V4L2_PIX_FMT_MJPEG};
}

// Sets how a device encodes the colors of YUYV. What it leaves open follows from its color space.
void set_encoding(const v4l2_pix_format& format, V4l2Layout& layout) {
  std::uint32_t encoding = format.ycbcr_enc, range = format.quantization;
  if (encoding == V4L2_YCBCR_ENC_DEFAULT) encoding = V4L2_MAP_YCBCR_ENC_DEFAULT(format.colorspace);
  if (range == V4L2_QUANTIZATION_DEFAULT)
    range = V4L2_MAP_QUANTIZATION_DEFAULT(false, format.colorspace, encoding);
  layout.is_full_range = range == V4L2_QUANTIZATION_FULL_RANGE;
  if (encoding == V4L2_YCBCR_ENC_709 || encoding == V4L2_YCBCR_ENC_XV709)
    layout.red_share = 0.2126, layout.blue_share = 0.0722;
  else if (encoding == V4L2_YCBCR_ENC_BT2020)
    layout.red_share = 0.2627, layout.blue_share = 0.0593;
  else if (encoding == V4L2_YCBCR_ENC_SMPTE240M)
    layout.red_share = 0.212, layout.blue_share = 0.087;
}

// The device's buffers in this program's memory.
class Buffers {
 public:
  explicit Buffers(V4l2Device& device) : device_(device) {}
  ~Buffers() {
    auto type = static_cast<int>(capture);
    device_.ioctl(VIDIOC_STREAMOFF, &type);
    for (const auto& [memory, length] : mapped_) device_.calls().unmap(memory, length);
    v4l2_requestbuffers none = request(0);
    device_.ioctl(VIDIOC_REQBUFS, &none);
  }
  Buffers(const Buffers&) = delete;
  Buffers& operator=(const Buffers&) = delete;

  // Maps the buffers, gives them to the device and starts it. Returns 0 or a negative error number.
  int start() {
    v4l2_requestbuffers some = request(wanted_buffers);
    if (const int result = device_.ioctl(VIDIOC_REQBUFS, &some); result < 0) return result;
    if (some.count < 2) return -ENOMEM;
    for (std::uint32_t i = 0; i < some.count; ++i) {
      v4l2_buffer buffer = empty(i);
      if (const int result = device_.ioctl(VIDIOC_QUERYBUF, &buffer); result < 0) return result;
      void* memory = device_.map(buffer.length, buffer.m.offset);
      if (memory == nullptr) return -ENOMEM;
      mapped_.emplace_back(memory, buffer.length);
      if (const int result = give(i); result < 0) return result;
    }
    auto type = static_cast<int>(capture);
    return device_.ioctl(VIDIOC_STREAMON, &type);
  }
  int give(std::uint32_t index) {
    v4l2_buffer buffer = empty(index);
    return device_.ioctl(VIDIOC_QBUF, &buffer);
  }
  // Takes a filled buffer. Returns 0, or a negative error number: -EAGAIN if there is none.
  int take(v4l2_buffer& buffer) {
    buffer = empty(0);
    const int result = device_.ioctl(VIDIOC_DQBUF, &buffer);
    return result == 0 && buffer.index >= mapped_.size() ? -EIO : result;
  }
  [[nodiscard]] std::span<const std::uint8_t> bytes(const v4l2_buffer& buffer) const {
    const auto& [memory, length] = mapped_[buffer.index];
    return {static_cast<const std::uint8_t*>(memory), std::min<std::size_t>(buffer.bytesused, length)};
  }

 private:
  static v4l2_requestbuffers request(std::uint32_t count) {
    v4l2_requestbuffers result{};
    result.count = count, result.type = capture, result.memory = V4L2_MEMORY_MMAP;
    return result;
  }
  static v4l2_buffer empty(std::uint32_t index) {
    v4l2_buffer result{};
    result.index = index, result.type = capture, result.memory = V4L2_MEMORY_MMAP;
    return result;
  }
  V4l2Device& device_;
  std::vector<std::pair<void*, std::size_t>> mapped_;
};

class V4l2Connection {
 public:
  V4l2Connection(CameraFeed& feed, const V4l2Config& config, const CameraConfig& camera, V4l2Calls& calls)
      : feed_(feed), config_(config), camera_(camera), device_(calls, config.device) {}

  ConnectionEnd run();

 private:
  [[nodiscard]] ConnectionEnd loss(const std::string& what) const {
    return {{FaultKind::link_lost, fmt::format("{}{}: {}; trying again", camera_prefix(camera_.name),
                                               one_line(config_.device), what)},
            false};
  }
  // Each returns what the device refused, or "".
  [[nodiscard]] std::string set();
  [[nodiscard]] std::string set_format();
  [[nodiscard]] std::string set_light();
  [[nodiscard]] std::string set_control(std::uint32_t id, std::int32_t value, const char* name);
  void set_rate();
  [[nodiscard]] bool has(std::uint32_t id);
  [[nodiscard]] ConnectionEnd watch(Buffers& buffers);
  void take(const v4l2_buffer& buffer, std::span<const std::uint8_t> bytes);
  [[nodiscard]] double time_of(const v4l2_buffer& buffer) const;

  CameraFeed& feed_;
  const V4l2Config& config_;
  const CameraConfig& camera_;
  V4l2Device device_;
  V4l2Layout layout_;
  double exposure_ = 0;  // s
  NumberGaps gaps_{0, std::numeric_limits<std::uint32_t>::max()};
};

ConnectionEnd V4l2Connection::run() {
  if (const int problem = device_.problem(); problem < 0)
    return loss(v4l2_error(problem) + ": check the path, the cable and the user's group (video)");
  if (const std::string problem = set(); !problem.empty()) {
    return {{FaultKind::refused,
             fmt::format("{}{}: {}", camera_prefix(camera_.name), one_line(config_.device), problem)},
            false};
  }
  Buffers buffers(device_);
  if (const int result = buffers.start(); result < 0)
    return loss(v4l2_error(result) + ": check that no other program uses it");
  return watch(buffers);
}

std::string V4l2Connection::set() {
  v4l2_capability capability{};
  if (const int result = device_.ioctl(VIDIOC_QUERYCAP, &capability); result < 0)
    return fmt::format("this is no video device ({})", v4l2_error(result));
  const bool has_own = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0;
  const std::uint32_t can = has_own ? capability.device_caps : capability.capabilities;
  if ((can & V4L2_CAP_VIDEO_CAPTURE) == 0 || (can & V4L2_CAP_STREAMING) == 0)
    return "the device delivers no pictures: a camera has several devices, so try the device with the "
           "next lower number";
  if (std::string problem = set_format(); !problem.empty()) return problem;
  set_rate();
  return set_light();
}

std::string V4l2Connection::set_format() {
  const SensorConfig& sensor = camera_.sensor;
  std::string sizes;
  for (const std::uint32_t wanted : formats_for(config_.format, sensor.pixels)) {
    v4l2_format format{};
    format.type = capture;
    format.fmt.pix.width = static_cast<std::uint32_t>(sensor.width);
    format.fmt.pix.height = static_cast<std::uint32_t>(sensor.height);
    format.fmt.pix.pixelformat = wanted;
    format.fmt.pix.field = V4L2_FIELD_NONE;
    const int result = device_.ioctl(VIDIOC_S_FMT, &format);
    if (result == -EBUSY) return "another program uses it: end that program";
    const v4l2_pix_format& got = format.fmt.pix;
    // The device changes what it does not have.
    if (result < 0 || got.pixelformat != wanted) continue;
    if (got.width != sensor.width || got.height != sensor.height) {
      sizes = fmt::format(" (the camera offers {} x {})", got.width, got.height);
      continue;
    }
    layout_ = {.format = wanted,
               .width = static_cast<int>(got.width),
               .height = static_cast<int>(got.height),
               .stride = wanted == V4L2_PIX_FMT_MJPEG ? 0 : got.bytesperline};
    set_encoding(got, layout_);
    return "";
  }
  return fmt::format(
      "the camera has no format with {} x {} pixels for pixels = \"{}\"{}: set sensor.width and "
      "sensor.height, or format",
      sensor.width, sensor.height, name_of(sensor.pixels), sizes);
}

// A device without this setting has a rate of its own, which the frames' times show.
void V4l2Connection::set_rate() {
  v4l2_streamparm rate{};
  rate.type = capture;
  rate.parm.capture.timeperframe.numerator = 1000;
  rate.parm.capture.timeperframe.denominator =
      static_cast<std::uint32_t>(std::lround(1e3 * camera_.sensor.frame_rate));
  device_.ioctl(VIDIOC_S_PARM, &rate);
}

bool V4l2Connection::has(std::uint32_t id) {
  v4l2_queryctrl query{};
  query.id = id;
  return device_.ioctl(VIDIOC_QUERYCTRL, &query) >= 0 && (query.flags & V4L2_CTRL_FLAG_DISABLED) == 0;
}

std::string V4l2Connection::set_control(std::uint32_t id, std::int32_t value, const char* name) {
  v4l2_control control{};
  control.id = id, control.value = value;
  int result = device_.ioctl(VIDIOC_S_CTRL, &control);
  if (result < 0) return fmt::format("the camera refuses {} = {} ({})", name, value, v4l2_error(result));
  result = device_.ioctl(VIDIOC_G_CTRL, &control);
  if (result >= 0 && control.value != value)
    return fmt::format("the camera set {} instead of {} = {}: set a value that the camera supports",
                       control.value, name, value);
  return "";
}

std::string V4l2Connection::set_light() {
  if (config_.exposure) {
    if (!has(V4L2_CID_EXPOSURE_ABSOLUTE)) return "the camera's exposure cannot be set: remove exposure";
    if (has(V4L2_CID_EXPOSURE_AUTO)) {
      if (auto problem = set_control(V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL, "exposure_auto");
          !problem.empty())
        return problem;
    }
    const auto units =
        static_cast<std::int32_t>(std::max(std::lround(*config_.exposure / exposure_unit), 1L));
    if (auto problem = set_control(V4L2_CID_EXPOSURE_ABSOLUTE, units, "exposure"); !problem.empty())
      return problem;
    exposure_ = units * exposure_unit;
  }
  if (config_.gain) {
    if (!has(V4L2_CID_GAIN)) return "the camera's gain cannot be set: remove gain";
    if (has(V4L2_CID_AUTOGAIN)) {
      if (auto problem = set_control(V4L2_CID_AUTOGAIN, 0, "gain_automatic"); !problem.empty())
        return problem;
    }
    return set_control(V4L2_CID_GAIN, static_cast<std::int32_t>(*config_.gain), "gain");
  }
  return "";
}

ConnectionEnd V4l2Connection::watch(Buffers& buffers) {
  double last = steady_seconds();
  while (!feed_.is_over()) {
    device_.wait(0.05);
    v4l2_buffer buffer{};
    const int result = buffers.take(buffer);
    if (result == 0) {
      const auto before = feed_.put_count();
      take(buffer, buffers.bytes(buffer));
      if (feed_.put_count() != before) last = steady_seconds();
      if (const int given = buffers.give(buffer.index); given < 0) return loss(v4l2_error(given));
    } else if (result != -EAGAIN) {
      return loss(v4l2_error(result) + ": check its cable and its power");
    }
    if (steady_seconds() - last > config_.silence)
      return loss(fmt::format("no frame for {:.3g} s: check its cable and its USB port", config_.silence));
  }
  return loss("closed");
}

void V4l2Connection::take(const v4l2_buffer& buffer, std::span<const std::uint8_t> bytes) {
  // The sequence numbers count damaged frames as lost.
  if ((buffer.flags & V4L2_BUF_FLAG_ERROR) != 0) return;
  auto picture = v4l2_picture(bytes, layout_, camera_.sensor.channels());
  if (!picture) return;
  feed_.put({.picture = std::move(*picture),
             .time = time_of(buffer),
             .exposure = exposure_,
             .lost = gaps_.lost_before(buffer.sequence)});
}

double V4l2Connection::time_of(const v4l2_buffer& buffer) const {
  const double stamp =
      static_cast<double>(buffer.timestamp.tv_sec) + 1e-6 * static_cast<double>(buffer.timestamp.tv_usec);
  const bool is_start = (buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  return is_start ? stamp + exposure_ / 2 : stamp - exposure_ / 2;
}

}  // namespace

Outcome<std::unique_ptr<CountedCamera>> open_v4l2_camera(const V4l2Config& config, const CameraConfig& camera,
                                                         const ClockPort& clock,
                                                         const std::shared_ptr<V4l2Calls>& calls) {
  if (camera.sensor.bits != 8) {
    return PortFault{FaultKind::refused, camera_prefix(camera.name) +
                                             "pictures of a video device have 8 bits: set sensor.bits = 8"};
  }
  return std::unique_ptr<CountedCamera>(std::make_unique<CameraFeed>(
      camera.name, camera.sensor.frame_rate, clock,
      [config, camera, calls](CameraFeed& feed) {
        return V4l2Connection(feed, config, camera, *calls).run();
      },
      CameraPatience{.longest_pause = config.longest_pause}));
}

}  // namespace flexura
