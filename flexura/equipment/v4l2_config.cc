#include "flexura/base/table.h"
#include "flexura/equipment/v4l2_camera.h"
#include "flexura/equipment/v4l2_head.h"

namespace flexura {

const std::vector<std::string>& names_of(const V4l2Format*) {
  static const std::vector<std::string> names = {"automatic", "grey", "yuyv", "rgb", "mjpeg"};
  return names;
}

const Table<V4l2Config>& fields_of(const V4l2Config*) {
  static const auto table =
      Table<V4l2Config>("v4l2",
                        "Pictures from a camera of the kernel's video interface, such as a USB camera.")
          .field("device", &V4l2Config::device,
                 {.meaning = "Path of the device. Paths under `/dev/v4l/by-id` do not change."})
          .field("format", &V4l2Config::format,
                 {.meaning = "Pixel format; `automatic`: the first format of the camera that fits the "
                             "sensor's `pixels`."})
          .field("exposure", &V4l2Config::exposure,
                 {.meaning = "Exposure time, in steps of 0.1 ms.",
                  .unit = Unit::second,
                  .range = above_up_to(0, 1e3),
                  .default_text = "as set in the camera"})
          .field("gain", &V4l2Config::gain,
                 {.meaning = "Gain in the camera's unit.", .default_text = "as set in the camera"})
          .field("silence", &V4l2Config::silence,
                 {.meaning = "Time without a frame after which the program reopens the device.",
                  .unit = Unit::second,
                  .range = between(0.1, 600)})
          .field("longest_pause", &V4l2Config::longest_pause,
                 {.meaning = "Longest pause before the program reopens the device.",
                  .unit = Unit::second,
                  .range = between(0.1, 600)});
  return table;
}

const Table<V4l2HeadConfig>& fields_of(const V4l2HeadConfig*) {
  static const auto table =
      Table<V4l2HeadConfig>("v4l2_head", "Pan, tilt and zoom of a camera of the kernel's video interface.")
          .field("device", &V4l2HeadConfig::device, {.meaning = "Path of the device."})
          .field("zoom_step", &V4l2HeadConfig::zoom_step,
                 {.meaning = "Change of the zoom position per unit of the device's zoom control.",
                  .range = above(0)})
          .field("patience", &V4l2HeadConfig::patience,
                 {.meaning = "Longest time for which an axis may fail to approach its target after a "
                             "command. After this time, the head reports a fault.",
                  .unit = Unit::second,
                  .range = between(0.01, 60)});
  return table;
}

}  // namespace flexura
