#include "flexura/view/state_message.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace flexura {
namespace {

constexpr std::uint8_t state_kind = 1, image_kind = 2;
constexpr std::uint8_t moving_flag = 1, running_flag = 2, recording_flag = 4, unsafe_flag = 8,
                       weightless_flag = 16, energy_flag = 32, push_flag = 64, pace_flag = 128;

// Writes little-endian numbers to a string.
class Writer {
 public:
  template <std::unsigned_integral T>
  void put(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i)
      text_ += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xff);
  }
  void put(double value) { put(std::bit_cast<std::uint64_t>(value)); }
  void single(double value) { put(std::bit_cast<std::uint32_t>(static_cast<float>(value))); }
  void pose(const Pose& X) {
    for (const double p : X.position) single(p);
    const Eigen::Vector4d q = quaternion_wxyz(X.rotation);
    for (const double part : q) single(part);
  }
  void count(std::size_t value) {
    if (value > std::numeric_limits<std::uint16_t>::max())
      throw std::length_error("a state message can have at most 65535 items of each kind");
    put(static_cast<std::uint16_t>(value));
  }
  void reserve(std::size_t size) { text_.reserve(size); }
  std::string text() && { return std::move(text_); }
  std::string& bytes() { return text_; }

 private:
  std::string text_;
};

// Reads little-endian numbers from a string whose length was checked before.
class BytesReader {
 public:
  explicit BytesReader(std::string_view bytes) : rest_(bytes) {}
  template <std::unsigned_integral T>
  T take() {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i)
      value |= static_cast<std::uint64_t>(static_cast<unsigned char>(rest_[i])) << (8 * i);
    rest_.remove_prefix(sizeof(T));
    return static_cast<T>(value);
  }
  double number() { return std::bit_cast<double>(take<std::uint64_t>()); }
  double single() { return std::bit_cast<float>(take<std::uint32_t>()); }
  Pose pose() {
    Pose X;
    for (double& p : X.position) p = single();
    Eigen::Vector4d q;
    for (double& part : q) part = single();
    X.rotation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
    return X;
  }
  [[nodiscard]] std::size_t size() const { return rest_.size(); }

 private:
  std::string_view rest_;
};

std::uint8_t flags_of(const StateMessage& state) {
  return static_cast<std::uint8_t>(
      (state.is_moving ? moving_flag : 0) | (state.is_running ? running_flag : 0) |
      (state.is_recording ? recording_flag : 0) | (state.is_unsafe ? unsafe_flag : 0) |
      (state.is_weightless ? weightless_flag : 0) | (state.energy ? energy_flag : 0) |
      (state.push ? push_flag : 0) | (state.pace ? pace_flag : 0));
}

void put_camera(const CameraSample& camera, Writer& out) {
  out.pose(camera.X_WC);
  for (const double value :
       {camera.head.pan, camera.head.tilt, camera.head.zoom, camera.stage.x(), camera.stage.y(),
        camera.stage.z(), camera.fx, camera.fy, camera.cx, camera.cy, camera.commanded_head.pan,
        camera.commanded_head.tilt, camera.commanded_head.zoom, camera.commanded_stage.x(),
        camera.commanded_stage.y(), camera.commanded_stage.z()})
    out.single(value);
}

CameraSample take_camera(BytesReader& in) {
  CameraSample camera;
  camera.X_WC = in.pose();
  for (double* value :
       {&camera.head.pan, &camera.head.tilt, &camera.head.zoom, &camera.stage.x(), &camera.stage.y(),
        &camera.stage.z(), &camera.fx, &camera.fy, &camera.cx, &camera.cy, &camera.commanded_head.pan,
        &camera.commanded_head.tilt, &camera.commanded_head.zoom, &camera.commanded_stage.x(),
        &camera.commanded_stage.y(), &camera.commanded_stage.z()})
    *value = in.single();
  return camera;
}

constexpr std::size_t head_size = 28;

std::size_t body_size(std::size_t sections, std::size_t samples, std::size_t cameras, std::size_t tendons,
                      std::size_t actuators) {
  return 4 * (3 * sections + 8 * samples + 23 * cameras + tendons + 3 * actuators);
}

// Returns the size of the fields announced by `flags`.
std::size_t forces_size(std::uint8_t flags, std::size_t contacts) {
  const auto if_flag = [flags](std::uint8_t flag, std::size_t numbers) {
    return (flags & flag) != 0 ? numbers : 0;
  };
  return 4 * (if_flag(energy_flag, 3) + if_flag(push_flag, 7) + if_flag(pace_flag, 1) + 10 * contacts);
}

void put_forces(const StateMessage& state, Writer& out) {
  const auto vector = [&out](const Eigen::Vector3d& p) {
    for (const double x : p) out.single(x);
  };
  if (state.energy)
    out.single(state.energy->kinetic), out.single(state.energy->strain), out.single(state.energy->gravity);
  if (state.push) out.single(state.push->s), vector(state.push->to), vector(state.push->force);
  if (state.pace) out.single(*state.pace);
  for (const ContactSample& contact : state.contacts) {
    out.single(contact.obstacle), out.single(contact.s);
    vector(contact.point), vector(contact.force);
    out.single(contact.normal_force), out.single(static_cast<double>(contact.slip));
  }
}

