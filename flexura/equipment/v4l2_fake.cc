#include "flexura/equipment/v4l2_fake.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <utility>

namespace flexura {
namespace {

constexpr double fake_period = 1.0 / 30;  // s
constexpr int fake_descriptor = 1000;

}  // namespace

V4l2Fake::V4l2Fake(std::uint32_t format, int width, int height)
    : format_(format),
      width_(width),
      height_(height),
      picture_(std::size_t(width) * std::size_t(height) * 3) {}

int V4l2Fake::open(const std::string& path) {
  const std::scoped_lock lock(mutex_);
  if (!path.ends_with("/video0") || !is_plugged_) return -ENOENT;
  ++open_;
  return fake_descriptor;
}

void V4l2Fake::close(int /*device*/) {
  const std::scoped_lock lock(mutex_);
  --open_;
}

void* V4l2Fake::map(int /*device*/, std::size_t length, std::size_t offset) {
  const std::scoped_lock lock(mutex_);
  if (offset >= memory_.size() || length != memory_[offset].size()) return nullptr;
  ++mapped_;
  return memory_[offset].data();
}

void V4l2Fake::unmap(void* /*memory*/, std::size_t /*length*/) {
  const std::scoped_lock lock(mutex_);
  --mapped_;
}

int V4l2Fake::wait(int /*device*/, double /*timeout*/) {
  std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const std::scoped_lock lock(mutex_);
  is_waiting_ = is_streaming_ && !is_silent_;
  return is_waiting_ || !is_plugged_ ? 1 : 0;
}

int V4l2Fake::ioctl(int /*device*/, unsigned long request, void* argument) {
  const std::scoped_lock lock(mutex_);
  if (!is_plugged_) return -ENODEV;
  switch (request) {
    case VIDIOC_QUERYCAP:
      static_cast<v4l2_capability*>(argument)->capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
      return 0;
    case VIDIOC_ENUM_FMT: {
      auto& format = *static_cast<v4l2_fmtdesc*>(argument);
      if (format.index > 0) return -EINVAL;
      format.pixelformat = format_;
      return 0;
    }
    case VIDIOC_ENUM_FRAMESIZES: {
      auto& size = *static_cast<v4l2_frmsizeenum*>(argument);
      if (size.index > 0) return -EINVAL;
      size.type = V4L2_FRMSIZE_TYPE_DISCRETE;
      size.discrete = {static_cast<std::uint32_t>(width_), static_cast<std::uint32_t>(height_)};
      return 0;
    }
    case VIDIOC_S_FMT:
      return set_format(argument);
    case VIDIOC_S_PARM:
      return -ENOTTY;
    case VIDIOC_QUERYCTRL:
      return query_control(argument);
    case VIDIOC_G_CTRL:
      return get_control(argument);
    case VIDIOC_S_CTRL:
      return put_control(argument);
    default:
      return buffers(request, argument);
  }
}

int V4l2Fake::set_format(void* argument) const {
  v4l2_pix_format& pix = static_cast<v4l2_format*>(argument)->fmt.pix;
  pix.pixelformat = format_;
  pix.width = static_cast<std::uint32_t>(width_), pix.height = static_cast<std::uint32_t>(height_);
  pix.bytesperline = 0;
  return 0;
}

int V4l2Fake::query_control(void* argument) {
  auto& query = *static_cast<v4l2_queryctrl*>(argument);
  const auto found = controls_.find(query.id);
  if (found == controls_.end()) return -EINVAL;
  query.minimum = found->second.min, query.maximum = found->second.max, query.step = found->second.step;
  return 0;
}

int V4l2Fake::get_control(void* argument) {
  auto& asked = *static_cast<v4l2_control*>(argument);
  const auto found = controls_.find(asked.id);
  if (found == controls_.end()) return -EINVAL;
  FakeControl& control = found->second;
  const std::int32_t left = control.target - control.value;
  if (!control.is_stuck)
    control.value += control.rate == 0 ? left : std::clamp(left, -control.rate, control.rate);
  asked.value = control.value;
  return 0;
}

int V4l2Fake::put_control(void* argument) {
  const auto& told = *static_cast<const v4l2_control*>(argument);
  const auto found = controls_.find(told.id);
  if (found == controls_.end()) return -EINVAL;
  FakeControl& control = found->second;
  control.target = std::clamp(told.value, control.min, control.max);
  return 0;
}

int V4l2Fake::buffers(unsigned long request, void* argument) {
  auto& buffer = *static_cast<v4l2_buffer*>(argument);
  switch (request) {
    case VIDIOC_REQBUFS:
      empty_.clear();
      memory_.assign(static_cast<v4l2_requestbuffers*>(argument)->count,
                     std::vector<std::uint8_t>(picture_.size()));
      return 0;
    case VIDIOC_QUERYBUF:
      buffer.length = static_cast<std::uint32_t>(picture_.size());
      buffer.m.offset = buffer.index;
      return 0;
    case VIDIOC_QBUF:
      empty_.push_back(buffer.index);
      return 0;
    case VIDIOC_STREAMON:
      is_streaming_ = true;
      sequence_ = 0;
      return 0;
    case VIDIOC_STREAMOFF:
      is_streaming_ = false;
      empty_.clear();
      return 0;
    case VIDIOC_DQBUF:
      return take_buffer(argument);
    default:
      return -ENOTTY;
  }
}

int V4l2Fake::take_buffer(void* argument) {
  if (!is_streaming_) return -EINVAL;
  if (!std::exchange(is_waiting_, false) || empty_.empty()) return -EAGAIN;
  sequence_ += std::exchange(lost_, 0);
  auto& buffer = *static_cast<v4l2_buffer*>(argument);
  buffer.index = empty_.front();
  empty_.erase(empty_.begin());
  std::ranges::copy(picture_, memory_[buffer.index].begin());
  buffer.bytesused = static_cast<std::uint32_t>(picture_.size());
  buffer.flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  if (damaged_ > 0) --damaged_, buffer.flags |= V4L2_BUF_FLAG_ERROR;
  const auto micros = static_cast<std::int64_t>(sequence_ * fake_period * 1e6);
  buffer.timestamp.tv_sec = micros / 1000000, buffer.timestamp.tv_usec = micros % 1000000;
  buffer.sequence = sequence_++;
  return 0;
}

void V4l2Fake::set_picture(std::vector<std::uint8_t> bytes) {
  const std::scoped_lock lock(mutex_);
  picture_ = std::move(bytes);
}

void V4l2Fake::lose(std::uint32_t count) {
  const std::scoped_lock lock(mutex_);
  lost_ = count;
}

void V4l2Fake::damage(std::uint32_t count) {
  const std::scoped_lock lock(mutex_);
  damaged_ = count;
}

void V4l2Fake::set_plugged(bool is_plugged) {
  const std::scoped_lock lock(mutex_);
  is_plugged_ = is_plugged;
  if (!is_plugged) is_streaming_ = false;
}

void V4l2Fake::set_silent(bool is_silent) {
  const std::scoped_lock lock(mutex_);
  is_silent_ = is_silent;
}

void V4l2Fake::set_control(std::uint32_t id, const FakeControl& control) {
  const std::scoped_lock lock(mutex_);
  controls_[id] = control;
}

FakeControl V4l2Fake::control(std::uint32_t id) {
  const std::scoped_lock lock(mutex_);
  return controls_.at(id);
}

std::size_t V4l2Fake::held() {
  const std::scoped_lock lock(mutex_);
  return open_ + mapped_;
}

}  // namespace flexura
