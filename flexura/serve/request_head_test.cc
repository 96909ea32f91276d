#include "flexura/serve/request_head.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace flexura {
namespace {

using Texts = std::vector<std::string>;

/// Returns the status that refuses a request of this host with these lines; 0 if it is accepted.
int refusal_of(const std::string& lines, const std::string& first = "GET / HTTP/1.1") {
  const auto parsed = parse_request_head(first + "\r\nHost: a\r\n" + lines);
  const auto* refused = std::get_if<Refusal>(&parsed);
  return refused == nullptr ? 0 : refused->status;
}

TEST(RequestHead, HoldsMethodTargetAndFields) {
  const auto parsed =
      parse_request_head("POST /a%20b?c HTTP/1.1\r\nHOST:\t a:1 \r\nX-Y: 1,2\r\nContent-Length: 0");
  const auto& head = std::get<RequestHead>(parsed);
  EXPECT_EQ(head.method, "POST");
  EXPECT_EQ(head.target, "/a%20b?c");
  EXPECT_EQ(*head.find("host"), "a:1");
  EXPECT_EQ(*head.find("x-y"), "1,2");
  EXPECT_EQ(head.find("x"), nullptr);
  EXPECT_TRUE(head.keep_alive);
}

TEST(RequestHead, EndsTheConnectionWhereTheClientWantsItOrIsOld) {
  EXPECT_FALSE(std::get<RequestHead>(parse_request_head("GET / HTTP/1.1\r\nHost: a\r\nConnection: x, Close"))
                   .keep_alive);
  EXPECT_FALSE(
      std::get<RequestHead>(parse_request_head("GET / HTTP/1.0\r\nConnection: keep-alive")).keep_alive);
}

TEST(RequestHead, FindsATokenInAListOverSeveralFields) {
  const auto parsed =
      parse_request_head("GET / HTTP/1.1\r\nHost: a\r\nConnection: a , ,UPGRADE\r\nConnection: b");
  const auto& head = std::get<RequestHead>(parsed);
  EXPECT_TRUE(head.lists("connection", "upgrade"));
  EXPECT_TRUE(head.lists("connection", "b"));
  EXPECT_FALSE(head.lists("connection", "upgrad"));
  EXPECT_FALSE(head.lists("upgrade", "upgrade"));
}

TEST(RequestHead, RefusesRequestLinesThatCouldBeReadInTwoWays) {
  for (const std::string& line :
       Texts{"GET  / HTTP/1.1", "GET / HTTP/1.1 ", "GET / HTTP/1.1 x", " GET / HTTP/1.1", "GET /", "GET", "",
             "GET\t/\tHTTP/1.1", "GET / http/1.1", "G(T / HTTP/1.1", "GET /a\x7f HTTP/1.1",
             "GET /\xc3\xa4 HTTP/1.1", "GET / HTTP/1.1\rX", "GET /\nX HTTP/1.1"}) {
    EXPECT_EQ(refusal_of("", line), 400) << line;
  }
  for (const std::string& line :
       Texts{"GET / HTTP/2.0", "GET / HTTP/1.2", "GET / HTTP/1.01", "GET / HTTP/"}) {
    EXPECT_EQ(refusal_of("", line), 505) << line;
  }
  EXPECT_EQ(refusal_of("", "GET / HTTP/1.0"), 0);
}

TEST(RequestHead, RefusesFieldsThatCouldBeReadInTwoWays) {
  for (const std::string& lines : Texts{"X : 1", " folded", "X: 1\r\n\tfolded", ": 1", "X", "X: a\rb",
                                        "X: a\nY: b", "X: \x7f", "Host: b", "Origin: a\r\norigin: a",
                                        "Authorization: a\r\nAuthorization: a", "Cookie: a\r\nCookie: b"}) {
    EXPECT_EQ(refusal_of(lines), 400) << lines;
  }
  EXPECT_EQ(refusal_of(std::string("X: a\0b", 6)), 400);
  EXPECT_EQ(refusal_of("X: \xc3\xa4\r\nX: again"), 0);
}

TEST(RequestHead, NeedsAHostUnlessItIsOld) {
  EXPECT_EQ(std::get<Refusal>(parse_request_head("GET / HTTP/1.1\r\nX: y")).status, 400);
  EXPECT_TRUE(std::holds_alternative<RequestHead>(parse_request_head("GET / HTTP/1.0")));
}

TEST(RequestHead, RefusesBodies) {
  for (const std::string& lines :
       Texts{"Content-Length: 5", "Content-Length: ", "Content-Length: +0", "Content-Length: 0,0",
             "Content-Length: 00", "Content-Length: 99999999999999999999999", "Transfer-Encoding: chunked",
             "Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked", "Transfer-Encoding: gzip",
             "Content-Length: 0\r\nTransfer-Encoding: chunked"}) {
    EXPECT_EQ(refusal_of(lines), 413) << lines;
  }
  EXPECT_EQ(refusal_of("Transfer-Encoding: chunked", "POST / HTTP/1.0"), 413);
  EXPECT_EQ(refusal_of("Content-Length: 0\r\nContent-Length: 0"), 400);
  EXPECT_EQ(refusal_of("Content-Length: 0"), 0);
}

}  // namespace
}  // namespace flexura
