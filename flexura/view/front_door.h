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

/// Passes messages between a server and a viewer. Receives events on the server's thread without blocking,
/// and passes them to the viewer on a separate thread. While a client is connected, the viewer's thread
/// advances the viewer 60 times a second. Errors in the viewer's thread are reported to the affected clients
/// and do not stop the thread.
class FrontDoor : public Host {
 public:
  struct Config {
    /// Returns the time, s, which never decreases. The function is called from any thread.
    std::function<double()> clock;
    double interval = 1.0 / 60;  ///< Interval between advances of the viewer, s.
    std::size_t waiting_of_a_client =
        256;  ///< Largest number of unanswered requests per client. Further requests are refused.
    std::size_t waiting_documents = 64;
  };

  explicit FrontDoor(Config config);
  ~FrontDoor() override;

  /// Starts the viewer. The caller must call this function once, before or after the first client connects.
  /// `messenger` must exist until stop(). Rethrows exceptions of the viewer's construction.
  void start(ViewStart start, Messenger& messenger);
  /// Stops the viewer: cancels a run and waits for active jobs. After this call, the front door no longer
  /// uses the messenger.
  void stop();

  void opened(ClientId client) override;
  void closed(ClientId client) override;
  void on_message(ClientId client, std::string text) override;
  void asked(std::string target, std::function<void(HttpAnswer)> answer) override;

 private:
  struct Item {
    std::function<void(Viewer&)> act;
    std::optional<ClientId> client = {};  // Client to inform about a failure; missing: all clients.
    bool is_request = false;              // Whether the answer needs room in the client's queue.
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
  std::map<ClientId, Counter> waiting_;  // Unanswered requests by client.
  std::size_t documents_ = 0;            // Number of documents in `items_`.
  bool is_over_ = false;
  Messenger* messenger_ = nullptr;
  std::thread thread_;
};

}  // namespace flexura
