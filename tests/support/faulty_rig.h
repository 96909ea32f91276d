#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "flexura/equipment/guarded_drive.h"
#include "flexura/equipment/visca_device.h"
#include "flexura/equipment/visca_head.h"
#include "tests/support/faulty_drives.h"
#include "tests/support/faulty_lines.h"

namespace flexura {

/// A drive, a chain of two heads and one head over UDP, their guard, and the threads of a program: a servo
/// loop, one thread per head, and one that halts everything now and then.
class RigUnderTest {
 public:
  using Make = std::function<std::unique_ptr<DriveUnderTest>(SimulatedThreads&, std::uint64_t)>;
  RigUnderTest(const Make& make, std::uint64_t seed, double run_time)
      : run_time_(run_time),
        chain_(ViscaFraming::stream),
        single_(ViscaFraming::sony),
        arm_(make(time_, seed)),
        guard_(time_, fault_watchdog),
        guarded_(arm_->drive(), guard_, [this] { arm_->keep_alive(); }),
        random_(seed),
        arm_mishaps_(arm_->line(), seed + 1) {
    guard_.protect(arm_->line(), arm_->stop());
    chain_.add({}), chain_.add({}), single_.add({});
    add_bus(chain_, "/dev/heads", 2, seed + 10);
    add_bus(single_, "udp:127.0.0.1:52381", 1, seed + 20);
    arm_mishaps_.raise_alarm = [this](double now) {
      arm_->raise_alarm(now);
      if (!is_resetting_) needs_reset_since_ = now;
      rest_.require(now, "alarm");
    };
    arm_mishaps_.restart = [this](double now) {
      arm_->restart(now);
      rest_.forget_place();
    };
  }

  void run() {
    time_.start([this] { control(); });
    time_.start([this] { stop_now_and_then(); });
    for (std::size_t i = 0; i < heads_.size(); ++i) time_.start([this, i] { turn(i); });
    time_.run([this](double now) { step(now); });
  }

  void step(double now) {
    arm_mishaps_.step(now);
    for (Mishaps& one : head_mishaps_) one.step(now);
    arm_->line().step(now);
    for (SimulatedLine* line : head_lines_) line->step(now);
    guard_.step(now);
    rest_.step(now, arm_->positions(now));
    calls_.step(now);
  }

  // The program waits, and says that it works.
  void wait(double duration) {
    for (const double end = time_.now() + duration; time_.now() < end;) {
      guarded_.beat();
      time_.wait_until(std::min(end, time_.now() + fault_watchdog / 10));
    }
  }

  void require_rest(double since, const std::string& why) {
    const auto lock = time_.enter();
    rest_.require(since, why);
  }
  bool is_stopped() {
    const auto lock = time_.enter();
    return is_stopped_;
  }

  CommandOutcome command(const std::vector<double>& target, double duration) {
    std::optional<double> reset_due;
    {
      const auto lock = time_.enter();
      is_commanding_ = true;
      rest_.allow_motion();
      reset_due = needs_reset_since_;
    }
    const double began = time_.now();
    auto outcome = calls_("command", longest_call, [&] { return guarded_.command(target, duration); });
    const auto lock = time_.enter();
    is_commanding_ = false;
    if (outcome) {
      ++accepted_;
      EXPECT_FALSE(reset_due && *reset_due + 0.3 < began)
          << "a command is accepted at " << began << " s without a reset after the alarm at " << *reset_due;
    }
    return outcome;
  }

  void handle(const PortFault& fault) {
    ++faults_[fault.what.substr(0, 100)];
    require_rest(time_.now(), fault.what);
    (void)calls_("halt", longest_call, [&] { return guarded_.halt(); });
    wait(0.3 + share(random_));
    recover();
  }

  void recover() {
    while (time_.now() < run_time_) {
      {
        const auto lock = time_.enter();
        is_resetting_ = true;
      }
      // A reset takes longer than a watchdog period, and moves nothing.
      (void)guard_.beat(false);
      const bool is_done = calls_("reset", longest_reset, [&] { return arm_->reset(); });
      {
        const auto lock = time_.enter();
        is_resetting_ = false;
        needs_reset_since_.reset();
      }
      if (is_done) {
        ++resets_;
        return;
      }
      wait(0.2);
    }
  }

  std::vector<double> shape() {
    std::uniform_real_distribution<double> place(-900, 900);
    return {place(random_), place(random_), place(random_)};
  }

