#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "flexura/serve/server.h"
#include "flexura/view/messenger.h"
#include "flexura/view/viewer.h"
#include "flexura/view/workers.h"

namespace flexura {

/// Stands between a server and a viewer: takes what the server's thread brings, never waits, and hands it to
/// the viewer on a thread of its own, which lets its time go on 60 times a second while someone looks. What
/// fails there is told to those whom it concerns, and ends nothing.
class FrontDoor : public Host {
 public:
  struct Config {
    std::function<double()> clock;          ///< s, never falls; from any thread.
    double interval = 1.0 / 60;             ///< Of the viewer's time, s.
    std::size_t waiting_of_a_client = 256;  ///< Requests without an answer; more are refused.
    std::size_t waiting_documents = 64;
  };

  explicit FrontDoor(Config config);
  ~FrontDoor() override;

  /// Opens: once, before or after the server brings the first client. `messenger` must stay until stop().
  /// Throws what keeps the viewer from being made.
  void start(ViewStart start, Messenger& messenger);
  /// Closes: from then on nothing goes to the messenger. Waits for the jobs under way; a run is cancelled.
  void stop();

  void opened(ClientId client) override;
  void closed(ClientId client) override;
  void on_message(ClientId client, std::string text) override;
  void asked(std::string target, std::function<void(HttpAnswer)> answer) override;

 private:
  struct Item {
    std::function<void(Viewer&)> act;
    std::optional<ClientId> client = {};  // who is told when it fails; none: all
    bool is_request = false;              // its answer needs room with the client
  };
  using Counter = std::shared_ptr<std::atomic<std::size_t>>;

  void push(Item item);
  void work(ViewStart start, Messenger& messenger, std::promise<void> made);
  void serve(Viewer& viewer, Messenger& messenger);
  [[nodiscard]] std::deque<Item> wait_for_items(bool is_watched, double next);
  [[nodiscard]] static std::deque<Item> act_on(std::deque<Item> items, Viewer& viewer, Messenger& messenger);

  Config config_;
  std::mutex mutex_;
  std::condition_variable filled_;
  std::deque<Item> items_;
  std::map<ClientId, Counter> waiting_;  // requests without an answer, by client
  std::size_t documents_ = 0;            // in `items_`
  bool is_over_ = false;
  Messenger* messenger_ = nullptr;
  std::thread thread_;
};

}  // namespace flexura
