#include "flexura/view/front_door.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <iterator>
#include <set>
#include <utility>

namespace flexura {

FrontDoor::FrontDoor(Config config) : config_(std::move(config)) {}

FrontDoor::~FrontDoor() { stop(); }

void FrontDoor::start(ViewStart start, Messenger& messenger) {
  std::promise<void> made;
  std::future<void> is_made = made.get_future();
  {
    const std::lock_guard lock(mutex_);
    messenger_ = &messenger;
    thread_ = std::thread([this, start = std::move(start), &messenger, made = std::move(made)]() mutable {
      work(std::move(start), messenger, std::move(made));
    });
  }
  is_made.get();
}

void FrontDoor::stop() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
    messenger_ = nullptr;
    filled_.notify_one();
  }
  if (thread_.joinable()) thread_.join();
}

void FrontDoor::push(Item item) {
  const std::lock_guard lock(mutex_);
  if (is_over_) return;
  items_.push_back(std::move(item));
  filled_.notify_one();
}

void FrontDoor::opened(ClientId client) {
  push({[client](Viewer& viewer) { viewer.opened(client); }, client});
}

void FrontDoor::closed(ClientId client) {
  push({[client](Viewer& viewer) { viewer.closed(client); }});
  const std::lock_guard lock(mutex_);
  waiting_.erase(client);
}

void FrontDoor::on_message(ClientId client, std::string text) {
  const std::lock_guard lock(mutex_);
  if (is_over_) return;
  Counter& waiting = waiting_[client];
  if (waiting == nullptr) waiting = std::make_shared<Counter::element_type>(0);
  if (*waiting >= config_.waiting_of_a_client) {
    if (messenger_ != nullptr)
      messenger_->send(client, R"({"type":"reply","id":null,"error":"too many requests wait"})");
    return;
  }
  ++*waiting;
  // Whoever is to answer holds it; where nobody does any more the request has its answer, or gets none.
  std::shared_ptr<const void> debt(waiting.get(), [waiting](const void*) { --*waiting; });
  items_.push_back({[client, text = std::move(text), debt = std::move(debt)](Viewer& viewer) {
                      viewer.on_message(client, text, debt);
                    },
                    client, true});
  filled_.notify_one();
}

void FrontDoor::asked(std::string target, std::function<void(HttpAnswer)> answer) {
  std::unique_lock lock(mutex_);
  if (is_over_ || documents_ >= config_.waiting_documents) {
    lock.unlock();
    answer({503, "application/json", R"({"error":"too many documents are asked for"})", ""});
    return;
  }
  ++documents_;
  items_.push_back({[this, target = std::move(target), answer = std::move(answer)](Viewer& viewer) {
    {
      const std::lock_guard counting(mutex_);
      --documents_;
    }
    viewer.asked(target, answer);
  }});
  filled_.notify_one();
}

std::deque<FrontDoor::Item> FrontDoor::wait_for_items(bool is_watched, double next) {
  std::unique_lock lock(mutex_);
  const auto is_ready = [&] { return is_over_ || !items_.empty(); };
  if (!is_watched) {
    filled_.wait(lock, is_ready);
  } else {
    const std::chrono::duration<double> left(std::max(0.0, next - config_.clock()));
    filled_.wait_for(lock, left, is_ready);
  }
  return is_over_ ? std::deque<Item>{} : std::exchange(items_, {});
}

// Does what is asked, and returns what must wait: requests of those who do not read so fast as they ask.
std::deque<FrontDoor::Item> FrontDoor::act_on(std::deque<Item> items, Viewer& viewer, Messenger& messenger) {
  std::deque<Item> waiting;
  std::set<ClientId> slow;  // whose requests keep their order
  for (Item& item : items) {
    if (item.is_request && (slow.contains(*item.client) || !messenger.has_room(*item.client))) {
      slow.insert(*item.client);
      waiting.push_back(std::move(item));
      continue;
    }
    try {
      item.act(viewer);
    } catch (const std::exception& error) {
      viewer.failed(item.client, error.what());
    }
  }
  return waiting;
}

void FrontDoor::work(ViewStart start, Messenger& messenger, std::promise<void> made) {
  // First the workers go, and then the viewer whose jobs they do.
  std::unique_ptr<Viewer> viewer;
  Workers workers(
      [this](Background::After after) { push({[after = std::move(after)](Viewer&) { after(); }}); });
  try {
    viewer = std::make_unique<Viewer>(std::move(start), messenger, workers, config_.clock());
  } catch (...) {
    made.set_exception(std::current_exception());
    return;
  }
  made.set_value();
  serve(*viewer, messenger);
  viewer->cancel();
}

void FrontDoor::serve(Viewer& viewer, Messenger& messenger) {
  constexpr double soon = 0.001;  // s, till a slow client is looked at again
  std::deque<Item> items;
  double next = config_.clock();
  for (;;) {
    const double until = items.empty() ? next : config_.clock() + soon;
    std::ranges::move(wait_for_items(viewer.is_watched() || !items.empty(), until),
                      std::back_inserter(items));
    {
      const std::lock_guard lock(mutex_);
      if (is_over_) break;
    }
    items = act_on(std::move(items), viewer, messenger);
    const double now = config_.clock();
    if (now < next || !viewer.is_watched()) continue;
    try {
      viewer.advance(now);
    } catch (const std::exception& error) {
      viewer.failed({}, error.what());
    }
    // A tick that was missed is not made up for.
    next = std::max(next + config_.interval, now);
  }
}

}  // namespace flexura
