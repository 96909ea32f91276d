#include "flexura/view/latest_jobs.h"

#include <exception>
#include <utility>

#include "flexura/base/node.h"

namespace flexura {

void LatestJobs::ask(const Key& key, Job job, Reply reply) {
  Question question{std::move(job), std::move(reply)};
  const auto found = waiting_.find(key);
  if (found == waiting_.end()) {
    start(key, std::move(question));
    return;
  }
  const auto overtaken = std::exchange(found->second, std::move(question));
  if (overtaken) overtaken->reply({{Node::Table{}, {}}, "replaced by a newer request"});
}

void LatestJobs::start(const Key& key, Question question) {
  waiting_.emplace(key, std::nullopt);
  background_.run(lane_,
                  [this, key, job = std::move(question.job), reply = std::move(question.reply),
                   alive = std::weak_ptr(alive_)]() -> Background::After {
                    ViewAnswer answer;
                    try {
                      answer.result = job();
                    } catch (const std::exception& error) {
                      answer.error = error.what();
                    }
                    return [this, key, answer, reply, alive] {
                      if (alive.expired()) return;
                      reply(answer);
                      finished(key);
                    };
                  });
}

void LatestJobs::finished(const Key& key) {
  const auto found = waiting_.find(key);
  std::optional<Question> next = std::move(found->second);
  waiting_.erase(found);
  if (next) start(key, *std::move(next));
}

void LatestJobs::close(ClientId client) {
  for (auto& [key, question] : waiting_)
    if (key.client == client) question.reset();
}

}  // namespace flexura
