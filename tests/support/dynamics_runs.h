#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/experiment/dynamics_run.h"
#include "flexura/experiment/results.h"
#include "flexura/experiment/results_log.h"
#include "flexura/experiment/run.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "tests/support/quiet.h"
#include "tests/support/temporary_folder.h"

namespace flexura {

/// Runs of experiments with tasks of dynamics, and what is in their results.
class Dynamics : public testing::Test {
 protected:
  RunResult run(const std::string& text, const std::vector<std::string>& sets = {}) {
    Quiet quiet;
    return run_experiment(parse_experiment(text, "x.toml", {sets, {}}),
                          make_new_folder(folder_.path() / "results"), quiet);
  }
  static const Node& dynamics(const RunResult& result, std::size_t i = 0) {
    return result.summary.find("dynamics")->as<Node::Array>()->at(i);
  }
  static double number(const Node& node, const char* key) { return *node.find(key)->as<double>(); }
  static bool truth(const Node& node, const char* key) { return *node.find(key)->as<bool>(); }
  template <class M>
  static std::vector<M> logged(const RunResult& result, std::string_view topic) {
    std::vector<M> found;
    const McapReader log = open_log(result.folder);
    for (const McapMessage& message : log.messages())
      if (message.channel->topic == topic) found.push_back(read_as<M>(parse_json(message.text(), "the log")));
    return found;
  }
  static std::vector<DynamicsSampleMessage> samples(const RunResult& result) {
    return logged<DynamicsSampleMessage>(result, dynamics_samples_topic);
  }
  static std::map<std::string, std::string> files_in(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
      if (entry.is_regular_file())
        files[entry.path().lexically_relative(folder)] = read_text_file(entry.path(), std::size_t{1} << 30);
    return files;
  }
  TemporaryFolder folder_;
};

}  // namespace flexura
