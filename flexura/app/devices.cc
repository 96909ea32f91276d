#include "flexura/app/devices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <ostream>
#include <stdexcept>

#include "flexura/app/commands.h"
#include "flexura/app/words.h"
#include "flexura/base/node.h"
#include "flexura/base/one_line.h"
#include "flexura/equipment/found_devices.h"
#include "flexura/equipment/gstreamer_camera.h"
#include "flexura/equipment/link.h"
#include "flexura/equipment/wall_clock.h"
#include "flexura/experiment/experiment.h"
#include "flexura/rig/device_reports.h"
#include "flexura/store/json.h"

namespace flexura {
namespace {

// Rows of text in columns as wide as they need; the last column is not filled up.
class TextTable {
 public:
  void add(std::vector<std::string> row) {
    for (std::string& cell : row) cell = one_line(cell);
    rows_.push_back(std::move(row));
  }
  void print(std::ostream& out) const {
    std::vector<std::size_t> widths;
    for (const auto& row : rows_)
      for (std::size_t i = 0; i + 1 < row.size(); ++i) {
        widths.resize(std::max(widths.size(), i + 1));
        widths[i] = std::max(widths[i], row[i].size());
      }
    for (const auto& row : rows_) {
      std::string line;
      for (std::size_t i = 0; i < row.size(); ++i)
        line += i + 1 < row.size() ? fmt::format("{:<{}}  ", row[i], widths[i]) : row[i];
      line.erase(line.find_last_not_of(' ') + 1);
      out << line << '\n';
    }
  }

 private:
  std::vector<std::vector<std::string>> rows_;
};

Node found_node(const FoundDevice& device) {
  return {Node::Table{{"kind", {}, text_node(device.kind)},
                      {"place", {}, text_node(device.place)},
                      {"about", {}, text_node(device.about)}},
          {}};
}

int list_found(const DevicesArguments& arguments, std::ostream& out) {
  std::vector<FoundDevice> found = found_serial_lines();
  std::vector<std::string> probes;
  for (const std::string& probe : arguments.probes) {
    if (probe != "all") {
      probes.push_back(probe);
      continue;
    }
    for (const FoundDevice& line : found) probes.push_back(line.place);
  }
  WallClock clock;
  for (const std::string& probe : probes) {
    const std::string answer = probe_link(probe, clock);
    const auto line = std::ranges::find(found, probe, &FoundDevice::place);
    if (line == found.end()) {
      found.push_back({"link", probe, answer});
    } else {
      line->about = line->about.empty() ? answer : answer + "; " + line->about;
    }
  }
  for (const auto& more : {found_can_interfaces(), found_video_devices(), found_vision_cameras()})
    found.insert(found.end(), more.begin(), more.end());
  const std::vector<MissingDriver> missing = missing_drivers();
  if (arguments.json) {
    Node::Array devices, lacking;
    for (const FoundDevice& one : found) devices.push_back(found_node(one));
    for (const MissingDriver& one : missing)
      lacking.push_back(
          {Node::Table{{"driver", {}, text_node(one.driver)}, {"packages", {}, text_node(one.packages)}},
           {}});
    out << write_json({Node::Table{{"found", {}, {std::move(devices), {}}},
                                   {"missing_drivers", {}, {std::move(lacking), {}}}},
                       {}},
                      2)
        << '\n';
    return exit_done;
  }
  if (found.empty()) out << "no USB serial line, video device, network camera or CAN interface was found\n";
  TextTable table;
  for (const FoundDevice& one : found) table.add({one.place, one.kind, one.about});
  table.print(out);
  if (has_gstreamer()) print_line(out, "driver", "gstreamer: network cameras (RTSP), files and test sources");
  for (const MissingDriver& one : missing)
    print_line(out, "missing driver",
               fmt::format("{}: install {} and build again", one.driver, one.packages));
  return exit_done;
}

Node report_node(const DeviceReport& report) {
  Node::Table facts;
  for (const auto& [name, value] : report.facts) facts.push_back({name, {}, text_node(value)});
  return {Node::Table{{"name", {}, text_node(report.name)},
                      {"driver", {}, text_node(report.driver)},
                      {"place", {}, text_node(report.place)},
                      {"usable", {}, {report.problem.empty(), {}}},
                      {"problem", {}, text_node(report.problem)},
                      {"facts", {}, {std::move(facts), {}}}},
          {}};
}

int check_devices(const DevicesArguments& arguments, std::ostream& out, std::ostream& err) {
  const Experiment experiment = load_experiment(arguments.experiment, {arguments.sets, {}});
  if (!experiment.equipment)
    throw input_error(arguments.experiment,
                      "this file has no devices, because its rig is simulated: expected a table [rig]", 1, 1);
  const std::vector<DeviceReport> reports = report_devices(experiment);
  const auto failed =
      std::ranges::count_if(reports, [](const DeviceReport& report) { return !report.problem.empty(); });
  if (arguments.json) {
    Node::Array devices;
    for (const DeviceReport& report : reports) devices.push_back(report_node(report));
    out << write_json({Node::Table{{"devices", {}, {std::move(devices), {}}}}, {}}, 2) << '\n';
  } else {
    for (const DeviceReport& report : reports) {
      TextTable table;
      out << fmt::format("{}: {} at {}\n", one_line(report.name), report.driver, one_line(report.place));
      for (const auto& [name, value] : report.facts) table.add({"  " + name, value});
      table.print(out);
      if (!report.problem.empty()) out << "  cannot be used: " << one_line(report.problem) << '\n';
    }
  }
  const std::string all = fmt::format("{} of {} devices can be used",
                                      reports.size() - static_cast<std::size_t>(failed), reports.size());
  print_line(arguments.json ? err : out, "devices", all);
  return failed == 0 ? exit_done : exit_system_failure;
}

}  // namespace

int devices_command(const DevicesArguments& arguments, std::ostream& out, std::ostream& err) {
  for (const std::string& probe : arguments.probes) {
    if (probe == "all") continue;
    try {
      if (parse_link_address(probe).kind == LinkAddress::Kind::can)
        throw std::invalid_argument(
            "a CAN bus cannot be probed: write its drives into the table [rig] of a file");
    } catch (const std::invalid_argument& error) {
      throw input_error("--probe", error.what());
    }
  }
  return arguments.experiment.empty() ? list_found(arguments, out) : check_devices(arguments, out, err);
}

}  // namespace flexura
