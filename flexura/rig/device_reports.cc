#include "flexura/rig/device_reports.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <optional>

#include "flexura/base/degree.h"
#include "flexura/base/one_line.h"
#include "flexura/equipment/device_access.h"
#include "flexura/rig/camera_sources.h"
#include "flexura/rig/rig_devices.h"

namespace flexura {
namespace {

// Text of numbers, one per axis; of equal numbers, one.
std::string numbers_text(const std::vector<double>& numbers, std::string_view unit) {
  std::vector<std::string> all;
  all.reserve(numbers.size());
  for (const double number : numbers) all.push_back(fmt::format("{:.6g}", number));
  if (std::ranges::adjacent_find(all, std::ranges::not_equal_to()) == all.end() && !all.empty())
    all.resize(1);
  return fmt::format("{} {}", fmt::join(all, ", "), unit);
}

std::string motors_text(std::size_t first, std::size_t count) {
  return count == 1 ? fmt::format("motor {}", first + 1)
                    : fmt::format("motors {} to {}", first + 1, first + count);
}

// Runs `ask`, and puts what it throws into the report.
template <class Ask>
void ask_device(DeviceReport& report, const Ask& ask) {
  try {
    ask();
  } catch (const std::exception& error) {
    report.problem = one_line(error.what());
  }
}

void ask_controller(DeviceReport& report, const GrblConfig& config, RealDevices& devices) {
  GrblDrive drive(devices.open(config).value(), devices.clock(), config);
  (void)drive.connect().value();
  const GrblIdentity identity = drive.identity();
  const GrblStatus status = drive.status().value();
  const auto add = [&](const char* name, std::string value) {
    report.facts.emplace_back(name, std::move(value));
  };
  add("firmware", identity.firmware.empty() ? "unknown" : "Grbl " + identity.firmware);
  add("axes", config.axes);
  add("state", std::string(text(status.state)));
  add("highest speed", numbers_text(identity.rates, "microsteps/s"));
  add("acceleration", numbers_text(identity.accelerations, "microsteps/s^2"));
  add("travel", identity.has_soft_limits ? numbers_text(identity.travel, "microsteps") : "not limited ($20)");
  add("homing", identity.has_homing ? "yes" : "no ($22)");
  add("position", fmt::format("{:.3f} mm of the controller", fmt::join(status.positions, ", ")));
  if (status.state == GrblState::alarm)
    report.problem = "the controller is in alarm: clear its cause, then home it or unlock it ($X)";
}

void ask_bus(DeviceReport& report, const Cia402Config& config, RealDevices& devices) {
  const std::unique_ptr<Link> link = devices.open(config).value();
  Cia402Drive drive(*link, devices.clock(), config);
  (void)drive.start().value();
  const auto identities = drive.identities();
  const DriveReading reading = drive.read().value();
  for (std::size_t i = 0; i < identities.size(); ++i) {
    const Cia402Identity& one = identities[i];
    const Cia402AxisConfig& axis = config.axes[i];
    report.facts.emplace_back(
        fmt::format("node {}", axis.node),
        fmt::format("{} (vendor {:X}h, product {:X}h) at {:.0f} microsteps, limits {:.6g} to {:.6g}",
                    one.name.empty() ? "drive" : one_line(one.name), one.vendor, one.product,
                    reading.values.at(i), axis.limits[0], axis.limits[1]));
    for (const std::string& note : one.notes) report.facts.emplace_back("note", one_line(note));
  }
}

void ask_head(DeviceReport& report, const CameraEquipment& camera, RealDevices& devices, ViscaBuses& buses) {
  std::string about;
  const auto head = open_head(camera, devices, buses, &about);
  const HeadState state = head->read().value().state;
  if (!about.empty()) report.facts.emplace_back("version", about);
  report.facts.emplace_back("position", fmt::format("pan {:.2f} deg, tilt {:.2f} deg, zoom {:.6g}",
                                                    state.pan / degree, state.tilt / degree, state.zoom));
  if (!camera.visca) return;
  const ViscaConfig& config = *camera.visca;
  constexpr double far = 1e9;  // Beyond all limits.
  const HeadState low = visca_state(config, visca_counts(config, {-far, -far, -far}));
  const HeadState high = visca_state(config, visca_counts(config, {far, far, far}));
  report.facts.emplace_back(
      "limits", fmt::format("pan {:.1f} to {:.1f} deg, tilt {:.1f} to {:.1f} deg, zoom {:.6g} to {:.6g}",
                            low.pan / degree, high.pan / degree, low.tilt / degree, high.tilt / degree,
                            low.zoom, high.zoom));
}

void ask_camera(DeviceReport& report, const CameraEquipment& equipment, const CameraConfig& camera,
                WallClock& clock, double camera_time, double patience) {
  const std::unique_ptr<CountedCamera> source = open_camera_source(equipment, camera, clock);
  std::optional<Frame> first;
  std::optional<PortFault> fault;
  for (const double end = clock.now() + patience; !first && clock.now() < end;) {
    constexpr double slice = 0.25;  // s
    const auto taken = source->wait(slice);
    fault = taken.fault();
    if (taken) first = taken.value();
    if (fault) clock.wait_until(clock.now() + 0.1 * slice);
  }
  if (!first) {
    report.problem =
        fault ? one_line(text(*fault)) : fmt::format("no picture arrived within {:g} s", patience);
    return;
  }
  const CameraCounts before = source->counts();
  const double begin = clock.now();
  clock.wait_until(begin + camera_time);
  const CameraCounts after = source->counts();
  const double rate = static_cast<double>(after.frames - before.frames) / (clock.now() - begin);
  report.facts.emplace_back("pictures",
                            fmt::format("{} x {} pixels, {}", camera.sensor.width, camera.sensor.height,
                                        camera.sensor.channels() == 1 ? "gray" : "color"));
  report.facts.emplace_back(
      "rate", fmt::format("{:.1f} Hz (file: {:g} Hz), {} lost", rate, camera.sensor.frame_rate, after.lost));
}

// Driver and address of a head; "" without one.
std::pair<std::string, std::string> head_text(const CameraEquipment& equipment) {
  if (equipment.visca) return {"VISCA", equipment.visca->bus.link};
  if (equipment.onvif) return {"ONVIF", equipment.onvif->link};
  if (equipment.v4l2_head) return {"USB head", equipment.v4l2_head->device};
  return {};
}

}  // namespace

std::vector<DeviceReport> report_devices(const Setup& setup, double camera_time, double patience) {
  const RigEquipment& equipment = setup.equipment.value();
  std::vector<DeviceReport> reports;
  RealDevices devices;
  std::size_t first = 0;
  if (const auto& bus = equipment.cia402) {
    DeviceReport& report = reports.emplace_back(
        DeviceReport{.name = motors_text(0, bus->axes.size()), .driver = "CiA 402", .place = bus->link});
    ask_device(report, [&] { ask_bus(report, *bus, devices); });
  }
  for (const GrblConfig& config : equipment.grbl) {
    DeviceReport& report = reports.emplace_back(
        DeviceReport{.name = motors_text(first, config.axes.size()), .driver = "Grbl", .place = config.link});
    first += config.axes.size();
    ask_device(report, [&] { ask_controller(report, config, devices); });
  }
  ViscaBuses buses;
  for (const CameraConfig& camera : setup.cameras()) {
    const auto found = std::ranges::find(equipment.camera, camera.name, &CameraEquipment::name);
    if (found == equipment.camera.end()) continue;
    const auto [driver, place] = camera_source_text(*found);
    DeviceReport& report = reports.emplace_back(
        DeviceReport{.name = camera.name + ": pictures", .driver = driver, .place = place});
    ask_device(report, [&] { ask_camera(report, *found, camera, devices.clock(), camera_time, patience); });
    const auto [head_driver, head_place] = head_text(*found);
    if (head_driver.empty()) continue;
    DeviceReport& head = reports.emplace_back(
        DeviceReport{.name = camera.name + ": head", .driver = head_driver, .place = head_place});
    ask_device(head, [&] { ask_head(head, *found, devices, buses); });
  }
  return reports;
}

}  // namespace flexura
