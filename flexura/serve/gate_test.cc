#include "flexura/serve/gate.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "flexura/serve/token.h"

namespace flexura {
namespace {

using Texts = std::vector<std::string>;

const std::string gate_token = "00112233445566778899aabbccddeeff";

Gate gate() { return {8421, {"Lab.example", "tunnel:9000", "[::1]"}, gate_token}; }

RequestHead head(const std::string& lines) {
  return std::get<RequestHead>(parse_request_head("GET / HTTP/1.1\r\nHost: a\r\n" + lines));
}

TEST(Gate, KnowsItsOwnNamesWithTheirPorts) {
  for (const std::string& host : Texts{"127.0.0.1:8421", "localhost:8421", "LOCALHOST:8421",
                                       "lab.example:8421", "tunnel:9000", "[::1]:8421"}) {
    EXPECT_TRUE(gate().knows_host(host, "127.0.0.1")) << host;
  }
  EXPECT_TRUE(gate().knows_host("[fe80::1]:8421", "fe80::1"));
  EXPECT_TRUE(Gate(80, {"lab"}, gate_token).knows_host("lab", "127.0.0.1"));
}

TEST(Gate, IsCalledLocalhostByThoseOnThisMachineOnly) {
  EXPECT_TRUE(gate().knows_host("localhost:8421", "127.0.0.5"));
  EXPECT_TRUE(gate().knows_host("localhost:8421", "::1"));
  EXPECT_TRUE(gate().knows_origin("http://localhost:8421", "::1"));
  EXPECT_FALSE(gate().knows_host("localhost:8421", "192.168.1.5"));
  EXPECT_FALSE(gate().knows_host("localhost:8421", "fe80::1"));
}

TEST(Gate, KnowsNoOtherHost) {
  for (const std::string& host :
       Texts{"", "evil.example", "evil.example:8421", "localhost", "localhost:80", "localhost:84210",
             "localhost:8421.evil.example", "localhost.:8421", "localhost:8421 ", "127.0.0.1", "127.1:8421",
             "2130706433:8421", "10.0.0.1:8421", "tunnel:8421", "user@localhost:8421",
             "localhost:8421,evil.example", "::1:8421", "[::1]", "xlocalhost:8421"}) {
    EXPECT_FALSE(gate().knows_host(host, "127.0.0.1")) << host;
  }
}

TEST(Gate, TellsANameFromWhatIsNone) {
  for (const std::string& host :
       Texts{"localhost", "Lab.example", "a", "lab-2.uni_x.example", "tunnel:9000", "tunnel:65535",
             "192.168.0.7", "192.168.0.7:80", "[::1]", "[fe80::1]:8421", "xn--bcher-kva.example",
             std::string(63, 'a') + ".example"}) {
    EXPECT_TRUE(is_host(host)) << host;
    const bool has_port = !host.ends_with(']') && host.find(':') != std::string::npos;
    EXPECT_TRUE(Gate(8421, {host}, gate_token).knows_host(has_port ? host : host + ":8421", "10.0.0.1"))
        << host;
  }
  for (const std::string& host :
       Texts{"",
             " ",
             "a b",
             " lab",
             "lab ",
             "x:99999",
             "x:65536",
             "x:0",
             "x:",
             "x:8a",
             "x:+1",
             "x:-1",
             "x: 1",
             "x:80:80",
             ":8421",
             "http://x",
             "http://x:80",
             "x/",
             "x/y",
             "user@x",
             ".",
             ".x",
             "x.",
             "a..b",
             "-x",
             "x-",
             "a.-b",
             "::1",
             "[::1",
             "[]",
             "[x]",
             "[::1]x",
             "[::1]:0",
             "[127.0.0.1]",
             "x?",
             "x#",
             "x%2e",
             "b\u00fccher",
             "x,y",
             "*.example",
             std::string("x\0y", 3),
             std::string(64, 'a'),
             std::string(50, 'a') + '.' + std::string(63, 'b') + '.' + std::string(63, 'c') + '.' +
                 std::string(63, 'd') + '.' + std::string(11, 'e')}) {
    EXPECT_FALSE(is_host(host)) << host;
  }
}

TEST(Gate, KnowsItsOwnPagesOnly) {
  EXPECT_TRUE(gate().knows_origin("http://localhost:8421", "127.0.0.1"));
  EXPECT_TRUE(gate().knows_origin("http://127.0.0.1:8421", "127.0.0.1"));
  for (const std::string& origin :
       Texts{"", "null", "http://", "http://evil.example", "http://localhost", "http://localhost:8422",
             "https://localhost:8421", "localhost:8421", "http://localhost:8421/",
             "http://localhost:8421.evil.example", "HTTP://localhost:8421",
             "http://localhost:8421 http://evil.example", "file://"}) {
    EXPECT_FALSE(gate().knows_origin(origin, "127.0.0.1")) << origin;
  }
}

TEST(Gate, TakesTheTokenFromTheHeader) {
  EXPECT_TRUE(gate().has_token(head("Authorization: Bearer " + gate_token)));
  EXPECT_TRUE(gate().has_token(head("Authorization: bearer   " + gate_token)));
  for (const std::string& value :
       Texts{"Bearer", "Bearer ", gate_token, "Basic " + gate_token, "Bearer " + gate_token + "0",
             "Bearer " + gate_token.substr(1), "Bearer 00112233445566778899AABBCCDDEEFF",
             "Bearer  x" + gate_token, "Bearer, " + gate_token}) {
    EXPECT_FALSE(gate().has_token(head("Authorization: " + value))) << value;
  }
  EXPECT_FALSE(gate().has_token(head("X: " + gate_token)));
}

TEST(Gate, NamesTheCookieByThePortThatThePageKnows) {
  const std::string rest = "=" + gate_token + "; Path=/; HttpOnly; SameSite=Strict";
  EXPECT_EQ(gate().cookie("lab.example:8421"), "flexura_8421" + rest);
  EXPECT_EQ(gate().cookie("tunnel:9000"), "flexura_9000" + rest);
  EXPECT_EQ(gate().cookie("[::1]"), "flexura_80" + rest);
}

TEST(Gate, TakesTheTokenFromACookie) {
  for (const std::string& value :
       Texts{"flexura_8421=" + gate_token, "a=b; flexura_8421=" + gate_token + "; c",
             "flexura_8421=wrong;flexura_9000=" + gate_token, ";;flexura_8421=" + gate_token + ";"}) {
    EXPECT_TRUE(gate().has_token(head("Cookie: " + value))) << value;
  }
  for (const std::string& value :
       Texts{"", ";", "=", "flexura_8421", "flexura_8421=", "flexura_8421=\"" + gate_token + "\"",
             "flexura_8421=" + gate_token + "x", "flexura_8421==" + gate_token, gate_token, gate_token + "=",
             "flexura_8421=" + gate_token.substr(1)}) {
    EXPECT_FALSE(gate().has_token(head("Cookie: " + value))) << value;
  }
}

TEST(Token, HasNewBitsEachTime) {
  std::set<std::string> tokens;
  for (int i = 0; i < 100; ++i) {
    const std::string fresh = new_token();
    EXPECT_EQ(fresh.size(), 32U);
    EXPECT_EQ(fresh.find_first_not_of("0123456789abcdef"), std::string::npos);
    tokens.insert(fresh);
  }
  EXPECT_EQ(tokens.size(), 100U);
}

// Measured times would be unreliable; the test checks which bytes are read.
TEST(Token, IsComparedToItsEndWhereverItDiffers) {
  for (std::size_t wrong = 0; wrong <= gate_token.size(); ++wrong) {
    std::string other = gate_token;
    if (wrong < other.size()) other[wrong] = 'x';
    std::vector<std::size_t> looks(gate_token.size());
    const auto difference = difference_of(gate_token, other, [&](std::string_view text, std::size_t i) {
      ++looks[i];
      return text[i];
    });
    EXPECT_EQ(difference == 0, wrong == gate_token.size());
    EXPECT_EQ(looks, std::vector<std::size_t>(gate_token.size(), 2)) << "wrong at " << wrong;
  }
}

TEST(Token, IsEqualToItselfOnly) {
  EXPECT_TRUE(equal_in_constant_time(gate_token, gate_token));
  EXPECT_TRUE(equal_in_constant_time("", ""));
  EXPECT_FALSE(equal_in_constant_time(gate_token, gate_token.substr(1)));
  for (std::size_t i = 0; i < gate_token.size(); ++i) {
    std::string other = gate_token;
    other[i] = static_cast<char>(other[i] ^ 1);
    EXPECT_FALSE(equal_in_constant_time(gate_token, other)) << i;
  }
}

}  // namespace
}  // namespace flexura
