#pragma once

#include <compare>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>

#include "flexura/serve/server.h"
#include "flexura/view/background.h"
#include "flexura/view/session.h"

namespace flexura {

/// Queue for requests of which only the newest of a client and kind is relevant. For each client and kind of
/// request, at most one request is being answered and at most one waits. All calls must be from one thread.
/// Answers are computed on another thread.
class LatestJobs {
 public:
  /// A client and a kind of request.
  struct Key {
    ClientId client = 0;
    std::size_t kind = 0;
    auto operator<=>(const Key&) const = default;
  };
  /// Computes the answer on the thread of its queue (lane). If the computation throws an exception, the
  /// request is refused with the exception's text.
  using Job = std::function<Node()>;

  LatestJobs(Background& background, Lane lane) : background_(background), lane_(lane) {}

  /// Adds a request. Refuses the waiting request with an equal key, if there is one.
  void ask(const Key& key, Job job, Reply reply);
  /// Removes the waiting requests of a client.
  void close(ClientId client);

 private:
  struct Question {
    Job job;
    Reply reply;
  };
  void start(const Key& key, Question question);
  void finished(const Key& key);

  Background& background_;
  Lane lane_;
  // Keys with a question that is being answered, and their waiting questions.
  std::map<Key, std::optional<Question>> waiting_;
  std::shared_ptr<const bool> alive_ = std::make_shared<const bool>(true);
};

}  // namespace flexura