  // The servo loop.
  void control() {
    recover();
    constexpr double period = 1 / 30.0;
    std::vector<double> from = shape(), to = shape();
    int cycle = 0;
    while (time_.now() < run_time_) {
      wait(period);
      if (is_stopped()) {
        (void)calls_("halt", longest_call, [&] { return guarded_.halt(); });
        require_rest(time_.now(), "emergency stop");
        while (is_stopped()) wait(0.02);
        continue;
      }
      const auto reading = calls_("read", longest_call, [&] { return guarded_.read(); });
      if (!reading) {
        handle(*reading.fault());
        continue;
      }
      if (time_.now() > next_hang_) {
        next_hang_ = time_.now() + 12;
        hang();
        continue;
      }
      if (++cycle % 30 == 0) from = to, to = shape();
      const double part = cycle % 30 / 30.0;
      std::vector<double> target;
      for (std::size_t i = 0; i < 3; ++i) target.push_back(std::lerp(from[i], to[i], part));
      const auto sent = command(target, period);
      if (!sent) handle(*sent.fault());
    }
    require_rest(time_.now(), "the end");
    (void)calls_("halt", longest_call, [&] { return guarded_.halt(); });
    wait(2);
  }

  // The program begins a long motion and says nothing any more.
  void hang() {
    std::vector<double> far = shape();
    for (double& one : far) one = std::copysign(4000, one);
    const auto sent = command(far, 4);
    const double since = time_.now();
    if (!sent) return handle(*sent.fault());
    int before = 0;
    bool is_clean = false, is_dead = false;
    {
      const auto lock = time_.enter();
      before = guard_.stops();
      is_clean = arm_mishaps_.is_clean(), is_dead = arm_mishaps_.is_dead();
      arm_mishaps_.hold(since + 5);
      if (is_clean) rest_.require(since, "the program is silent");
      // Stops may be lost on a disturbed line; the guard repeats them. A dead line passes none.
      constexpr double repetitions = 2;  // s
      if (!is_clean && !is_dead) rest_.require(since + repetitions, "the program is silent on a bad line");
    }
    time_.wait_until(since + (is_clean || is_dead ? 1.5 : 3.5));
    {
      const auto lock = time_.enter();
      EXPECT_GT(guard_.stops(), before);
      ++hangs_, clean_hangs_ += is_clean ? 1 : 0, disturbed_hangs_ += is_clean || is_dead ? 0 : 1;
    }
    const auto refused = command(far, 4);
    EXPECT_FALSE(refused);
    if (is_clean) {
      const auto still_refused = command(far, 4);
      EXPECT_FALSE(still_refused) << "the watchdog has stopped the arm, which has not been reset";
    }
    if (is_clean) require_rest(time_.now(), "the watchdog has stopped the arm");
    wait(0.3);
    recover();
  }

  // A person who stops all from another thread.
  void stop_now_and_then() {
    std::mt19937_64 random(99);
    while (time_.now() < run_time_) {
      time_.wait_until(time_.now() + 1 + 6 * share(random));
      {
        const auto lock = time_.enter();
        is_stopped_ = true;
      }
      (void)calls_("halt", longest_call, [&] { return guarded_.halt(); });
      {
        const auto lock = time_.enter();
        if (!is_commanding_) rest_.require(time_.now(), "emergency stop by another thread");
        ++stops_;
      }
      for (const auto& head : heads_) (void)calls_("head halt", longest_call, [&] { return head->halt(); });
      time_.wait_until(time_.now() + 1);
      const auto lock = time_.enter();
      is_stopped_ = false;
    }
  }

  // The thread of a head.
  void turn(std::size_t i) {
    std::mt19937_64 random(7 + i);
    bool is_ready = false;
    for (int round = 0; time_.now() < run_time_; ++round) {
      time_.wait_until(time_.now() + 0.05);
      if (is_stopped()) continue;
      if (!is_ready) {
        ViscaBus& bus = *buses_[i];
        const bool has_bus =
            static_cast<bool>(calls_("bus start", longest_call, [&] { return bus.start(); }));
        is_ready = has_bus && calls_("head start", longest_call, [&] { return heads_[i]->start(); });
        continue;
      }
      if (round % 10 == 0) {
        const HeadState state{share(random) - 0.5, 0.5 * share(random), 10000 * share(random)};
        if (!calls_("head command", longest_call, [&] { return heads_[i]->command(state); }))
          is_ready = false;
      }
      if (calls_("head read", longest_call, [&] { return heads_[i]->read(); })) ++head_readings_[i];
    }
  }

