#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "flexura/tasks/dynamics/dynamics_messages.h"
#include "flexura/tasks/dynamics/dynamics_run.h"
#include "tests/support/runs.h"

namespace flexura {

/// Runs experiments with dynamics tasks and reads their results.
class Dynamics : public testing::Test, public Runs {
 protected:
  static const Node& dynamics(const RunResult& result, std::size_t i = 0) {
    return entry_of(result, "dynamics", i);
  }
  static double number(const Node& node, const char* key) { return *node.find(key)->as<double>(); }
  static bool truth(const Node& node, const char* key) { return *node.find(key)->as<bool>(); }
  static std::vector<DynamicsSampleMessage> samples(const RunResult& result) {
    return logged<DynamicsSampleMessage>(result, dynamics_samples_topic);
  }
};

}  // namespace flexura
