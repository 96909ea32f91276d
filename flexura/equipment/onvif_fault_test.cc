// Cameras whose answers fail.
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <optional>
#include <random>
#include <string>
#include <thread>

#include "flexura/base/degree.h"
#include "flexura/equipment/guard.h"
#include "flexura/equipment/onvif_server.h"
#include "flexura/equipment/wall_clock.h"
#include "tests/support/onvif_wire.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

constexpr OnvifFault first_onvif_fault = OnvifFault::silent, last_onvif_fault = OnvifFault::unmarked;
bool is_harmless(OnvifFault fault) {
  return fault == OnvifFault::chunked || fault == OnvifFault::in_pieces || fault == OnvifFault::unmarked ||
         fault == OnvifFault::none;
}

// Calls `check` for each fault.
template <class Check>
void for_each_onvif_fault(const Check& check) {
  for (int i = static_cast<int>(first_onvif_fault); i <= static_cast<int>(last_onvif_fault); ++i) {
    SCOPED_TRACE(i);
    check(static_cast<OnvifFault>(i));
  }
}

TEST(OnvifFaults, EachIsOvercomeWhenItHappensOnce) {
  for_each_onvif_fault([](OnvifFault fault) {
    OnvifBench bench;
    ASSERT_EQ(bench.start(), "");
    bench.device.fail(fault, 1);
    EXPECT_EQ(bench.command({-45 * degree, 0, 0.5}), "");
    bench.device.fail(fault, 1);
    EXPECT_TRUE(bench.head.read());
    bench.device.fail(fault, 1);
    EXPECT_EQ(bench.halt(), "");
    EXPECT_FALSE(bench.device.is_moving(bench.wire.time));
    EXPECT_EQ(bench.command({-45 * degree, 0, 0.5}), "");
    EXPECT_EQ(bench.settle(), "");
    EXPECT_NEAR(bench.device.place(bench.wire.time).pan, 0.25, 1e-5);
  });
}

TEST(OnvifFaults, EachIsReportedInBoundedTimeWhenItLasts) {
  for_each_onvif_fault([](OnvifFault fault) {
    OnvifBench bench;
    bench.device.fail(fault);
    const double start = bench.wire.time;
    const std::string problem = bench.start();
    EXPECT_LT(bench.wire.time - start, 10);
    EXPECT_EQ(problem.empty(), is_harmless(fault)) << problem;
    EXPECT_EQ(problem.find('\n'), std::string::npos);
    bench.device.fail(OnvifFault::none);
    ASSERT_EQ(bench.start(), "") << "found again";
    bench.device.fail(fault);
    EXPECT_EQ(bench.command({1, 0, 0}).empty(), is_harmless(fault));
    EXPECT_EQ(static_cast<bool>(bench.head.read()), is_harmless(fault));
    EXPECT_EQ(bench.halt().empty(), is_harmless(fault));
    bench.device.fail(OnvifFault::none);
    EXPECT_EQ(bench.command({}), "");
    EXPECT_EQ(bench.settle(), "");
  });
}

TEST(OnvifFaults, AnUnpluggedCameraIsFoundAgain) {
  OnvifBench bench;
  bench.wire.is_unplugged = true;
  EXPECT_NE(bench.start().find("No route to host"), std::string::npos);
  bench.wire.is_unplugged = false;
  EXPECT_EQ(bench.start(), "");
}

// A camera may close every connection after an answer, without saying so.
TEST(OnvifFaults, ClosedConnectionsAreOpenedAgain) {
  OnvifConfig config = OnvifBench::usual();
  config.tries = 1;
  OnvifBench bench(config);
  bench.wire.closes_idle = true;
  ASSERT_EQ(bench.start(), "");
  ASSERT_EQ(bench.command({1, 0, 0}), "");
  EXPECT_EQ(bench.settle(), "");
  EXPECT_GT(bench.wire.connections, 5);
}