  void check() const {
    EXPECT_GT(accepted_, run_time_ * 2);
    EXPECT_GT(hangs_, run_time_ / 120);
    EXPECT_GT(clean_hangs_, 0);
    // Half of the faults disturb the line, but a short run may have no hang then.
    constexpr double long_run = 300;  // s
    EXPECT_TRUE(run_time_ < long_run || disturbed_hangs_ > 0);
    EXPECT_GT(stops_, run_time_ / 20);
    constexpr double checks_a_second = 1000, least_share = 0.05;
    EXPECT_GT(static_cast<double>(rest_.checks()), least_share * checks_a_second * run_time_);
    for (const int readings : head_readings_) EXPECT_GT(readings, run_time_);
  }
  void print() const {
    std::printf("accepted %d, resets %d, hangs %d (clean %d, disturbed %d), ", accepted_, resets_, hangs_,
                clean_hangs_, disturbed_hangs_);
    std::printf("watchdog %d, stops %d, rest checks %ld\n", guard_.stops(), stops_, rest_.checks());
    for (const int readings : head_readings_) std::printf("head readings %d\n", readings);
    for (const auto& [name, longest] : calls_.longest())
      std::printf("%s: longest %.3f s\n", name.c_str(), longest);
    for (const auto& [what, count] : faults_) std::printf("%5d %s\n", count, what.c_str());
  }

 private:
  static constexpr double time_step = 0.001;   // s
  static constexpr double longest_call = 10;   // s; several timeouts in a row.
  static constexpr double longest_reset = 30;  // s

  void add_bus(ViscaDevice& device, const std::string& link, int heads, std::uint64_t seed) {
    ViscaConfig config;
    config.bus.link = link;
    auto made = std::make_unique<SimulatedLine>(time_, device, link, heads > 1, seed);
    SimulatedLine& line = *made;
    const auto bus = std::make_shared<ViscaBus>(std::move(made), config.bus, [this] { return time_.now(); });
    for (int i = 1; i <= heads; ++i) {
      config.address = i;
      guard_.protect(line, visca_stop(config));
      heads_.push_back(std::make_unique<ViscaHead>(bus, config));
      buses_.push_back(bus);
    }
    head_lines_.push_back(&line);
    Mishaps& mishaps = head_mishaps_.emplace_back(line, seed);
    mishaps.restart = [&device](double now) { device.restart(now); };
    mishaps.raise_alarm = [&device](double now) { device.fail(0, ViscaError::not_executable, now); };
  }
  static double share(std::mt19937_64& random) {
    return std::uniform_real_distribution<double>(0, 1)(random);
  }

  double run_time_;
  SimulatedThreads time_{time_step};
  ViscaDevice chain_, single_;
  std::unique_ptr<DriveUnderTest> arm_;
  SimulatedWatchdog guard_;
  GuardedDrive guarded_;
  std::vector<std::unique_ptr<ViscaHead>> heads_;
  std::vector<std::shared_ptr<ViscaBus>> buses_;  // One per head.
  std::vector<SimulatedLine*> head_lines_;
  Calls calls_{time_};
  RestCheck rest_;
  std::mt19937_64 random_;  // Of control().
  Mishaps arm_mishaps_;
  std::deque<Mishaps> head_mishaps_;
  double next_hang_ = 4;
  bool is_stopped_ = false, is_commanding_ = false, is_resetting_ = false;
  std::optional<double> needs_reset_since_;
  int accepted_ = 0, resets_ = 0, hangs_ = 0, clean_hangs_ = 0, disturbed_hangs_ = 0, stops_ = 0;
  std::array<int, 3> head_readings_{};
  std::map<std::string, int> faults_;
};

/// Runs a program with faults of every kind for `run_time` s of simulated time.
template <class Drive>
void run_faulty_rig(std::uint64_t seed, double run_time) {
  RigUnderTest rig(
      [](SimulatedThreads& time, std::uint64_t lines) { return std::make_unique<Drive>(time, lines); }, seed,
      run_time);
  rig.run();
  rig.print();
  rig.check();
}

}  // namespace flexura
