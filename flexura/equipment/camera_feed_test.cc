#include "flexura/equipment/camera_feed.h"

#include <gtest/gtest.h>

#include <atomic>
#include <limits>

#include "flexura/equipment/frame_gaps.h"
#include "tests/support/numbered_frames.h"

namespace flexura {
namespace {

TakenPicture small_picture(double time, std::int64_t lost = 0) {
  return {.picture = Image<std::uint8_t>(2, 2), .time = time, .lost = lost};
}

ConnectionEnd end_of_feed(bool is_final = false) {
  return {{FaultKind::link_lost, "camera \"a\": gone"}, is_final};
}

TEST(CameraFeed, GivesTheNewestFrameOnceAndCountsTheOthers) {
  const WallClock clock;
  std::atomic<bool> is_sent = false;
  CameraFeed feed("a", 30, clock, [&](CameraFeed& self) {
    for (int i = 0; i < 3; ++i) self.put(small_picture(i));
    self.put(small_picture(7, 4));
    is_sent = true;
    while (!self.sleep(60)) continue;
    return end_of_feed();
  });
  while (!is_sent) std::this_thread::yield();
  const auto frame = feed.newest();
  ASSERT_TRUE(frame && frame.value());
  EXPECT_EQ(frame.value()->number, 7);
  EXPECT_EQ(frame.value()->time, 7);
  EXPECT_FALSE(feed.newest().value());
  EXPECT_FALSE(feed.wait(0.01).value());
  EXPECT_EQ(feed.counts().frames, 4);
  EXPECT_EQ(feed.counts().lost, 4);
}

TEST(CameraFeed, ConnectsAgainUntilTheEndIsFinal) {
  const WallClock clock;
  int connections = 0;
  CameraFeed feed("a", 30, clock,
                  [&](CameraFeed& self) {
                    ++connections;
                    if (connections != 2) self.put(small_picture(connections));
                    return end_of_feed(connections == 4);
                  },
                  {.first_pause = 0.001, .longest_pause = 0.002});
  std::vector<Frame> frames;
  const double end = steady_seconds() + camera_patience;
  while (feed.counts().connections < 3 && steady_seconds() < end) (void)feed.wait(0.01);
  EXPECT_EQ(next_fault(feed), "link lost: camera \"a\": gone");
  EXPECT_EQ(feed.counts().frames, 3);
}

TEST(CameraFeed, RefusesATimeoutThatIsNotFinite) {
  const WallClock clock;
  CameraFeed feed("a", 30, clock, [](CameraFeed& self) {
    self.sleep(60);
    return end_of_feed();
  });
  EXPECT_EQ(feed.wait(std::numeric_limits<double>::infinity()).fault()->kind, FaultKind::refused);
}

TEST(FrameGaps, CountByTimes) {
  StampGaps gaps(25);
  EXPECT_EQ(gaps.lost_before(10), 0);
  EXPECT_EQ(gaps.lost_before(10.042), 0);
  EXPECT_EQ(gaps.lost_before(10.16), 2);
  EXPECT_EQ(gaps.lost_before(10.1), 0);
  // The camera turns out to give 10 frames per second.
  for (int i = 0; i < 20; ++i) (void)gaps.lost_before(20 + 0.1 * i);
  EXPECT_EQ(gaps.lost_before(22), 0);
  EXPECT_EQ(gaps.lost_before(22.3), 2);
}

TEST(FrameGaps, CountByNumbers) {
  NumberGaps gaps(1, 0xffff);
  EXPECT_EQ(gaps.lost_before(65530), 0);
  EXPECT_EQ(gaps.lost_before(65534), 3);
  EXPECT_EQ(gaps.lost_before(2), 2);
  EXPECT_EQ(gaps.lost_before(2), 0);
  EXPECT_EQ(gaps.lost_before(1), 0);
  EXPECT_EQ(gaps.lost_before(3), 1);
}

}  // namespace
}  // namespace flexura