void take_forces(std::uint8_t flags, std::size_t contacts, BytesReader& in, StateMessage& state) {
  const auto vector = [&in] {
    Eigen::Vector3d p;
    for (double& x : p) x = in.single();
    return p;
  };
  if ((flags & energy_flag) != 0) {
    RodEnergy& energy = state.energy.emplace();
    energy.kinetic = in.single(), energy.strain = in.single(), energy.gravity = in.single();
  }
  if ((flags & push_flag) != 0) {
    PushSample& push = state.push.emplace();
    push.s = in.single(), push.to = vector(), push.force = vector();
  }
  if ((flags & pace_flag) != 0) state.pace = in.single();
  for (std::size_t i = 0; i < contacts; ++i) {
    ContactSample& contact = state.contacts.emplace_back();
    contact.obstacle = static_cast<int>(std::clamp(in.single(), -1.0, 65535.0));
    contact.s = in.single(), contact.point = vector(), contact.force = vector();
    contact.normal_force = in.single();
    contact.slip = static_cast<ContactSample::Slip>(std::clamp(in.single(), 0.0, 2.0));
  }
}

}  // namespace

std::vector<ArmSample> arm_samples(const Backbone& backbone) {
  return arm_samples(backbone.arcs(), backbone.tip());
}

std::vector<ArmSample> arm_samples(std::span<const Arc> arcs, const Pose& tip) {
  constexpr double largest_turn = std::numbers::pi / 2, most = 64;
  std::vector<ArmSample> samples;
  for (const Arc& arc : arcs) {
    const auto pieces =
        static_cast<int>(std::clamp(std::ceil(arc.bend.norm() / largest_turn - 1e-9), 1.0, most));
    for (int piece = 0; piece < pieces; ++piece) {
      const double part = static_cast<double>(piece) / pieces;
      samples.push_back(
          {arc.s_rest + part * arc.rest_length, piece == 0 ? arc.X_WS : arc.pose(part * arc.length)});
    }
  }
  if (!arcs.empty()) samples.push_back({arcs.back().s_rest + arcs.back().rest_length, tip});
  return samples;
}

std::string state_message(const StateMessage& state) {
  Writer out;
  const std::size_t sections = state.arm.bends.size();
  out.reserve(head_size +
              body_size(sections, state.samples.size(), state.cameras.size(), state.displacements.size(),
                        state.actuators.size()) +
              forces_size(flags_of(state), state.contacts.size()));
  out.put(state_kind);
  out.put(flags_of(state));
  out.count(sections);
  out.count(state.samples.size());
  out.count(state.cameras.size());
  out.count(state.displacements.size());
  out.put(state.leaps);
  out.put(state.sequence);
  out.put(state.time);
  out.count(state.actuators.size());
  out.count(state.contacts.size());
  for (const Eigen::Vector2d& bend : state.arm.bends) out.single(bend.x()), out.single(bend.y());
  for (const double stretch : state.arm.stretches) out.single(stretch);
  for (const ArmSample& sample : state.samples) out.single(sample.s), out.pose(sample.X_WS);
  for (const CameraSample& camera : state.cameras) put_camera(camera, out);
  for (const double displacement : state.displacements) out.single(displacement);
  for (const ActuatorSample& each : state.actuators)
    out.single(each.value), out.single(each.force), out.single(each.lost);
  put_forces(state, out);
  return std::move(out).text();
}

std::optional<StateMessage> read_state_message(std::string_view bytes) {
  BytesReader in(bytes);
  if (in.size() < head_size || in.take<std::uint8_t>() != state_kind) return std::nullopt;
  StateMessage state;
  const auto flags = in.take<std::uint8_t>();
  state.is_moving = (flags & moving_flag) != 0;
  state.is_running = (flags & running_flag) != 0;
  state.is_recording = (flags & recording_flag) != 0;
  state.is_unsafe = (flags & unsafe_flag) != 0;
  state.is_weightless = (flags & weightless_flag) != 0;
  std::array<std::uint16_t, 4> counts{};
  for (std::uint16_t& count : counts) count = in.take<std::uint16_t>();
  state.leaps = in.take<std::uint16_t>();
  state.sequence = in.take<std::uint32_t>();
  state.time = in.number();
  const auto actuators = in.take<std::uint16_t>();
  const auto contacts = in.take<std::uint16_t>();
  if (in.size() !=
      body_size(counts[0], counts[1], counts[2], counts[3], actuators) + forces_size(flags, contacts))
    return std::nullopt;
  for (int i = 0; i < counts[0]; ++i) {
    const double x = in.single();
    state.arm.bends.emplace_back(x, in.single());
  }
  for (int i = 0; i < counts[0]; ++i) state.arm.stretches.push_back(in.single());
  for (int i = 0; i < counts[1]; ++i) {
    const double s = in.single();
    state.samples.push_back({s, in.pose()});
  }
  for (int i = 0; i < counts[2]; ++i) state.cameras.push_back(take_camera(in));
  for (int i = 0; i < counts[3]; ++i) state.displacements.push_back(in.single());
  for (int i = 0; i < actuators; ++i) {
    const double value = in.single(), force = in.single();
    state.actuators.push_back({value, force, in.single()});
  }
  take_forces(flags, contacts, in, state);
  return state;
}

std::string image_message(std::uint8_t camera, ImageFormat format, std::uint32_t number, double time,
                          std::string_view file) {
  Writer out;
  out.reserve(16 + file.size());
  out.put(image_kind);
  out.put(camera);
  out.put(static_cast<std::uint16_t>(format));
  out.put(number);
  out.put(time);
  out.bytes().append(file);
  return std::move(out).text();
}

}  // namespace flexura
