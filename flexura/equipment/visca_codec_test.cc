#include "flexura/equipment/visca_codec.h"

#include <gtest/gtest.h>

#include <string>

#include "flexura/base/degree.h"
#include "flexura/base/node.h"
#include "flexura/base/source.h"
#include "flexura/base/table.h"
#include "flexura/equipment/visca_config.h"

namespace flexura {
namespace {

// Returns the bytes of a text such as "90 41 FF".
std::string visca_hex(std::string_view text) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 3)
    bytes.push_back(static_cast<char>(std::stoi(std::string(text.substr(i, 2)), nullptr, 16)));
  return bytes;
}

// Sony EVI-H100S/H100V technical manual, page 29, "VISCA Command/ACK Protocol".
TEST(ViscaCodec, ReadsTheRepliesOfTheManual) {
  EXPECT_EQ(parse_visca_reply(visca_hex("90 41 FF")), (ViscaReply{ViscaReply::Kind::accepted, 1, 1, 0, {}}));
  EXPECT_EQ(parse_visca_reply(visca_hex("90 52 FF")), (ViscaReply{ViscaReply::Kind::ended, 1, 2, 0, {}}));
  EXPECT_EQ(parse_visca_reply(visca_hex("90 60 02 FF")), (ViscaReply{ViscaReply::Kind::error, 1, 0, 2, {}}));
  EXPECT_EQ(parse_visca_reply(visca_hex("90 60 03 FF")), (ViscaReply{ViscaReply::Kind::error, 1, 0, 3, {}}));
  EXPECT_EQ(parse_visca_reply(visca_hex("90 61 41 FF")),
            (ViscaReply{ViscaReply::Kind::error, 1, 1, 0x41, {}}));
  EXPECT_EQ(parse_visca_reply(visca_hex("A0 62 04 FF")), (ViscaReply{ViscaReply::Kind::error, 2, 2, 4, {}}));
  EXPECT_EQ(parse_visca_reply(visca_hex("90 50 02 FF")),
            (ViscaReply{ViscaReply::Kind::answer, 1, 0, 0, "\x02"}));
  EXPECT_EQ(parse_visca_reply(visca_hex("88 30 03 FF")),
            (ViscaReply{ViscaReply::Kind::addresses, 0, 0, 3, {}}));
  EXPECT_EQ(parse_visca_reply(visca_hex("88 01 00 01 FF")),
            (ViscaReply{ViscaReply::Kind::cleared, 0, 0, 0, {}}));
  EXPECT_EQ(parse_visca_reply(visca_hex("F0 38 FF")),
            (ViscaReply{ViscaReply::Kind::chain_changed, 7, 0, 0, {}}));
}

TEST(ViscaCodec, WritesWhatItReads) {
  for (const char* packet : {"90 41 FF", "90 52 FF", "A0 60 03 FF", "90 50 00 01 0F 0A FF", "88 30 03 FF",
                             "88 01 00 01 FF", "C0 38 FF"})
    EXPECT_EQ(bytes_of(*parse_visca_reply(visca_hex(packet))), visca_hex(packet)) << packet;
}

TEST(ViscaCodec, RefusesOtherPackets) {
  for (const char* packet : {"90 FF", "90 41", "91 41 FF", "81 09 06 12 FF", "88 30 01 FF", "88 30 09 FF",
                             "90 30 01 FF", "90 41 00 FF", "90 60 FF", "90 60 02 00 FF"})
    EXPECT_FALSE(parse_visca_reply(visca_hex(packet))) << packet;
}

// The same manual, "Address Set" and "IF_Clear"; Sony EVI-D80 manual, page 24, "CAM_VersionInq".
TEST(ViscaCodec, WritesTheCommandsOfTheManuals) {
  EXPECT_EQ(visca_packet(visca_everyone, visca_set_addresses()), visca_hex("88 30 01 FF"));
  EXPECT_EQ(visca_packet(visca_everyone, visca_clear()), visca_hex("88 01 00 01 FF"));
  EXPECT_EQ(visca_packet(1, visca_cancel(2)), visca_hex("81 22 FF"));
  EXPECT_EQ(visca_packet(3, visca_ask_version()), visca_hex("83 09 00 02 FF"));
  EXPECT_EQ(visca_packet(1, visca_ask_move()), visca_hex("81 09 06 12 FF"));
  EXPECT_EQ(visca_packet(1, visca_ask_zoom()), visca_hex("81 09 04 47 FF"));
  EXPECT_EQ(visca_packet(1, visca_zoom(0x4000)), visca_hex("81 01 04 47 04 00 00 00 FF"));
  EXPECT_EQ(visca_packet(1, visca_zoom_stop()), visca_hex("81 01 04 07 00 FF"));
  EXPECT_EQ(visca_packet(1, visca_move_stop(24, 20)), visca_hex("81 01 06 01 18 14 03 03 FF"));
  const ViscaVersion version{0x0001, 0x050C, 0x0100, 2};
  EXPECT_EQ(parse_visca_version(visca_hex("00 01 05 0C 01 00 02")), version);
  EXPECT_EQ(visca_version_data(version), visca_hex("00 01 05 0C 01 00 02"));
}

