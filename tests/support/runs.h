#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/experiment/run.h"
#include "flexura/log/messages.h"
#include "flexura/log/results.h"
#include "flexura/log/results_log.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "tests/support/quiet.h"
#include "tests/support/temporary_folder.h"

namespace flexura {

/// Runs experiments, each in a new folder inside a temporary one.
class Runs {
 public:
  RunResult run(const Experiment& experiment, RunWatcher* watcher = nullptr) {
    Quiet quiet;
    return run_experiment(experiment, make_new_folder(folder_.path() / "results"), quiet, watcher);
  }
  RunResult run(const std::string& text, const std::vector<std::string>& sets = {}) {
    return run(parse_experiment(text, "x.toml", {sets, {}}));
  }

 protected:
  TemporaryFolder folder_;
};

/// Returns the messages of one topic of a run's log, in order.
template <class M>
std::vector<M> logged(const RunResult& result, std::string_view topic) {
  std::vector<M> found;
  const McapReader log = open_log(result.folder);
  for (const McapMessage& message : log.messages())
    if (message.channel->topic == topic) found.push_back(read_as<M>(parse_json(message.text(), "the log")));
  return found;
}

/// Returns the number of messages of each topic of a run's log.
inline std::map<std::string, std::size_t> logged_counts(const RunResult& result) {
  std::map<std::string, std::size_t> counts;
  const McapReader log = open_log(result.folder);
  for (const McapMessage& message : log.messages()) ++counts[message.channel->topic];
  return counts;
}

/// Returns the content of a file of a run's results.
inline std::string text_of(const RunResult& result, const std::filesystem::path& file) {
  return read_text_file(result.folder / file, std::size_t{1} << 30);
}

/// Returns the contents of all files of a folder, by file name.
inline std::map<std::string, std::string> files_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[entry.path().lexically_relative(folder)] = read_text_file(entry.path(), std::size_t{1} << 30);
  return files;
}

/// Returns entry i of a list of a run's summary, for example "servos" or "calibrations".
inline const Node& entry_of(const RunResult& result, const char* list, std::size_t i = 0) {
  return result.summary.find(list)->as<Node::Array>()->at(i);
}

}  // namespace flexura
