#include "flexura/equipment/found_devices.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "flexura/base/one_line.h"
#include "flexura/equipment/aravis_camera.h"
#include "flexura/equipment/grbl_codec.h"
#include "flexura/equipment/gstreamer_camera.h"
#include "flexura/equipment/link.h"
#include "flexura/equipment/visca_bus.h"

namespace flexura {
namespace {

namespace fs = std::filesystem;

// Names in a folder, sorted by their first letters, then by their numbers; empty if it cannot be read.
std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code none;
  for (fs::directory_iterator one(folder, none), end; !none && one != end; one.increment(none))
    names.push_back(one->path().filename().string());
  std::ranges::sort(names, [](const std::string& a, const std::string& b) {
    return a.size() != b.size() && a.substr(0, 4) == b.substr(0, 4) ? a.size() < b.size() : a < b;
  });
  return names;
}

std::string first_line(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return one_line(line.substr(0, 200));
}

// Stable names under serial/by-id, by the names of the devices.
std::map<std::string, std::string> stable_names(const fs::path& folder) {
  std::map<std::string, std::string> names;
  for (const std::string& name : names_in(folder)) {
    std::error_code none;
    const fs::path target = fs::read_symlink(folder / name, none);
    if (!none) names[target.filename().string()] = (folder / name).string();
  }
  return names;
}

std::string format_name(std::uint32_t format) {
  std::string name;
  for (int i = 0; i < 4; ++i) name += static_cast<char>(format >> (8 * i) & 0x7F);
  return one_line(name);
}

// Sizes of a format: "640 x 480, 1280 x 720", or a range.
std::string sizes_of(V4l2Device& device, std::uint32_t format) {
  constexpr std::uint32_t most = 8;
  std::vector<std::string> sizes;
  for (std::uint32_t i = 0; i <= most; ++i) {
    v4l2_frmsizeenum size{};
    size.index = i, size.pixel_format = format;
    if (device.ioctl(VIDIOC_ENUM_FRAMESIZES, &size) < 0) break;
    if (i == most) {
      sizes.emplace_back("...");
      break;
    }
    if (size.type != V4L2_FRMSIZE_TYPE_DISCRETE) {
      sizes.push_back(fmt::format("{} x {} to {} x {}", size.stepwise.min_width, size.stepwise.min_height,
                                  size.stepwise.max_width, size.stepwise.max_height));
      break;
    }
    sizes.push_back(fmt::format("{} x {}", size.discrete.width, size.discrete.height));
  }
  return fmt::format("{}", fmt::join(sizes, ", "));
}

std::optional<std::string> about_video(V4l2Device& device) {
  if (device.problem() < 0) return v4l2_error(device.problem()) + ": check the user's group (video)";
  v4l2_capability capability{};
  if (device.ioctl(VIDIOC_QUERYCAP, &capability) < 0) return std::nullopt;
  const bool has_own = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0;
  if (((has_own ? capability.device_caps : capability.capabilities) & V4L2_CAP_VIDEO_CAPTURE) == 0)
    return std::nullopt;
  const auto* const card = reinterpret_cast<const char*>(capability.card);
  std::string about = one_line(std::string_view(card, strnlen(card, sizeof capability.card)));
  constexpr std::uint32_t most_formats = 16;
  for (std::uint32_t i = 0; i < most_formats; ++i) {
    v4l2_fmtdesc format{};
    format.index = i, format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (device.ioctl(VIDIOC_ENUM_FMT, &format) < 0) break;
    const std::string sizes = sizes_of(device, format.pixelformat);
    about += fmt::format("{}{}{}{}", about.empty() ? "" : "; ", format_name(format.pixelformat),
                         sizes.empty() ? "" : " ", sizes);
  }
  return about;
}

// The version in what a Grbl controller has said, or std::nullopt.
std::optional<std::string> grbl_version(const std::string& heard) {
  GrblLines lines;
  std::string name, version;
  for (const std::string& line : lines.add(heard)) {
    const GrblMessage message = parse_grbl(line);
    if (const auto* const banner = std::get_if<GrblBanner>(&message)) name = one_line(banner->name);
    const auto* const said = std::get_if<GrblFeedback>(&message);
    if (said != nullptr && said->type == "VER") version = one_line(said->text);
  }
  while (version.ends_with(':')) version.pop_back();
  if (name.empty() && version.empty()) return std::nullopt;
  return name.empty() ? "Grbl " + version : fmt::format("{}{}{}", name, version.empty() ? "" : ", ", version);
}

// Listens until nothing more comes for `quiet` s, for at most `longest` s.
std::string listen(Link& link, ClockPort& clock, double quiet, double longest) {
  constexpr std::size_t most = 8192;
  std::string heard;
  const double end = clock.now() + longest;
  while (clock.now() < end && heard.size() < most) {
    const auto bytes = link.read(std::min(quiet, std::max(0.0, end - clock.now())));
    if (!bytes) break;
    if (bytes.value().empty()) break;
    heard += bytes.value();
  }
  return heard;
}

struct ProbeAnswer {
  std::string what;  // "" if nothing that is known answers.
  std::string problem;
};

ProbeAnswer probe_grbl(const LinkAddress& address, ClockPort& clock) {
  auto opened = open_link(address);
  if (!opened) return {{}, opened.fault()->what};
  Link& link = *opened.value();
  // A board that restarts when its line is opened is silent for up to 2 s, then greets.
  constexpr double start_time = 2.5, quiet = 0.5;
  std::string heard = listen(link, clock, start_time, 2 * start_time);
  if (!link.write("\n$I\n")) return {};
  heard += listen(link, clock, quiet, start_time);
  if (const auto version = grbl_version(heard)) return {*version, {}};
  return {{}, heard.empty() ? "nothing answers" : "something answers that is not Grbl"};
}

ProbeAnswer probe_visca(const std::string& link, ClockPort& clock) {
  ViscaBusConfig config;
  config.link = link;
  config.set_addresses = false;
  config.tries = 2;
  const auto bus = open_visca_bus(config, [&clock] { return clock.now(); });
  if (!bus) return {{}, bus.fault()->what};
  constexpr std::size_t version_size = 7;
  const auto answer = bus.value()->inquire(1, visca_ask_version(), version_size);
  const auto version = answer ? parse_visca_version(answer.value().data) : std::nullopt;
  if (!version) return {{}, "no VISCA head answers"};
  return {fmt::format("VISCA head: vendor {:04X}h, model {:04X}h", version->vendor, version->model), {}};
}

}  // namespace