// Telycam TLC-700-S manual, page 16: pan -170 degrees is F670h, tilt 90 degrees is 0510h.
TEST(ViscaCodec, HasPositionsOfFourDigits) {
  EXPECT_EQ(visca_packet(1, visca_move(24, 20, -2448, 1296, {})),
            visca_hex("81 01 06 02 18 14 0F 06 07 00 00 05 01 00 FF"));
  EXPECT_EQ(parse_visca_place(visca_hex("0F 06 07 00 00 05 01 00"), {}), (ViscaPlace{-2448, 1296}));
  EXPECT_FALSE(parse_visca_place(visca_hex("0F 06 07 10 00 05 01 00"), {}));
  EXPECT_FALSE(parse_visca_place(visca_hex("0F 06 07 00 00 05 01"), {}));
}

// Sony BRC-H700 command list, page 12: pan has five digits, 08A58h at the left end, F75A8h at the right; tilt
// has four, 493Dh at the upper end, E796h at the lower. The tilt's speed byte is 0.
TEST(ViscaCodec, HasPositionsOfFiveDigits) {
  const ViscaDigits digits{5, 4};
  EXPECT_EQ(visca_packet(1, visca_move(24, 0, -0x8A58, 0x493D, digits)),
            visca_hex("81 01 06 02 18 00 0F 07 05 0A 08 04 09 03 0D FF"));
  EXPECT_EQ(parse_visca_place(visca_hex("00 08 0A 05 08 0E 07 09 06"), digits),
            (ViscaPlace{0x8A58, -0x186A}));
}

TEST(ViscaCodec, SplitsAStreamAtAnyPlace) {
  const std::string stream = visca_hex("90 41 FF 90 50 01 02 03 04 FF A0 51 FF");
  for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
    ViscaSplitter splitter;
    auto packets = splitter.take(std::string_view(stream).substr(0, cut));
    for (const auto& more : splitter.take(std::string_view(stream).substr(cut))) packets.push_back(more);
    EXPECT_EQ(packets, (std::vector<std::string>{visca_hex("90 41 FF"), visca_hex("90 50 01 02 03 04 FF"),
                                                 visca_hex("A0 51 FF")}));
  }
}

TEST(ViscaCodec, DropsNoiseUpToTheNextEnd) {
  ViscaSplitter splitter;
  EXPECT_TRUE(splitter.take(visca_hex("FF FF 41 FF 90 FF")).empty());
  EXPECT_TRUE(splitter.take(std::string(100000, '\x90')).empty());
  EXPECT_TRUE(splitter.take("\xFF").empty());
  EXPECT_EQ(splitter.take(visca_hex("90 41 FF")).size(), 1U);
}

// Sony SRG-300H/301H manual, pages 30 to 32, "VISCA over IP".
TEST(ViscaCodec, HasTheHeaderOfTheManual) {
  const SonyMessage inquiry{SonyMessage::Kind::inquiry, 0x01020304, visca_hex("81 09 04 47 FF")};
  EXPECT_EQ(bytes_of(inquiry), visca_hex("01 10 00 05 01 02 03 04 81 09 04 47 FF"));
  EXPECT_EQ(bytes_of(SonyMessage{SonyMessage::Kind::control, 0, std::string(sony_reset)}),
            visca_hex("02 00 00 01 00 00 00 00 01"));
  const auto reply = parse_sony(visca_hex("01 11 00 03 FF FF FF FF 90 41 FF"));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->kind, SonyMessage::Kind::reply);
  EXPECT_EQ(reply->sequence, 0xFFFFFFFFU);
  EXPECT_EQ(reply->payload, visca_hex("90 41 FF"));
  EXPECT_EQ(parse_sony(visca_hex("02 01 00 02 00 00 00 07 0F 01"))->payload, sony_bad_sequence);
  for (const char* datagram : {"01 11 00 03 00 00 00 01 90 41", "01 11 00 02 00 00 00 01 90 41 FF",
                               "01 12 00 03 00 00 00 01 90 41 FF", "01 11 00 00 00 00 00 01", "01 11"})
    EXPECT_FALSE(parse_sony(visca_hex(datagram))) << datagram;
}

TEST(ViscaCodec, ADeviceReadsRequests) {
  using Asked = ViscaRequest::Kind;
  const auto kind = [](const char* packet) { return parse_visca_request(visca_hex(packet), {})->kind; };
  EXPECT_EQ(kind("88 30 01 FF"), Asked::set_addresses);
  EXPECT_EQ(kind("81 01 06 01 18 14 02 03 FF"), Asked::drive);
  EXPECT_EQ(kind("81 01 06 04 FF"), Asked::home);
  EXPECT_EQ(kind("81 01 04 07 27 FF"), Asked::zoom_drive);
  EXPECT_EQ(kind("81 01 04 38 FF"), Asked::unknown);
  EXPECT_EQ(kind("81 01 06 02 19 14 00 00 00 00 00 00 00 00 FF"), Asked::unknown);  // Too fast.
  EXPECT_FALSE(parse_visca_request(visca_hex("90 41 FF"), {}));
  const auto move = parse_visca_request(visca_packet(2, visca_move(1, 2, -3, 4, {5, 5})), {5, 5});
  EXPECT_EQ(move->kind, Asked::move);
  EXPECT_EQ(move->to, 2);
  EXPECT_EQ(move->place, (ViscaPlace{-3, 4}));
}

