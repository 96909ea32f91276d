#include <gtest/gtest.h>

#include <string>

#include "flexura/base/table.h"
#include "flexura/equipment/aravis_camera.h"
#include "flexura/equipment/gstreamer_camera.h"
#include "flexura/equipment/v4l2_camera.h"
#include "flexura/equipment/v4l2_head.h"
#include "flexura/equipment/wall_clock.h"

namespace flexura {
namespace {

TEST(MissingDrivers, AreNamedWithTheirPackages) {
  const WallClock clock;
  if (!has_gstreamer()) {
    EXPECT_NE(text(*open_gstreamer_camera({}, {}, clock).fault()).find("libgstreamer1.0-dev"),
              std::string::npos);
  }
  if (!has_aravis()) {
    EXPECT_NE(text(*open_aravis_camera({}, {}, clock).fault()).find("libaravis-dev"), std::string::npos);
  }
}

TEST(CameraTables, HaveEveryField) {
  EXPECT_EQ(fields_of(static_cast<const GStreamerConfig*>(nullptr)).info().fields.size(), 5U);
  EXPECT_EQ(fields_of(static_cast<const AravisConfig*>(nullptr)).info().fields.size(), 7U);
  EXPECT_EQ(fields_of(static_cast<const V4l2Config*>(nullptr)).info().fields.size(), 6U);
  EXPECT_EQ(fields_of(static_cast<const V4l2HeadConfig*>(nullptr)).info().fields.size(), 3U);
}

TEST(GStreamerPipeline, QuotesTheAddress) {
  EXPECT_EQ(
      gstreamer_pipeline({.source = "videotestsrc"}, {}),
      "videotestsrc ! videoconvert ! video/x-raw,format=GRAY8 ! appsink name=flexura_sink max-buffers=2 "
      "drop=true");
  const std::string text = gstreamer_pipeline({.source = "rtsp://h/a\"b"}, {});
  EXPECT_NE(text.find(R"(location="rtsp://h/a\"b" protocols=tcp latency=50)"), std::string::npos) << text;
}

}  // namespace
}  // namespace flexura
