#pragma once

#include <gtest/gtest.h>

#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "flexura/experiment/experiment.h"
#include "flexura/store/json.h"
#include "flexura/view/background.h"
#include "flexura/view/messenger.h"
#include "flexura/view/state_message.h"
#include "flexura/view/viewed_rig.h"

namespace flexura {

inline constexpr ClientId me = 1, other = 2;

/// Records the messages for clients.
class FakeMessenger : public Messenger {
 public:
  void send(ClientId client, std::string text) override { texts[client].push_back(std::move(text)); }
  void post(ClientId client, std::uint32_t stream, std::shared_ptr<const std::string> message) override {
    posts[{client, stream}].push_back(std::move(message));
  }

  /// Returns the newest text of this type for a client; empty if there is none.
  [[nodiscard]] Node last(ClientId client, std::string_view type) {
    Node found;
    for (const std::string& text : texts[client]) {
      Node node = parse_json(text, "text");
      const Node* kind = node.find("type");
      if (kind != nullptr && *kind->as<std::string>() == type) found = std::move(node);
    }
    return found;
  }
  [[nodiscard]] std::size_t count(ClientId client, std::uint32_t stream) {
    return posts[{client, stream}].size();
  }
  /// Returns the newest state sent to a client.
  [[nodiscard]] StateMessage state(ClientId client) {
    const auto& states = posts[{client, 0}];
    if (states.empty()) return ADD_FAILURE() << "no state", StateMessage{};
    return read_state_message(*states.back()).value();
  }

  std::map<ClientId, std::vector<std::string>> texts;
  std::map<std::pair<ClientId, std::uint32_t>, std::vector<std::shared_ptr<const std::string>>> posts;
};

/// Runs jobs on request, or at once if is_prompt.
class FakeBackground : public Background {
 public:
  void run(Lane lane, Job job) override {
    ++jobs[lane];
    waiting_.push_back(std::move(job));
    if (is_prompt) work();
  }
  void work() {
    while (!waiting_.empty()) {
      const Job job = std::move(waiting_.front());
      waiting_.pop_front();
      if (const After after = job()) after();
    }
  }

  bool is_prompt = true;
  std::map<Lane, int> jobs;  ///< Number of jobs by lane.

 private:
  std::deque<Job> waiting_;
};

/// An arm of two sections, two small cameras, and a ball beside the arm.
inline const std::string viewed_text = R"(
title = "Two sections"
[arm]
kind = "spatial"
[[arm.section]]
length = 0.5
max_bend = 2
[[arm.section]]
length = 0.5
max_bend = 2
max_bend_rate = 1
[[obstacle]]
kind = "sphere"
name = "ball"
center = [0.5, 0.5, 0]
radius = 0.1
[[camera]]
name = "front"
mount = { position = [0, 0.5, 2], look_at = [0, 0.5, 0] }
head = { pan = { limits = [-0.5, 0.5] } }
lens = { fx = 80, fy = 80, cx = 31.5, cy = 23.5 }
sensor = { width = 64, height = 48, frame_rate = 30 }
[[camera]]
name = "side"
mount = { position = [-2, 0.5, 0], look_at = [0, 0.5, 0] }
lens = { fx = 80, fy = 80, cx = 31.5, cy = 23.5 }
sensor = { width = 64, height = 48, frame_rate = 30, bits = 12, pixels = "color", exposure_ms = 10 }
[[task]]
kind = "move"
name = "bend"
duration = 1
to = { bends = [[0.8, 0.5], [-0.4, 0.7]] }
)";

inline ViewedRigPtr viewed_rig(const std::string& text = viewed_text) {
  return std::make_shared<const ViewedRig>(parse_experiment(text, "x.toml"));
}

}  // namespace flexura
