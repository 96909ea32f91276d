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

/// Questions of which only the newest counts: of each kind of a client's one is being answered and one waits.
/// One thread uses it; the answers are found on another.
class LatestJobs {
 public:
  /// Whose question, and which of its questions.
  struct Key {
    ClientId client = 0;
    std::size_t kind = 0;
    auto operator<=>(const Key&) const = default;
  };
  /// Finds the answer, on the lane's thread; what it throws is the reason why there is none.
  using Job = std::function<Node()>;

  LatestJobs(Background& background, Lane lane) : background_(background), lane_(lane) {}

  /// One that waited is refused.
  void ask(const Key& key, Job job, Reply reply);
  /// Drops what waits of a client's.
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
  std::map<Key, std::optional<Question>> waiting_;  // of those whose question is being answered
  std::shared_ptr<const bool> alive_ = std::make_shared<const bool>(true);
};

}  // namespace flexura
