#include "flexura/equipment/rig_equipment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>

#include "flexura/base/reader.h"
#include "flexura/base/table.h"
#include "flexura/equipment/link.h"

namespace flexura {

const std::vector<std::string>& names_of(const StartPositions*) {
  static const std::vector<std::string> names = {"declared", "homed", "pretensioned"};
  return names;
}

const Table<CameraEquipment>& fields_of(const CameraEquipment*) {
  static const auto table =
      Table<CameraEquipment>("camera", "Devices of one camera: one source of pictures and at most one head.")
          .field("name", &CameraEquipment::name, {.meaning = "Name of the camera.", .required = true})
          .field("gstreamer", &CameraEquipment::gstreamer,
                 {.meaning = "Pictures from a GStreamer pipeline, for example from a network camera.",
                  .default_text = "none"})
          .field("aravis", &CameraEquipment::aravis,
                 {.meaning = "Pictures from a GigE Vision or USB3 Vision camera.", .default_text = "none"})
          .field("v4l2", &CameraEquipment::v4l2,
                 {.meaning = "Pictures from a USB camera.", .default_text = "none"})
          .field("visca", &CameraEquipment::visca,
                 {.meaning = "Pan/tilt/zoom head that is moved by VISCA commands.", .default_text = "none"})
          .field("onvif", &CameraEquipment::onvif,
                 {.meaning = "Head of an ONVIF network camera.", .default_text = "none"})
          .field("v4l2_head", &CameraEquipment::v4l2_head,
                 {.meaning = "Pan, tilt and zoom of a USB camera.", .default_text = "none"})
          .check([](const CameraEquipment& config, Reader& reader) {
            const int sources = (config.gstreamer ? 1 : 0) + (config.aravis ? 1 : 0) + (config.v4l2 ? 1 : 0);
            if (sources != 1)
              reader.problem_at(
                  "",
                  fmt::format("{} sources of pictures: expected one of gstreamer, aravis, v4l2", sources));
            const int heads = (config.visca ? 1 : 0) + (config.onvif ? 1 : 0) + (config.v4l2_head ? 1 : 0);
            if (heads > 1)
              reader.problem_at(
                  "", fmt::format("{} heads: expected one of visca, onvif, v4l2_head, or none", heads));
          });
  return table;
}

const Table<RigEquipment>& fields_of(const RigEquipment*) {
  constexpr std::size_t most_controllers = 16, most_cameras = 16, most_axes = 64;
  static const auto table =
      Table<RigEquipment>("rig", "Real equipment that executes the experiment, in place of the simulation.")
          .field("watchdog", &RigEquipment::watchdog,
                 {.meaning = "Longest time without a sign of life of the program while the arm moves. After "
                             "this time a second process stops all devices.",
                  .unit = Unit::second,
                  .range = between(0.05, 10)})
          .field(
              "start", &RigEquipment::start,
              {.meaning = "How the program determines the motor positions. `declared`: it assumes that the "
                          "arm has its initial shape. `homed`: the axes move to their limit switches, then "
                          "slowly to the initial shape. `pretensioned`: as `homed`, but tight tendons are "
                          "let out first, so that finally all tendons are pulled in together."})
          .field("home", &RigEquipment::home,
                 {.meaning = "Motor positions at the limit switches, microsteps, one per axis.",
                  .count = {0, most_axes},
                  .default_text = "none"})
          .field(
              "pretension_speed", &RigEquipment::pretension_speed,
              {.meaning = "Largest speed of a tendon on its way from the limit switch to the initial shape.",
               .unit = Unit::metre_per_second,
               .range = above_up_to(0, 0.1)})
          .field("grbl", &RigEquipment::grbl,
                 {.meaning = "Motion controllers with Grbl or grblHAL, in the order of their axes.",
                  .count = {0, most_controllers},
                  .default_text = "none"})
          .field("cia402", &RigEquipment::cia402,
                 {.meaning = "CANopen drives, one per axis.", .default_text = "none"})
          .field("camera", &RigEquipment::camera,
                 {.meaning = "Devices of the cameras.", .count = {0, most_cameras}, .default_text = "none"});
  return table;
}

namespace {

void check_controllers(const RigEquipment& equipment, std::size_t axes, Reader& reader) {
  if (equipment.cia402 && !equipment.grbl.empty()) {
    reader.problem_at("rig.cia402", "drives of two kinds: expected cia402 or grbl");
    return;
  }
  if (axes == 0) {
    reader.problem_at("rig", "the arm has no drive to run: expected a table [drive]");
    return;
  }
  std::size_t there = equipment.cia402 ? equipment.cia402->axes.size() : 0;
  for (const GrblConfig& one : equipment.grbl) there += one.axes.size();
  if (there != axes)
    reader.problem_at(
        equipment.cia402 ? "rig.cia402" : "rig",
        fmt::format("{} axes of controllers: expected {}, one per tendon of the drive", there, axes));
  const bool is_homed = equipment.start != StartPositions::declared;
  if (is_homed && !equipment.cia402 && equipment.home.size() != axes)
    reader.problem_at("rig.home",
                      fmt::format("{} positions: expected {}, one per axis", equipment.home.size(), axes));
  if (!is_homed && !equipment.home.empty())
    reader.problem_at("rig.home", "not used: expected start = \"homed\" or \"pretensioned\"");
}

void check_names(const RigEquipment& equipment, const std::vector<std::string>& cameras, Reader& reader) {
  for (std::size_t i = 0; i < equipment.camera.size(); ++i) {
    const std::string& name = equipment.camera[i].name;
    const std::string path = fmt::format("rig.camera[{}].name", i);
    if (std::ranges::find(cameras, name) == cameras.end())
      reader.problem_at(path, fmt::format("\"{}\" is no camera of the experiment: expected {}", name,
                                          fmt::join(cameras, ", ")));
    for (std::size_t k = 0; k < i; ++k)
      if (equipment.camera[k].name == name)
        reader.problem_at(path, fmt::format("\"{}\" has devices already", name));
  }
  for (const std::string& name : cameras)
    if (std::ranges::find(equipment.camera, name, &CameraEquipment::name) == equipment.camera.end())
      reader.problem_at("rig.camera", fmt::format("no devices for the camera \"{}\"", name));
}

// Returns the part of an address that identifies the link: the speed of a serial line does not matter.
std::string place_of_link(const std::string& link) {
  try {
    const LinkAddress address = parse_link_address(link);
    return address.kind == LinkAddress::Kind::serial ? address.place : text(address);
  } catch (const std::invalid_argument&) {
    return link;  // Reported elsewhere.
  }
}

// A device belongs to one driver. Only heads of a chain share a link.
void check_links(const RigEquipment& equipment, Reader& reader) {
  struct Used {
    std::string path, link;
    std::int64_t address = 0;  // Place in a chain; 0: none.
  };
  std::vector<Used> used;
  const auto use = [&](const Used& one) {
    for (const Used& other : used) {
      if (place_of_link(other.link) != place_of_link(one.link)) continue;
      if (one.address == 0 || other.address == 0) {
        reader.problem_at(one.path,
                          fmt::format("\"{}\" is used by {}: expected another device", one.link, other.path));
        break;
      }
      if (one.address == other.address) {
        reader.problem_at(one.path.substr(0, one.path.rfind(".bus")) + ".address",
                          fmt::format("{} is the address of another head on the same link", one.address));
        break;
      }
    }
    used.push_back(one);
  };
  for (std::size_t i = 0; i < equipment.grbl.size(); ++i)
    use({fmt::format("rig.grbl[{}].link", i), equipment.grbl[i].link});
  for (std::size_t i = 0; i < equipment.camera.size(); ++i)
    if (const auto& head = equipment.camera[i].visca)
      use({fmt::format("rig.camera[{}].visca.bus.link", i), head->bus.link, head->address});
  for (std::size_t i = 0; i < equipment.camera.size(); ++i)
    if (const auto& video = equipment.camera[i].v4l2)
      use({fmt::format("rig.camera[{}].v4l2.device", i), video->device});
}

}  // namespace

void check_equipment(const RigEquipment& equipment, const std::vector<std::string>& cameras, std::size_t axes,
                     Reader& reader) {
  check_controllers(equipment, axes, reader);
  check_names(equipment, cameras, reader);
  check_links(equipment, reader);
}

}  // namespace flexura
