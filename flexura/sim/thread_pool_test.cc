#include "flexura/sim/thread_pool.h"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <ctime>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace flexura {
namespace {

TEST(ThreadPool, DoesEveryJobOnceInEveryRound) {
  for (const std::size_t threads : {1U, 2U, 3U, 7U}) {
    ThreadPool thread_pool(threads);
    EXPECT_EQ(thread_pool.threads(), threads);
    for (std::size_t count = 0; count < 20; ++count) {
      std::vector<int> done(count, 0);
      thread_pool.run(count, [&](std::size_t i) { ++done[i]; });
      EXPECT_EQ(done, std::vector<int>(count, 1)) << threads;
    }
  }
}

TEST(ThreadPool, DoesAsManyJobsAtATimeAsItHasThreads) {
  constexpr std::size_t threads = 3;
  ThreadPool thread_pool(threads);
  std::mutex mutex;
  std::condition_variable all_are_here;
  std::size_t here = 0;
  int alone = 0;
  thread_pool.run(threads, [&](std::size_t) {
    std::unique_lock lock(mutex);
    ++here;
    all_are_here.notify_all();
    if (!all_are_here.wait_for(lock, std::chrono::seconds(60), [&] { return here == threads; })) ++alone;
  });
  EXPECT_EQ(alone, 0) << "each job waits for the others to have begun";
}

TEST(ThreadPool, GivesAJobToTheSameThreadEveryTime) {
  ThreadPool thread_pool(3);
  std::vector<std::thread::id> first(7), again(7);
  thread_pool.run(7, [&](std::size_t i) { first[i] = std::this_thread::get_id(); });
  thread_pool.run(7, [&](std::size_t i) { again[i] = std::this_thread::get_id(); });
  EXPECT_EQ(first, again);
  EXPECT_EQ(first[0], std::this_thread::get_id());
  for (std::size_t i = 3; i < 7; ++i) EXPECT_EQ(first[i], first[i - 3]) << i;
  EXPECT_EQ(std::set(first.begin(), first.end()).size(), 3U);
}

TEST(ThreadPool, ThrowsWhatTheFirstThreadThrewAndGoesOnAfterwards) {
  ThreadPool thread_pool(3);
  const auto text = [&](const std::set<std::size_t>& bad) -> std::string {
    try {
      thread_pool.run(6, [&](std::size_t i) {
        if (bad.contains(i)) throw std::runtime_error("job " + std::to_string(i));
      });
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(text({2}), "job 2");
  EXPECT_EQ(text({2, 4}), "job 4") << "the second thread's, before the third's";
  EXPECT_EQ(text({0, 1, 2, 3, 4, 5}), "job 0");
  EXPECT_EQ(text({}), "");
}

TEST(ThreadPool, SleepsWhileThereIsNothingToDo) {
  ThreadPool thread_pool(4);
  thread_pool.run(4, [](std::size_t) {});
  const std::clock_t before = std::clock();  // of all threads
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_LT(static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC, 0.03);
}

}  // namespace
}  // namespace flexura