std::vector<FoundDevice> found_serial_lines(const DeviceFolders& folders) {
  const auto stable = stable_names(folders.devices / "serial" / "by-id");
  std::vector<FoundDevice> found;
  for (const std::string& name : names_in(folders.devices)) {
    const bool is_line = std::ranges::any_of(std::array{"ttyUSB", "ttyACM", "ttyAMA"},
                                             [&](const char* begin) { return name.starts_with(begin); });
    if (!is_line) continue;
    const auto known = stable.find(name);
    found.push_back({"serial line", (folders.devices / name).string(),
                     known == stable.end() ? "" : "also " + one_line(known->second)});
  }
  return found;
}

std::vector<FoundDevice> found_can_interfaces(const DeviceFolders& folders) {
  constexpr std::string_view can_type = "280";  // ARPHRD_CAN
  const fs::path net = folders.system / "class" / "net";
  std::vector<FoundDevice> found;
  for (const std::string& name : names_in(net)) {
    if (first_line(net / name / "type") != can_type) continue;
    const std::string flags = first_line(net / name / "flags");
    unsigned bits = 0;
    const std::string_view digits = std::string_view(flags).substr(std::min<std::size_t>(2, flags.size()));
    (void)std::from_chars(digits.data(), digits.data() + digits.size(), bits, 16);
    const bool is_up = (bits & 1U) != 0;
    found.push_back(
        {"CAN interface", "can:" + name,
         is_up ? "up"
               : fmt::format("down; switch it on by: ip link set {} up type can bitrate 500000", name)});
  }
  return found;
}

std::vector<FoundDevice> found_video_devices(const DeviceFolders& folders,
                                             const std::shared_ptr<V4l2Calls>& calls) {
  std::vector<FoundDevice> found;
  for (const std::string& name : names_in(folders.devices)) {
    if (!name.starts_with("video")) continue;
    const std::string path = (folders.devices / name).string();
    V4l2Device device(*calls, path);
    if (auto about = about_video(device)) found.push_back({"video device", path, std::move(*about)});
  }
  return found;
}

std::vector<FoundDevice> found_vision_cameras() {
  std::vector<FoundDevice> found;
  for (const std::string& name : aravis_cameras()) found.push_back({"GigE or USB3 camera", name, ""});
  return found;
}

std::vector<MissingDriver> missing_drivers() {
  std::vector<MissingDriver> missing;
  if (!has_gstreamer())
    missing.push_back({"gstreamer", "libgstreamer1.0-dev libgstreamer-plugins-base1.0-dev"});
  if (!has_aravis()) missing.push_back({"aravis", "libaravis-dev libusb-1.0-0-dev"});
  return missing;
}

std::string probe_link(const std::string& address, ClockPort& clock) {
  const LinkAddress parsed = parse_link_address(address);
  if (parsed.kind == LinkAddress::Kind::can)
    throw std::invalid_argument(
        "a CAN bus cannot be probed: write its drives into the table [rig] of a file");
  const bool is_serial = parsed.kind == LinkAddress::Kind::serial;
  std::string problem;
  if (parsed.kind != LinkAddress::Kind::udp) {
    const ProbeAnswer answer = probe_grbl(parsed, clock);
    if (!answer.what.empty()) return answer.what;
    problem = answer.problem;
  }
  // VISCA heads have 9600 bits/s unless they are set otherwise.
  const bool has_speed = address.find('@') != std::string::npos;
  const ProbeAnswer answer = probe_visca(is_serial && !has_speed ? address + "@9600" : address, clock);
  if (!answer.what.empty()) return answer.what;
  return problem.empty() || problem == "nothing answers" ? one_line(answer.problem) : one_line(problem);
}

}  // namespace flexura
