#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "flexura/equipment/v4l2_calls.h"

namespace flexura {

/// A control of a simulated video device.
struct FakeControl {
  std::int32_t min = 0, max = 0, step = 1;
  std::int32_t value = 0;   ///< Value that the device reports.
  std::int32_t target = 0;  ///< Commanded value.
  std::int32_t rate = 0;    ///< Change per reading towards the target; 0: at once.
  bool is_stuck = false;    ///< Whether the device accepts values without effect.
};

/// A simulated video device that replaces the system calls. V4l2Fake takes one picture at every wait for a
/// frame. A clock is not needed, because the time stamp of a picture is its sequence number times the frame
/// period. All functions may be called from several threads.
class V4l2Fake : public V4l2Calls {
 public:
  /// Makes a device "video0" in any folder, with one pixel format (V4L2_PIX_FMT_...) and one image size, px.
  V4l2Fake(std::uint32_t format, int width, int height);

  int open(const std::string& path) override;
  void close(int device) override;
  int ioctl(int device, unsigned long request, void* argument) override;
  void* map(int device, std::size_t length, std::size_t offset) override;
  void unmap(void* memory, std::size_t length) override;
  int wait(int device, double timeout) override;

  /// Sets the bytes of each picture; default: all 0.
  void set_picture(std::vector<std::uint8_t> bytes);
  /// Makes the next `count` pictures lost (not delivered) or damaged (delivered with an error flag).
  void lose(std::uint32_t count);
  void damage(std::uint32_t count);
  /// Disconnects the device (false) or connects it again (true).
  void set_plugged(bool is_plugged);
  /// While `is_silent` is true, the device delivers no pictures.
  void set_silent(bool is_silent);
  /// Adds or replaces the control with the number `id` (V4L2_CID_...).
  void set_control(std::uint32_t id, const FakeControl& control);
  [[nodiscard]] FakeControl control(std::uint32_t id);
  /// Returns the number of open devices and mapped buffers.
  [[nodiscard]] std::size_t held();

 private:
  int set_format(void* argument) const;
  int query_control(void* argument);
  int get_control(void* argument);
  int put_control(void* argument);
  int buffers(unsigned long request, void* argument);
  int take_buffer(void* argument);

  std::mutex mutex_;
  std::uint32_t format_;
  int width_, height_;
  std::vector<std::uint8_t> picture_;
  std::vector<std::vector<std::uint8_t>> memory_;
  std::vector<std::uint32_t> empty_;  // Buffers that the device may fill, in order.
  std::map<std::uint32_t, FakeControl> controls_;
  bool is_plugged_ = true, is_streaming_ = false, is_silent_ = false, is_waiting_ = false;
  std::uint32_t sequence_ = 0, lost_ = 0, damaged_ = 0;
  std::size_t open_ = 0, mapped_ = 0;
};

}  // namespace flexura
