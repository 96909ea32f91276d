#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/bytes.h"
#include "flexura/base/degree.h"
#include "flexura/equipment/onvif_answers.h"
#include "flexura/equipment/onvif_config.h"
#include "flexura/equipment/onvif_http.h"
#include "flexura/equipment/onvif_soap.h"

namespace flexura {
namespace {

// The example of the ONVIF Application Programmer's Guide 1.0.
TEST(OnvifSoap, DigestEqualsThatOfTheGuide) {
  const std::string nonce = from_base64("LKqI6G/AikKCQrN0zqZFlg==").value();
  EXPECT_EQ(onvif_digest(nonce, "2010-09-16T07:50:45Z", "userpassword"), "tuOSpGlFlIXsozq4HFNeeGeFLEI=");
}

// FIPS 180-4's examples of SHA-1.
TEST(OnvifSoap, DigestIsSha1) {
  const auto hex = [](const std::string& text) {
    std::string made;
    const std::string bytes = from_base64(text).value();
    for (const char c : bytes) made += fmt::format("{:02x}", static_cast<unsigned char>(c));
    return made;
  };
  EXPECT_EQ(hex(onvif_digest("a", "b", "c")), "a9993e364706816aba3e25717850c26c9cd0d89d");
  EXPECT_EQ(hex(onvif_digest("abcdbcdecdefdefgefghfghi", "ghijhijkijkljklmklmn", "lmnomnopnopq")),
            "84983e441c3bd26ebaae4aa1f95129e5e54670f1");
}

TEST(OnvifSoap, TimesAreUtc) {
  EXPECT_EQ(onvif_time_text(0), "1970-01-01T00:00:00.000Z");
  EXPECT_EQ(onvif_time_text(951782399.999), "2000-02-28T23:59:59.999Z");
  EXPECT_EQ(parse_onvif_time("2000-02-29T00:00:00Z"), 951782400);
  EXPECT_EQ(onvif_time_text(-1e300), "1970-01-01T00:00:00.000Z");
  EXPECT_TRUE(onvif_time_text(1e300).starts_with("9999-12-31"));
  std::mt19937_64 random(7);
  std::uniform_int_distribution<std::int64_t> ms(0, 253402300799000);
  for (int i = 0; i < 1000; ++i) {
    const double time = static_cast<double>(ms(random)) / 1000;
    EXPECT_NEAR(parse_onvif_time(onvif_time_text(time)).value(), time, 2e-3) << onvif_time_text(time);
  }
  for (const char* bad : {"", "Z", "2001-02-29T00:00:00Z", "2000-02-29T24:00:00Z", "2000-02-29 00:00:00Z",
                          "2000-02-29T00:00:00", "2000-13-01T00:00:00Z", "2000-02-29T00:00:-1Z",
                          "2000-02-29T00:00:1e1Z", "-200-02-29T00:00:00Z"})
    EXPECT_EQ(parse_onvif_time(bad), std::nullopt) << bad;
}

TEST(OnvifSoap, RequestsAreReadAsWritten) {
  const OnvifToken token{"a<&\"b", "digest=", "nonce==", "2000-02-29T00:00:00.000Z"};
  const auto move = parse_onvif_request(
      soap_message(onvif_move("p&1", {0.25, -0.5, 0.75}, onvif_degree_space, 0.5), token));
  ASSERT_TRUE(move && move->token);
  EXPECT_EQ(move->name, "AbsoluteMove");
  EXPECT_EQ(move->token->user, token.user);
  EXPECT_EQ(move->token->digest, token.digest);
  EXPECT_EQ(move->token->nonce, token.nonce);
  EXPECT_EQ(move->token->created, token.created);
  EXPECT_EQ(move->profile, "p&1");
  EXPECT_EQ(move->pan, 0.25);
  EXPECT_EQ(move->tilt, -0.5);
  EXPECT_EQ(move->zoom, 0.75);
  EXPECT_EQ(move->turn_space, onvif_degree_space);
  EXPECT_EQ(move->speed, 0.5);
  const auto stop = parse_onvif_request(soap_message(onvif_stop("p")));
  ASSERT_TRUE(stop);
  EXPECT_EQ(stop->name, "Stop");
  EXPECT_TRUE(stop->stops_turn && stop->stops_zoom && !stop->token);
  EXPECT_EQ(parse_onvif_request("<a/>"), std::nullopt);
}

TEST(OnvifSoap, AnswersAreReadAsWritten) {
  EXPECT_EQ(parse_onvif_clock(soap_message(onvif_clock_answer(951782399.7))), 951782399);
  const auto fault = parse_soap_fault(soap_fault("NotAuthorized", "no"));
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->code, "NotAuthorized");
  EXPECT_EQ(fault->reason, "no");
  for (const std::string& answer : {onvif_services_answer("h:1"), onvif_capabilities_answer("h:1")}) {
    const auto services = parse_onvif_services(soap_message(answer));
    ASSERT_TRUE(services);
    EXPECT_EQ(services->ptz, "/onvif/ptz_service");
    EXPECT_EQ(services->media, "/onvif/media_service");
  }
  const auto profiles = parse_onvif_profiles(soap_message(onvif_fixed_answer("GetProfiles", "h").value()));
  ASSERT_TRUE(profiles && profiles->size() == 1);
  EXPECT_TRUE((*profiles)[0].has_head);
  EXPECT_EQ((*profiles)[0].node, "node_1");
  const auto status =
      parse_onvif_status(soap_message(onvif_status_answer({0.5, -1, 0.25}, onvif_generic_space, true, 0)));
  ASSERT_TRUE(status && status->place);
  EXPECT_EQ(status->place->pan, 0.5);
  EXPECT_EQ(status->place->tilt, -1);
  EXPECT_EQ(status->place->zoom, 0.25);
  EXPECT_EQ(status->turn_space, onvif_generic_space);
  EXPECT_EQ(status->is_moving, true);
  EXPECT_EQ(status->error, "");
}

// Of other cameras: other prefixes, SOAP 1.1 faults, invalid numbers, empty answers.
TEST(OnvifSoap, ReadsOtherSpellingsAndRefusesNumbersThatAreNone) {
  const auto old = parse_soap_fault(
      "<SOAP-ENV:Envelope><SOAP-ENV:Body><SOAP-ENV:Fault><faultcode>SOAP-ENV:Client</faultcode>"
      "<faultstring>bad</faultstring></SOAP-ENV:Fault></SOAP-ENV:Body></SOAP-ENV:Envelope>");
  ASSERT_TRUE(old);
  EXPECT_EQ(old->code, "Client");
  EXPECT_EQ(old->reason, "bad");
  const auto with = [](const std::string& inside) {
    return parse_onvif_status("<E:Envelope><E:Body><GetStatusResponse><PTZStatus>" + inside +
                              "</PTZStatus></GetStatusResponse></E:Body></E:Envelope>");
  };
  EXPECT_TRUE(with("<Position><x:PanTilt x='+1.5E-1' y=' 2 '/></Position>")->place.has_value());
  for (const char* bad : {"nan", "inf", "1e999", "", "0x1", "1,5"})
    EXPECT_FALSE(with(fmt::format("<Position><PanTilt x='{}' y='0'/></Position>", bad))->place.has_value())
        << bad;
  EXPECT_FALSE(with("")->place.has_value());
  EXPECT_EQ(with("<MoveStatus><PanTilt>IDLE</PanTilt><Zoom>MOVING</Zoom></MoveStatus>")->is_moving, true);
  EXPECT_EQ(with("<MoveStatus><PanTilt>IDLE</PanTilt></MoveStatus>")->is_moving, false);
  EXPECT_EQ(with("<MoveStatus><PanTilt>UNKNOWN</PanTilt></MoveStatus>")->is_moving, std::nullopt);
  EXPECT_EQ(parse_onvif_status("<Envelope><Body/></Envelope>"), std::nullopt);
  EXPECT_EQ(parse_onvif_status("\x01\x02"), std::nullopt);
}

HttpReader reader_of(std::string_view bytes) {
  HttpReader reader(HttpReader::Side::replies);
  reader.put(bytes);
  return reader;
}

TEST(OnvifHttp, RepliesArriveInAnyPieces) {
  const std::string body(2500, 'x');
  for (const bool is_chunked : {false, true}) {
    const std::string text = "HTTP/1.1 100 Continue\r\n\r\n" + http_reply(400, body, true, is_chunked) +
                             http_reply(200, "<a/>", false, is_chunked);
    for (const std::size_t piece : {1U, 7U, 100U, 100000U}) {
      HttpReader reader(HttpReader::Side::replies);
      std::vector<HttpMessage> found;
      for (std::size_t i = 0; i < text.size(); i += piece) {
        reader.put(std::string_view(text).substr(i, piece));
        while (auto reply = reader.next()) found.push_back(*reply);
      }
      ASSERT_EQ(found.size(), 2U) << reader.problem();
      EXPECT_EQ(found[0].status, 400);
      EXPECT_EQ(found[0].body, body);
      EXPECT_TRUE(found[0].keeps_open);
      EXPECT_EQ(found[1].body, "<a/>");
      EXPECT_FALSE(found[1].keeps_open);
    }
  }
}

TEST(OnvifHttp, RequestsAreReadAsWritten) {
  HttpReader reader(HttpReader::Side::requests);
  reader.put(http_post("camera:80", "/onvif/ptz_service", "<a/>", true));
  const auto request = reader.next();
  ASSERT_TRUE(request);
  EXPECT_EQ(request->method, "POST");
  EXPECT_EQ(request->target, "/onvif/ptz_service");
  EXPECT_EQ(request->body, "<a/>");
  EXPECT_TRUE(request->keeps_open);
}

TEST(OnvifHttp, DamagedAndHugeRepliesAreProblems) {
  for (const std::string& bad :
       {std::string("\x01\x02 garbage\r\n\r\n"),
        std::string("HTTP/1.1 200 OK\r\nContent-Length: 99999999\r\n\r\n"),
        std::string("HTTP/1.1 200 OK\r\nContent-Length: 3\r\nContent-Length: 4\r\n\r\nabcd"),
        "HTTP/1.1 200 OK\r\nX: " + std::string(20000, 'x'),
        std::string("HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n"),
        http_reply(200, std::string(2 << 20, 'x'), true)}) {
    HttpReader reader = reader_of(bad);
    EXPECT_EQ(reader.next(), std::nullopt);
    EXPECT_NE(reader.problem(), "") << bad.substr(0, 60);
  }
  HttpReader cut = reader_of("HTTP/1.1 200 OK\r\nContent-Length: 10\r\n\r\nabc");
  EXPECT_EQ(cut.next(), std::nullopt);
  EXPECT_EQ(cut.problem(), "");
  cut.close();
  EXPECT_EQ(cut.next(), std::nullopt);
  EXPECT_NE(cut.problem(), "");
  HttpReader unmarked = reader_of("HTTP/1.1 200 OK\r\n\r\nabc");
  EXPECT_EQ(unmarked.next(), std::nullopt);
  unmarked.close();
  EXPECT_EQ(unmarked.next().value().body, "abc");
}

TEST(OnvifConfig, ConvertsBothWays) {
  OnvifConfig config;
  config.link = "tcp:camera:80";
  config.pan.zero = 0.1, config.zoom.points = {0, 0.5, 1};
  config.zoom.positions = {1, 4, 20};
  ASSERT_EQ(onvif_problem(config), "");
  const OnvifRanges ranges{{-1, 1}, {-0.5, 1}, true};
  for (const OnvifPositions space : {OnvifPositions::generic, OnvifPositions::degrees}) {
    config.space = space;
    const OnvifRanges wide{{-180, 180}, {-90, 90}, true};
    const HeadState state{-30 * degree, 20 * degree, 3};
    const OnvifPlace place = onvif_place(config, space == OnvifPositions::generic ? ranges : wide, state);
    const HeadState back = onvif_state(config, place);
    EXPECT_NEAR(back.pan, state.pan, 1e-12);
    EXPECT_NEAR(back.tilt, state.tilt, 1e-12);
    EXPECT_NEAR(back.zoom, state.zoom, 1e-12);
    const double unit = space == OnvifPositions::generic ? 180 : 1;
    EXPECT_NEAR(place.pan, 0.1 + 30 / unit, 1e-12) << "positive to the right";
    EXPECT_NEAR(place.tilt, 20 / (space == OnvifPositions::generic ? 90.0 : 1.0), 1e-12);
    EXPECT_NEAR(place.zoom.value(), 1.0 / 3, 1e-12);
  }
  config.space = OnvifPositions::generic;
  const OnvifPlace clamped = onvif_place(config, ranges, {-9, -9, 99});
  EXPECT_EQ(clamped.pan, 1);
  EXPECT_EQ(clamped.tilt, -0.5);
  EXPECT_EQ(clamped.zoom, 1);
}

TEST(OnvifConfig, ProblemsAreNamed) {
  const auto with = [](auto change) {
    OnvifConfig config;
    config.link = "tcp:camera:80";
    change(config);
    return onvif_problem(config);
  };
  EXPECT_EQ(with([](OnvifConfig&) {}), "");
  EXPECT_EQ(with([](OnvifConfig& c) { c.link = "udp:camera:80"; }), "link: expected tcp:HOST:PORT");
  EXPECT_EQ(with([](OnvifConfig& c) { c.user = "a"; }), "user: expected user and password_file, or neither");
  EXPECT_EQ(with([](OnvifConfig& c) { c.path = "/a b"; }),
            "path: expected a path such as /onvif/device_service");
  EXPECT_EQ(with([](OnvifConfig& c) { c.tilt.per_degree = 0; }),
            "tilt.per_degree: expected a number other than 0");
  EXPECT_EQ(with([](OnvifConfig& c) { c.pan.limits = {1, -1}; }),
            "pan.limits: expected the smaller position first");
  EXPECT_EQ(with([](OnvifConfig& c) { c.zoom.points = {1, 1}; }),
            "zoom.points: expected 2 or more ascending numbers");
  EXPECT_EQ(with([](OnvifConfig& c) { c.speed = 0; }), "speed: expected more than 0, at most 1");
}

}  // namespace
}  // namespace flexura
