#include "flexura/view/front_door.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace flexura {

FrontDoor::FrontDoor(Config config) : config_(std::move(config)) {}

FrontDoor::~FrontDoor() { stop(); }

void FrontDoor::start(ViewStart start, Messenger& messenger) {
  const std::lock_guard lock(mutex_);
  messenger_ = &messenger;
  thread_ = std::thread(
      [this, start = std::move(start), &messenger]() mutable { work(std::move(start), messenger); });
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
  push([client](Viewer& viewer) { viewer.opened(client); });
}

void FrontDoor::closed(ClientId client) {
  push([client](Viewer& viewer) { viewer.closed(client); });
}

void FrontDoor::said(ClientId client, std::string text) {
  const std::lock_guard lock(mutex_);
  if (is_over_) return;
  if (waiting_[client] >= config_.waiting_of_a_client) {
    if (messenger_ != nullptr)
      messenger_->send(client, R"({"type":"reply","id":null,"error":"too many requests wait"})");
    return;
  }
  ++waiting_[client];
  items_.emplace_back([this, client, text = std::move(text)](Viewer& viewer) {
    {
      const std::lock_guard counting(mutex_);
      if (--waiting_[client] == 0) waiting_.erase(client);
    }
    viewer.said(client, text);
  });
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
  items_.emplace_back([this, target = std::move(target), answer = std::move(answer)](Viewer& viewer) {
    {
      const std::lock_guard counting(mutex_);
      --documents_;
    }
    viewer.asked(target, answer);
  });
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

void FrontDoor::work(ViewStart start, Messenger& messenger) {
  // First the workers go, and then the viewer whose jobs they do.
  std::unique_ptr<Viewer> viewer;
  Workers workers(
      [this](Background::After after) { push([after = std::move(after)](Viewer&) { after(); }); });
  viewer = std::make_unique<Viewer>(std::move(start), messenger, workers, config_.clock());
  double next = config_.clock();
  for (;;) {
    for (const Item& item : wait_for_items(viewer->is_watched(), next)) item(*viewer);
    {
      const std::lock_guard lock(mutex_);
      if (is_over_) break;
    }
    const double now = config_.clock();
    if (now < next || !viewer->is_watched()) continue;
    viewer->advance(now);
    // A tick that was missed is not made up for.
    next = std::max(next + config_.interval, now);
  }
  viewer->cancel();
}

}  // namespace flexura
