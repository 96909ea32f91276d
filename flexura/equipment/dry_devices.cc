#include "flexura/equipment/dry_devices.h"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <utility>

#include "flexura/equipment/cia402_device.h"
#include "flexura/equipment/grbl_codec.h"
#include "flexura/equipment/grbl_device.h"
#include "flexura/equipment/v4l2_fake.h"
#include "flexura/equipment/visca_device.h"

namespace flexura {
namespace {

constexpr double dry_tick = 1e-3;       // s
constexpr double dry_call_time = 2e-4;  // s; time of a write.
constexpr double dry_steps_per_mm = 100;
// mm/min and mm/s^2: above the speeds of any motor, so that the file's durations decide.
constexpr double dry_rate = 60'000, dry_acceleration = 10'000;
constexpr double dry_switch = 2e4;  // Distance of the limit switches, microsteps.
constexpr double travel_time = 4;   // Of a head over its whole range, s.

// One connection to an ONVIF camera.
class DryOnvif : public ServedDevice {
 public:
  explicit DryOnvif(OnvifDevice& camera) : stream_(camera) {}
  std::vector<std::string> receive(std::string_view bytes, double now) override {
    std::ranges::move(stream_.receive(bytes, now), std::back_inserter(waiting_));
    return advance(now);
  }
  std::vector<std::string> advance(double now) override {
    std::vector<std::string> due;
    for (; !waiting_.empty() && waiting_.front().at <= now; waiting_.pop_front())
      due.push_back(std::move(waiting_.front().bytes));
    return due;
  }

 private:
  OnvifStream stream_;
  std::deque<OnvifChunk> waiting_;
};

// A camera that a configuration fits. It moves in the positions of the configuration alone.
OnvifModel onvif_model(const OnvifConfig& config) {
  OnvifModel model;
  const auto range = [](const std::optional<std::array<double, 2>>& limits, const OnvifRange& own) {
    return limits ? OnvifRange{std::min(own.min, (*limits)[0]), std::max(own.max, (*limits)[1])} : own;
  };
  const bool is_degrees = config.space == OnvifPositions::degrees;
  model.pan = range(config.pan.limits, is_degrees ? model.pan_degrees : model.pan);
  model.tilt = range(config.tilt.limits, is_degrees ? model.tilt_degrees : model.tilt);
  if (is_degrees) model.pan_degrees = model.pan, model.tilt_degrees = model.tilt;
  model.reports_degrees = is_degrees;
  model.zoom = {config.zoom.points.front(), config.zoom.points.back()};
  const auto rate = [](const OnvifRange& all) { return (all.max - all.min) / travel_time; };
  model.rates = {rate(model.pan), rate(model.tilt), rate(model.zoom)};
  model.user.clear();
  model.reply_delay = dry_tick;
  return model;
}

}  // namespace

void DryClock::wait_until(double time) { time_ = std::max(time_, time); }

// A link to a simulated device, which moves on while the driver waits.
class DryDevices::Connection : public Link {
 public:
  Connection(DryDevices& owner, std::string name, ServedDevice& device, Reader reader)
      : owner_(owner), name_(std::move(name)), device_(device), reader_(std::move(reader)) {}

  [[nodiscard]] const std::string& name() const override { return name_; }
  CommandOutcome write(std::string_view bytes) override {
    for (const SentText& sent : reader_(bytes)) owner_.report(name_, bytes, sent);
    hear(device_.receive(bytes, owner_.clock_.now()));
    owner_.clock_.wait_until(owner_.clock_.now() + dry_call_time);
    return Accepted{};
  }
  Outcome<std::string> read(double timeout) override {
    DryClock& clock = owner_.clock_;
    const double end = clock.now() + timeout;
    hear(device_.advance(clock.now()));
    while (heard_.empty() && clock.now() < end) {
      clock.wait_until(std::min(end, clock.now() + dry_tick));
      hear(device_.advance(clock.now()));
    }
    if (heard_.empty()) return std::string();
    std::string first = std::move(heard_.front());
    heard_.pop_front();
    return first;
  }

