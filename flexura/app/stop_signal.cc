#include "flexura/app/stop_signal.h"

#include <pthread.h>

#include <ctime>
#include <utility>

namespace flexura {

StopSignal::StopSignal(std::function<void()> on_stop) {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  thread_ = std::thread([this, on_stop = std::move(on_stop)] {
    constexpr timespec a_while{0, 100'000'000};
    while (!is_over_) {
      if (sigtimedwait(&signals_, nullptr, &a_while) < 0) continue;
      has_come_ = true;
      has_come_.notify_all();
      if (on_stop) on_stop();
    }
  });
}

StopSignal::~StopSignal() {
  is_over_ = true;
  thread_.join();
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void StopSignal::wait() const { has_come_.wait(false); }

}  // namespace flexura
