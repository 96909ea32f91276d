#pragma once

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "flexura/port/clock_port.h"

namespace flexura {

/// Simulated time for several threads. Time passes only while each thread waits for it, or for a mutex of
/// another thread. A busy machine therefore makes no thread late.
class SimulatedThreads : public ClockPort {
 public:
  using Lock = std::unique_lock<std::mutex>;

  explicit SimulatedThreads(double step) : step_(step) {}

  [[nodiscard]] double now() const override { return now_; }
  void wait_until(double time) override {
    Lock lock = enter();
    wait(lock, time, [] { return false; });
  }
  /// Returns a lock for what threads and time share. Each use of it by a thread is seen as work.
  [[nodiscard]] Lock enter() {
    Lock lock(mutex_);
    ++uses_;
    return lock;
  }
  /// Waits until `is_done`, which is asked once a step under the lock, or until a time. Only in threads of
  /// start().
  void wait(Lock& lock, double until, std::function<bool()> is_done) {
    Thread& own = *own_;
    if (is_done() || now_ >= until) return;
    own.until = until, own.is_done = std::move(is_done), own.is_waiting = true;
    --running_;
    idle_.notify_one();
    own.woken.wait(lock, [&] { return !own.is_waiting; });
  }
  /// Starts a thread. Call it before run().
  void start(std::function<void()> work) {
    const Lock lock = enter();
    Thread& made = threads_.emplace_back();
    ++running_;
    made.thread = std::thread([this, &made, work = std::move(work)] {
      own_ = &made;
      made.number = ::gettid();
      work();
      const Lock last = enter();
      made.is_over = true;
      --running_;
      idle_.notify_one();
    });
  }
  /// Lets time pass until all threads have ended. `on_step` is called under the lock, with the time.
  void run(const std::function<void(double)>& on_step) {
    Lock lock(mutex_);
    for (;;) {
      settle(lock);
      if (std::ranges::all_of(threads_, [](const Thread& one) { return one.is_over; })) break;
      now_ = now_ + step_;
      on_step(now_);
      for (Thread& one : threads_) {
        if (!one.is_waiting || (now_ < one.until && !one.is_done())) continue;
        one.is_waiting = false;
        ++running_, ++uses_;
        one.woken.notify_one();
      }
    }
    lock.unlock();
    for (Thread& one : threads_) one.thread.join();
    threads_.clear();
  }

 private:
  struct Thread {
    std::thread thread;
    std::atomic<pid_t> number = 0;
    bool is_waiting = false, is_over = false;
    double until = 0;
    std::function<bool()> is_done;
    std::condition_variable woken;
  };
  // A thread that sleeps, and how often it has gone to sleep.
  struct Sleep {
    bool is_asleep = false;
    std::string switches;
    bool operator==(const Sleep&) const = default;
  };

  static Sleep sleep_of(pid_t number) {
    Sleep sleep;
    std::ifstream status("/proc/self/task/" + std::to_string(number) + "/status");
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with("State:")) sleep.is_asleep = line.find("S (") != std::string::npos;
      if (line.find("ctxt_switches:") != std::string::npos) sleep.switches += line;
    }
    return sleep;
  }
  // Returns whether none of the threads ran at some moment during this call.
  static bool are_asleep(const std::vector<pid_t>& numbers) {
    std::vector<Sleep> before;
    for (const pid_t number : numbers) before.push_back(sleep_of(number));
    if (!std::ranges::all_of(before, &Sleep::is_asleep)) return false;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      if (sleep_of(numbers[i]) != before[i]) return false;
    return true;
  }

  // Waits until no thread works.
  void settle(Lock& lock) {
    constexpr auto patience = std::chrono::microseconds(50);
    const auto start = std::chrono::steady_clock::now();
    while (running_ > 0 && uses_ != settled_) {
      if (idle_.wait_for(lock, patience, [&] { return running_ == 0; })) break;
      std::vector<pid_t> numbers;
      bool is_anyone_waiting = false;
      for (const Thread& one : threads_) {
        is_anyone_waiting = is_anyone_waiting || one.is_waiting;
        if (!one.is_waiting && !one.is_over) numbers.push_back(one.number);
      }
      const std::uint64_t uses = uses_;
      lock.unlock();
      const bool asleep = std::ranges::find(numbers, 0) == numbers.end() && are_asleep(numbers);
      lock.lock();
      if (!asleep || uses_ != uses || running_ == 0) continue;
      // Threads may wait in real time for each other, but not for long.
      if (is_anyone_waiting) {
        settled_ = uses;
      } else if (std::chrono::steady_clock::now() > start + std::chrono::seconds(60)) {
        std::fputs("deadlock: each thread waits for another one\n", stderr);
        std::abort();
      }
    }
  }

  static inline thread_local Thread* own_ = nullptr;
  double step_;
  std::atomic<double> now_ = 0;
  std::mutex mutex_;
  std::condition_variable idle_;
  std::deque<Thread> threads_;
  int running_ = 0;            // Threads that neither wait for time nor have ended.
  std::uint64_t uses_ = 0;     // Signs of work.
  std::uint64_t settled_ = 0;  // Signs of work when all that run were seen to sleep.
};

}  // namespace flexura
