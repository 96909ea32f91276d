#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "flexura/serve/server.h"

namespace flexura {

/// A host that writes down what it is told, and answers what it is asked at once.
class TestHost : public Host {
 public:
  void opened(ClientId client) override { note("opened " + std::to_string(client)); }
  void closed(ClientId client) override { note("closed " + std::to_string(client)); }
  void on_message(ClientId client, std::string text) override {
    note(std::to_string(client) + " said " + text);
  }
  void asked(std::string target, std::function<void(HttpAnswer)> answer) override {
    note("asked " + target);
    answer({.status = 200, .content_type = "text/plain", .body = target, .policy = {}});
  }

  /// Waits until a line has been written; false when that takes more than half a minute.
  bool wait_for(const std::string& line) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(30),
                             [&] { return std::ranges::find(lines_, line) != lines_.end(); });
  }
  std::vector<std::string> lines() {
    const std::lock_guard lock(mutex_);
    return lines_;
  }

 private:
  void note(std::string line) {
    const std::lock_guard lock(mutex_);
    lines_.push_back(std::move(line));
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> lines_;
};

}  // namespace flexura