ViscaConfig visca_on(std::string link) {
  ViscaConfig config;
  config.bus.link = std::move(link);
  return config;
}

TEST(ViscaConfig, ConvertsAnglesAndZoom) {
  ViscaConfig config = visca_on("/dev/ttyUSB0@9600");
  EXPECT_EQ(visca_counts(config, {-45 * degree, 30 * degree, 1000}), (ViscaCounts{648, 432, 1000}));
  EXPECT_EQ(visca_counts(config, {-1e300, 1e300, -1e300}), (ViscaCounts{2448, 1296, 0}));  // Clamped.
  const HeadState state = visca_state(config, {-1296, 432, 0x4000});
  EXPECT_NEAR(state.pan, 90 * degree, 1e-12);
  EXPECT_NEAR(state.tilt, 30 * degree, 1e-12);
  EXPECT_EQ(state.zoom, 0x4000);
  config.pan.zero = 100;
  EXPECT_EQ(visca_counts(config, {}).pan, 100);
  config.zoom.counts = {0, 0x1000, 0x4000};
  config.zoom.positions = {1, 2, 10};
  EXPECT_EQ(visca_counts(config, {0, 0, 1.5}).zoom, 0x800);
  EXPECT_EQ(visca_counts(config, {0, 0, 6}).zoom, 0x2800);
  EXPECT_EQ(visca_counts(config, {0, 0, 11}).zoom, 0x4000);
  EXPECT_DOUBLE_EQ(visca_state(config, {0, 0, 0x2800}).zoom, 6);
}

TEST(ViscaConfig, ChoosesTheFramingByTheAddress) {
  EXPECT_EQ(visca_framing({.link = "/dev/ttyUSB0@9600"}), ViscaFraming::stream);
  EXPECT_EQ(visca_framing({.link = "tcp:head:5678"}), ViscaFraming::stream);
  EXPECT_EQ(visca_framing({.link = "udp:head:52381"}), ViscaFraming::sony);
  EXPECT_EQ(visca_framing({.link = "udp:head:1259"}), ViscaFraming::datagram);
  EXPECT_TRUE(visca_sets_addresses({.link = "/dev/ttyUSB0@9600"}));
  EXPECT_FALSE(visca_sets_addresses({.link = "tcp:head:5678"}));
}

TEST(ViscaConfig, SaysWhatIsWrong) {
  EXPECT_EQ(visca_problem(visca_on("/dev/ttyUSB0@9600")), "");
  EXPECT_NE(visca_problem(visca_on("here")), "");
  ViscaConfig config = visca_on("udp:head:52381");
  config.address = 2;
  EXPECT_EQ(visca_problem(config), "address: a head without a serial line has address 1");
  config = visca_on("/dev/ttyUSB0");
  config.pan.limits = {-40000, 0};
  EXPECT_EQ(visca_problem(config), "pan.limits: expected the smaller count first, and counts of 4 digits");
  config.pan.digits = 5;
  EXPECT_EQ(visca_problem(config), "");
  config.zoom.positions = {1, 2, 3};
  EXPECT_EQ(visca_problem(config), "zoom.positions: expected one position per count");
  config.zoom.positions = {2, 1};
  EXPECT_EQ(visca_problem(config), "zoom.positions: expected ascending numbers");
}

TEST(ViscaConfig, IsWrittenToAndReadFromAFile) {
  ViscaConfig config = visca_on("udp:10.0.0.2:52381");
  config.pan.digits = 5;
  config.zoom.positions = {1, 12};
  config.bus.framing = ViscaFraming::datagram;
  const auto read = read_as<ViscaConfig>(fields_of(&config).write(config));
  EXPECT_EQ(read.pan.digits, 5);
  EXPECT_EQ(read.zoom.positions, config.zoom.positions);
  EXPECT_EQ(read.bus.framing, ViscaFraming::datagram);
  config.bus.link = "nowhere";
  EXPECT_THROW((void)read_as<ViscaConfig>(fields_of(&config).write(config)), InputError);
}

TEST(ViscaConfig, HasMessagesToStop) {
  const StopMessages serial = visca_stop(visca_on("/dev/ttyUSB0"));
  EXPECT_EQ(serial.first,
            (std::vector<std::string>{visca_hex("81 01 06 01 18 14 03 03 FF"), visca_hex("81 01 04 07 00 FF"),
                                      visca_hex("81 01 00 01 FF")}));
  EXPECT_EQ(serial.then.size(), 2U);
  const StopMessages sony = visca_stop(visca_on("udp:head:52381"));
  ASSERT_EQ(sony.first.size(), 5U);
  EXPECT_EQ(sony.first[1], visca_hex("01 00 00 09 00 00 00 01 81 01 06 01 18 14 03 03 FF"));
}

}  // namespace
}  // namespace flexura