 private:
  void hear(std::vector<std::string> messages) { std::ranges::move(messages, std::back_inserter(heard_)); }
  DryDevices& owner_;
  std::string name_;
  ServedDevice& device_;
  Reader reader_;
  std::deque<std::string> heard_;
};

// System calls of a head, whose device is simulated.
class DryDevices::Calls : public V4l2Calls {
 public:
  Calls(DryDevices& owner, std::string path)
      : owner_(owner), path_(std::move(path)), fake_(V4L2_PIX_FMT_GREY, 16, 16) {}
  void add(std::uint32_t id, const FakeControl& control) { fake_.set_control(id, control); }
  int open(const std::string& /*path*/) override { return fake_.open("/dev/video0"); }
  void close(int device) override { fake_.close(device); }
  int ioctl(int device, unsigned long request, void* argument) override {
    if (request == VIDIOC_S_CTRL) {
      const auto& control = *static_cast<const v4l2_control*>(argument);
      owner_.report(path_, "", {fmt::format("{} = {}", name_of_control(control.id), control.value)});
    }
    return fake_.ioctl(device, request, argument);
  }
  void* map(int device, std::size_t length, std::size_t offset) override {
    return fake_.map(device, length, offset);
  }
  void unmap(void* memory, std::size_t length) override { fake_.unmap(memory, length); }
  int wait(int device, double timeout) override { return fake_.wait(device, timeout); }

