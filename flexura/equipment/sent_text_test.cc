#include "flexura/equipment/sent_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "flexura/equipment/cia402_codec.h"
#include "flexura/equipment/cia402_sdo.h"
#include "flexura/equipment/onvif_http.h"
#include "flexura/equipment/onvif_soap.h"

namespace flexura {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::StartsWith;

MATCHER_P2(Says, text, asks, "") { return arg.text == text && arg.asks == asks; }

TEST(SentText, OfGrblHasLinesAndRealtimeBytes) {
  EXPECT_THAT(grbl_sent("$J=G90G21G53X1F60\n"), ElementsAre(Says("$J=G90G21G53X1F60", false)));
  EXPECT_THAT(grbl_sent("$I\n"), ElementsAre(Says("$I", true)));
  // A realtime byte acts within a line, which goes on.
  EXPECT_THAT(grbl_sent("$$?\n"), ElementsAre(Says("? (status)", true), Says("$$", true)));
  EXPECT_THAT(grbl_sent("!"), ElementsAre(Says("! (hold)", false)));
  EXPECT_THAT(
      grbl_sent("\x18\x85~"),
      ElementsAre(Says("0x18 (reset)", false), Says("0x85 (cancel jog)", false), Says("~ (resume)", false)));
  EXPECT_THAT(grbl_sent(""), ElementsAre());
}

// The bytes are those of the EVI-D80/D90 technical manual.
TEST(SentText, OfViscaHasBytesAndMeaning) {
  const ViscaDigits digits;
  const std::string turn("\x81\x01\x06\x02\x18\x14\x00\x00\x0F\x00\x0F\x0F\x0F\x0E\xFF", 15);
  const SentText move = visca_sent(turn, ViscaFraming::stream, digits);
  EXPECT_EQ(move.text,
            "81 01 06 02 18 14 00 00 0F 00 0F 0F 0F 0E FF  head 1: pan to 240, tilt to -2, speeds 24 and 20");
  EXPECT_FALSE(move.asks);
  const SentText version = visca_sent(visca_packet(1, visca_ask_version()), ViscaFraming::datagram, digits);
  EXPECT_EQ(version.text, "81 09 00 02 FF  head 1: version?");
  EXPECT_TRUE(version.asks);
  const std::string sony =
      bytes_of(SonyMessage{SonyMessage::Kind::command, 7, visca_packet(1, visca_zoom(0x123))});
  EXPECT_THAT(visca_sent(sony, ViscaFraming::sony, digits).text, EndsWith("head 1, number 7: zoom to 291"));
  EXPECT_THAT(visca_sent("\x01", ViscaFraming::sony, digits).text, EndsWith("unknown"));
  EXPECT_THAT(visca_sent("hello", ViscaFraming::stream, digits).text, EndsWith("unknown"));
}

TEST(SentText, OfCanHasFrameAndMeaning) {
  EXPECT_EQ(can_sent(bytes_of(nmt_frame(NmtCommand::start, 3))).text, "000#0103              node 3: start");
  EXPECT_TRUE(can_sent(bytes_of(sync_frame())).asks);
  const auto write = SdoTransfer::writing(3, {0x6081, 0}, 2000, 4).request();
  EXPECT_EQ(can_sent(bytes_of(write)).text, "603#23816000D0070000  node 3: object 0x6081 = 0x000007D0");
  EXPECT_FALSE(can_sent(bytes_of(write)).asks);
  const auto read = can_sent(bytes_of(SdoTransfer::reading(3, {0x6041, 0}).request()));
  EXPECT_THAT(read.text, EndsWith("node 3: object 0x6041?"));
  EXPECT_TRUE(read.asks);
  CanFrame target{.id = cob::rpdo1 + 5};
  append(target, 0x3F, 2);
  append(target, static_cast<std::uint32_t>(-1234), 4);
  EXPECT_THAT(can_sent(bytes_of(target)).text, EndsWith("node 5: enable, start, target -1234"));
  EXPECT_THAT(can_sent("short").text, StartsWith("73 68"));
}

TEST(SentText, OfOnvifHasRequestAndPositions) {
  const auto sent = [](const std::string& body) {
    return onvif_sent(http_post("10.0.0.2:80", "/onvif/ptz", soap_message(body), true));
  };
  EXPECT_EQ(sent(onvif_move("main", {0.25, -0.5, 0.125}, onvif_generic_space, 0.5)).text,
            "AbsoluteMove pan 0.25, tilt -0.5, zoom 0.125, speed 0.5");
  EXPECT_EQ(sent(onvif_move("main", {1, 2, {}}, onvif_degree_space, {})).text, "AbsoluteMove pan 1, tilt 2");
  EXPECT_EQ(sent(onvif_stop("main")).text, "Stop");
  EXPECT_FALSE(sent(onvif_stop("main")).asks);
  EXPECT_EQ(sent(onvif_ask_status("main")).text, "GetStatus?");
  EXPECT_TRUE(sent(onvif_ask_status("main")).asks);
  EXPECT_EQ(onvif_sent("GET / HTTP/1.1\r\n\r\n").text, "unknown");
}

}  // namespace
}  // namespace flexura