// Whatever fails and however often: the head is at the last target in the end, or a message says why not.
TEST(OnvifFaults, RandomFaultsEndAtTheTarget) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    std::uniform_int_distribution<int> which(static_cast<int>(OnvifFault::none),
                                             static_cast<int>(last_onvif_fault));
    std::uniform_real_distribution<double> angle(-1, 1);
    OnvifBench bench;
    ASSERT_EQ(bench.start(), "");
    for (int i = 0; i < 100; ++i) {
      bench.device.fail(static_cast<OnvifFault>(which(random)), static_cast<std::size_t>(1 + i % 4));
      const std::string sent = bench.command({angle(random), angle(random), 0.5});
      const auto read = bench.head.read();
      EXPECT_EQ(sent.find('\n'), std::string::npos);
      if (i % 5 == 0) {
        bench.device.fail(OnvifFault::none);
        ASSERT_EQ(bench.halt(), "");
        ASSERT_FALSE(bench.device.is_moving(bench.wire.time));
      }
    }
    bench.device.fail(OnvifFault::none);
    ASSERT_EQ(bench.command({0.5, 0.25, 0.75}), "");
    ASSERT_EQ(bench.settle(), "");
    EXPECT_NEAR(bench.head.read().value().state.pan, 0.5, 1e-3);
  }
}

// Over TCP, in real time.
struct ServedCamera {
  ServedCamera() {
    const std::string path = folder.path() / "password";
    std::ofstream(path) << "secret\n";
    config.link = "tcp:127.0.0.1:" + std::to_string(server.port());
    config.user = "operator", config.password_file = path;
    config.reply_timeout = 30, config.tries = 2, config.stall_time = 30;
    const auto lock = server.lock();
    device.model().most_age = 300;
  }
  bool is_moving() {
    const auto lock = server.lock();
    return device.is_moving(steady_seconds());
  }
  // Waits until the head stands or moves.
  void wait_for(bool moving) {
    while (is_moving() != moving) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  TemporaryFolder folder;
  OnvifDevice device;
  OnvifServer server{device};
  OnvifConfig config;
  WallClock clock;
};

TEST(OnvifLink, WorksOverTcp) {
  ServedCamera camera;
  auto opened = open_onvif_head(camera.config, camera.clock);
  ASSERT_TRUE(opened) << opened.fault()->what;
  OnvifHead& head = *opened.value();
  ASSERT_TRUE(head.command({-20 * degree, 10 * degree, 0.25}));
  bool is_moving = true;
  while (is_moving) is_moving = head.read().value().moving;
  EXPECT_NEAR(head.read().value().state.pan, -20 * degree, 0.01 * degree);
  {
    const auto lock = camera.server.lock();
    camera.device.fail(OnvifFault::closes, 1);
  }
  EXPECT_TRUE(head.read());
  ASSERT_TRUE(head.command({170 * degree, 0, 0}));
  ASSERT_TRUE(head.halt());
  EXPECT_FALSE(camera.is_moving());
}

TEST(OnvifLink, AHaltDuringCommandsStopsTheHead) {
  ServedCamera camera;
  auto opened = open_onvif_head(camera.config, camera.clock);
  ASSERT_TRUE(opened) << opened.fault()->what;
  OnvifHead& head = *opened.value();
  std::thread commanding([&] {
    for (int i = 0; i < 20; ++i) (void)head.command({(i % 2 == 0 ? 2.0 : -2.0), 0.1 * i, 0.5});
  });
  std::thread reading([&] {
    for (int i = 0; i < 20; ++i) (void)head.read();
  });
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(head.halt());
  commanding.join();
  reading.join();
  ASSERT_TRUE(head.halt());
  EXPECT_FALSE(camera.is_moving());
}

TEST(OnvifLink, AMissingPasswordFileIsReported) {
  ServedCamera camera;
  camera.config.password_file = camera.folder.path() / "none";
  const auto opened = open_onvif_head(camera.config, camera.clock);
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.fault()->what.find("no password can be read"), std::string::npos);
}

TEST(OnvifLink, TheGuardStopsTheHeadOfASilentProgram) {
  ServedCamera camera;
  Guard guard(0.2);
  std::optional<std::size_t> number;
  const auto share = [&](const std::string& request) -> CommandOutcome {
    const StopMessages stop{{request}, 0, {}};
    if (number) {
      guard.renew(*number, stop);
    } else {
      number = guard.protect(parse_link_address(camera.config.link), stop);
    }
    return Accepted{};
  };
  auto opened = open_onvif_head(camera.config, camera.clock, share);
  ASSERT_TRUE(opened) << opened.fault()->what;
  {
    const auto lock = camera.server.lock();
    camera.device.model().rates = {1e-4, 1e-4, 1e-4};  // Hours.
  }
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(opened.value()->command({2.0, 0.1 * i, 0.5}));
    camera.wait_for(true);
    guard.beat(true);  // The last sign of life.
    camera.wait_for(false);
  }
  const auto lock = camera.server.lock();
  EXPECT_GE(camera.device.executed("Stop"), 3U);
}

}  // namespace
}  // namespace flexura
