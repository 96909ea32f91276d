#pragma once

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include "flexura/base/descriptor.h"

namespace flexura {

/// A video device of the kernel, opened by a test next to the driver under test.
class VideoDevice {
 public:
  /// Finds the first video device that gives pictures and whose kernel driver has this name. Throws
  /// std::runtime_error if there is none.
  explicit VideoDevice(const std::string& driver) {
    const auto found = find(driver);
    if (!found) throw std::runtime_error("no video device of the kernel driver " + driver);
    path_ = *found;
  }

  /// Returns the path of such a device, or std::nullopt.
  [[nodiscard]] static std::optional<std::string> find(const std::string& driver) {
    for (int i = 0; i < 10; ++i) {
      const std::string path = "/dev/video" + std::to_string(i);
      const Descriptor device(::open(path.c_str(), O_RDWR | O_CLOEXEC));
      v4l2_capability capability{};
      if (device && ::ioctl(device.get(), VIDIOC_QUERYCAP, &capability) == 0 &&
          reinterpret_cast<const char*>(capability.driver) == driver &&
          (capability.device_caps & V4L2_CAP_VIDEO_CAPTURE) != 0)
        return path;
    }
    return std::nullopt;
  }

  [[nodiscard]] const std::string& path() const { return path_; }

  /// Sets a control, or presses a button, by its name. Throws std::runtime_error if that fails.
  void set(const std::string& name, std::int32_t value = 1) const {
    const Descriptor device = open();
    v4l2_control control{};
    control.id = id_of(device.get(), name), control.value = value;
    if (::ioctl(device.get(), VIDIOC_S_CTRL, &control) != 0) throw std::runtime_error("cannot set " + name);
  }
  /// Returns the value of a control.
  [[nodiscard]] std::int32_t value(const std::string& name) const {
    const Descriptor device = open();
    v4l2_control control{};
    control.id = id_of(device.get(), name);
    if (::ioctl(device.get(), VIDIOC_G_CTRL, &control) != 0) throw std::runtime_error("cannot read " + name);
    return control.value;
  }

 private:
  [[nodiscard]] Descriptor open() const { return Descriptor(::open(path_.c_str(), O_RDWR | O_CLOEXEC)); }
  static std::uint32_t id_of(int device, const std::string& name) {
    v4l2_queryctrl query{};
    query.id = V4L2_CTRL_FLAG_NEXT_CTRL;
    while (::ioctl(device, VIDIOC_QUERYCTRL, &query) == 0) {
      if (reinterpret_cast<const char*>(query.name) == name) return query.id;
      query.id |= V4L2_CTRL_FLAG_NEXT_CTRL;
    }
    throw std::runtime_error("the device has no control " + name);
  }

  std::string path_;
};

}  // namespace flexura