 private:
  static std::string name_of_control(std::uint32_t id) {
    if (id == V4L2_CID_PAN_ABSOLUTE) return "pan_absolute";
    if (id == V4L2_CID_TILT_ABSOLUTE) return "tilt_absolute";
    return id == V4L2_CID_ZOOM_ABSOLUTE ? "zoom_absolute" : fmt::format("control 0x{:X}", id);
  }
  DryDevices& owner_;
  std::string path_;
  V4l2Fake fake_;
};

DryDevices::DryDevices(const RigEquipment& equipment, std::vector<double> motors,
                       std::vector<HeadState> heads, TakeDryMessage take)
    : equipment_(equipment), motors_(std::move(motors)), heads_(std::move(heads)), take_(std::move(take)) {}

DryDevices::~DryDevices() = default;

std::unique_ptr<Link> DryDevices::connect(const std::string& address, std::unique_ptr<ServedDevice> device,
                                          Reader reader) {
  devices_.push_back(std::move(device));
  return std::make_unique<Connection>(*this, address, *devices_.back(), std::move(reader));
}

Outcome<std::unique_ptr<Link>> DryDevices::open(const GrblConfig& config) {
  constexpr std::size_t fewest = 3;
  const std::size_t last = grbl::axis_letters.find(config.axes.back());
  GrblDeviceConfig board;
  board.axes = std::max(fewest, last + 1);
  board.is_grblhal = board.axes > fewest;
  for (int i = 0; i < static_cast<int>(board.axes); ++i) {
    board.settings[100 + i] = dry_steps_per_mm;
    board.settings[110 + i] = dry_rate;
    board.settings[120 + i] = dry_acceleration;
  }
  if (equipment_.start != StartPositions::declared) {
    board.settings[22] = 1, board.settings[24] = dry_rate / 100, board.settings[25] = dry_rate / 10;
    board.low.assign(board.axes, -dry_switch), board.high.assign(board.axes, dry_switch);
    for (int i = 0; i < static_cast<int>(board.axes); ++i)
      board.settings[130 + i] = 2 * dry_switch / dry_steps_per_mm;
  }
  return connect(config.link, std::make_unique<GrblDevice>(std::move(board)), grbl_sent);
}

Outcome<std::unique_ptr<Link>> DryDevices::open(const Cia402Config& config) {
  std::vector<Cia402NodeConfig> nodes;
  for (std::size_t i = 0; i < config.axes.size(); ++i) {
    const Cia402AxisConfig& axis = config.axes[i];
    const double start = i < motors_.size() ? motors_[i] * axis.position_unit : 0;
    nodes.push_back({.node = static_cast<std::uint8_t>(axis.node), .position = start, .home_switch = start});
  }
  return connect(config.link, std::make_unique<Cia402Device>(nodes),
                 [](std::string_view bytes) { return std::vector{can_sent(bytes)}; });
}

Outcome<std::unique_ptr<Link>> DryDevices::open(const ViscaBusConfig& config) {
  const ViscaFraming framing = visca_framing(config);
  auto chain = std::make_unique<ViscaDevice>(framing);
  ViscaDigits digits;
  // The heads of the chain in the order of their addresses; those that no camera names are there, too.
  for (std::int64_t address = 1; address <= 7; ++address) {
    ViscaHeadModel model;
    model.reply_delay = dry_tick;
    ViscaCounts start;
    bool is_named = false, is_last = true;
    for (std::size_t i = 0; i < equipment_.camera.size(); ++i) {
      const auto& head = equipment_.camera[i].visca;
      if (!head || head->bus.link != config.link) continue;
      is_last = is_last && head->address <= address;
      if (head->address != address) continue;
      is_named = true;
      digits = model.digits = visca_digits(*head);
      model.lowest = {head->pan.limits[0], head->tilt.limits[0], head->zoom.counts.front()};
      model.highest = {head->pan.limits[1], head->tilt.limits[1], head->zoom.counts.back()};
      start = visca_counts(*head, i < heads_.size() ? heads_[i] : HeadState{});
    }
    const ViscaCounts &low = model.lowest, &high = model.highest;
    const auto rate = [](std::int64_t from, std::int64_t to) {
      return std::max(1.0, static_cast<double>(to - from) / travel_time);
    };
    chain->add(model,
               std::make_unique<SteadyViscaMotors>(
                   std::array{rate(low.pan, high.pan), rate(low.tilt, high.tilt), rate(low.zoom, high.zoom)},
                   is_named ? start : ViscaCounts{}));
    if (is_last) break;
  }
  return connect(config.link, std::move(chain), [framing, digits](std::string_view bytes) {
    return std::vector{visca_sent(bytes, framing, digits)};
  });
}

Outcome<std::unique_ptr<Link>> DryDevices::open(const OnvifConfig& config) {
  std::unique_ptr<OnvifDevice>& camera = onvif_[config.link];
  if (!camera) {
    camera = std::make_unique<OnvifDevice>(onvif_model(config));
    HeadState start;
    for (std::size_t i = 0; i < equipment_.camera.size() && i < heads_.size(); ++i)
      if (equipment_.camera[i].onvif && equipment_.camera[i].onvif->link == config.link) start = heads_[i];
    const OnvifModel& model = camera->model();
    camera->put(onvif_place(config, {model.pan, model.tilt, true}, start));
  }
  return connect(config.link, std::make_unique<DryOnvif>(*camera),
                 [](std::string_view bytes) { return std::vector{onvif_sent(bytes)}; });
}

std::shared_ptr<V4l2Calls> DryDevices::calls(const V4l2HeadConfig& config) {
  auto made = std::make_shared<Calls>(*this, config.device);
  HeadState start;
  for (std::size_t i = 0; i < equipment_.camera.size(); ++i)
    if (equipment_.camera[i].v4l2_head && equipment_.camera[i].v4l2_head->device == config.device &&
        i < heads_.size())
      start = heads_[i];
  constexpr double second_of_arc = std::numbers::pi / (180 * 3600);
  constexpr std::int32_t half_turn = 180 * 3600, most_zoom = 1'000'000;
  const auto control = [](double value, std::int32_t low, std::int32_t high) {
    const auto at = static_cast<std::int32_t>(std::clamp(std::round(value), double(low), double(high)));
    return FakeControl{.min = low, .max = high, .value = at, .target = at};
  };
  made->add(V4L2_CID_PAN_ABSOLUTE, control(-start.pan / second_of_arc, -half_turn, half_turn));
  made->add(V4L2_CID_TILT_ABSOLUTE, control(start.tilt / second_of_arc, -half_turn, half_turn));
  made->add(V4L2_CID_ZOOM_ABSOLUTE, control(start.zoom / config.zoom_step, 0, most_zoom));
  return made;
}

std::vector<std::string> DryDevices::assumptions() const {
  std::vector<std::string> all;
  if (!equipment_.grbl.empty())
    all.push_back(fmt::format(
        "Grbl controllers are assumed to have {:g} steps/mm and no speed limits; with your controllers, the "
        "numbers after X, Y, Z and F depend on $100, $110 and $120",
        dry_steps_per_mm));
  if (equipment_.cia402)
    all.emplace_back("CANopen drives are assumed to be at the positions of the arm's initial shape");
  const auto has_head = [](const CameraEquipment& one) { return one.visca || one.onvif || one.v4l2_head; };
  if (std::ranges::any_of(equipment_.camera, has_head))
    all.emplace_back("heads are assumed to be at the cameras' initial positions");
  if (std::ranges::any_of(equipment_.camera,
                          [](const CameraEquipment& one) { return one.onvif.has_value(); }))
    all.emplace_back("requests to ONVIF heads are shown without login and media profile");
  return all;
}

}  // namespace flexura
