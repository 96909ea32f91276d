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
      const int signal = sigtimedwait(&signals_, nullptr, &a_while);
      if (signal < 0) continue;
      int none = 0;
      come_.compare_exchange_strong(none, signal);
      come_.notify_all();
      if (on_stop) on_stop();
    }
  });
}

StopSignal::~StopSignal() {
  is_over_ = true;
  thread_.join();
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void StopSignal::wait() const { come_.wait(0); }

}  // namespace flexura
