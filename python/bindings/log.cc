#include <fmt/format.h>

#include <memory>

#include "flexura/base/table.h"
#include "flexura/log/messages.h"
#include "flexura/log/results.h"
#include "flexura/store/json.h"
#include "flexura/store/mcap_reader.h"
#include "python/bindings/convert.h"
#include "python/bindings/module.h"
#include "python/bindings/paths.h"

namespace flexura::python {
namespace {

struct Log {
  explicit Log(const std::filesystem::path& path) : name(path.string()), reader(path) {}

  // Returns the messages of a topic. Throws py::key_error for a topic that the log lacks.
  [[nodiscard]] std::vector<const McapMessage*> of(const std::string& topic) const {
    bool is_known = false;
    for (const auto& [id, channel] : reader.channels()) is_known = is_known || channel.topic == topic;
    if (!is_known) throw py::key_error(fmt::format("{}: has no topic {}", name, topic));
    std::vector<const McapMessage*> found;
    for (const McapMessage& message : reader.messages())
      if (message.channel->topic == topic) found.push_back(&message);
    return found;
  }

  std::string name;
  McapReader reader;
};

double seconds(const McapMessage& message) { return static_cast<double>(message.log_time) * 1e-9; }

std::shared_ptr<Log> open(const py::object& given) {
  std::filesystem::path path = path_of(given);
  if (std::filesystem::is_directory(path)) path /= log_file_name;
  const py::gil_scoped_release released;
  return std::make_shared<Log>(path);
}

py::dict topics(const Log& log) {
  std::map<std::string, int> counts;
  for (const auto& [id, channel] : log.reader.channels()) counts[channel.topic];
  for (const McapMessage& message : log.reader.messages()) ++counts[message.channel->topic];
  return py::cast(counts);
}

py::list messages(const Log& log, const std::string& topic) {
  py::list list;
  for (const McapMessage* message : log.of(topic)) {
    const std::string text = message->text();
    if (message->channel->encoding == "json") {
      list.append(py::make_tuple(seconds(*message), python_value(parse_json(text, log.name))));
    } else {
      list.append(py::make_tuple(seconds(*message), py::bytes(text)));
    }
  }
  return list;
}

// The logged states of the arm.
py::tuple states(const Log& log) {
  const std::vector<const McapMessage*> found = log.of("/arm/state");
  std::vector<ArmStateMessage> read(found.size());
  {
    const py::gil_scoped_release released;
    for (std::size_t i = 0; i < found.size(); ++i)
      read[i] = read_as<ArmStateMessage>(parse_json(found[i]->text(), log.name));
  }
  const std::size_t sections = read.empty() ? 0 : read.front().bends.size();
  py::array_t<double> times(static_cast<py::ssize_t>(read.size()));
  py::array_t<double> array(
      Sizes{static_cast<py::ssize_t>(read.size()), static_cast<py::ssize_t>(sections), 3});
  double *time = times.mutable_data(), *to = array.mutable_data();
  for (const ArmStateMessage& message : read) {
    if (message.bends.size() != sections || message.stretches.size() != sections)
      throw py::value_error(fmt::format("{}: /arm/state: the number of sections changes", log.name));
    *time++ = message.time;
    for (std::size_t i = 0; i < sections; ++i) {
      *to++ = message.bends[i][0];
      *to++ = message.bends[i][1];
      *to++ = message.stretches[i];
    }
  }
  return py::make_tuple(times, array);
}

}  // namespace

void bind_log(py::module_& module) {
  using py::arg;
  py::class_<Log, std::shared_ptr<Log>>(module, "Log", "The log of a run (log.mcap).")
      .def(py::init(&open), arg("path"),
           "Reads a log, given by its path or its run's folder. Raises OSError or RuntimeError for a file "
           "that is not a\n"
           "log or is damaged.")
      .def_property_readonly("topics", &topics, "Topics and their numbers of messages, a dict.")
      .def_property_readonly(
          "truncated", [](const Log& log) { return log.reader.truncated(); },
          "Whether the program that wrote the log was interrupted.")
      .def("messages", &messages, arg("topic"),
           "Returns the messages of a topic in the file's order: a list of (time in s, dict). Messages that "
           "are not JSON,\n"
           "such as pictures, are bytes. Raises KeyError for a missing topic.")
      .def("states", &states, "Returns the times (N,), s, and the states (N, sections, 3) of the arm.")
      .def("__repr__", [](const Log& log) {
        return fmt::format("<flexura.Log: {}, {} messages>", log.name, log.reader.messages().size());
      });
}

}  // namespace flexura::python
