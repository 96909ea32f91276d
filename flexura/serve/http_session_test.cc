#include "flexura/serve/http_session.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace flexura {
namespace {

using Texts = std::vector<std::string>;

const std::string token = "00112233445566778899aabbccddeeff";
const std::string bearer = "Authorization: Bearer " + token + "\r\n";
const std::string host = "Host: 127.0.0.1:8421\r\n";
constexpr std::array<std::uint8_t, 3> page_bytes = {1, 2, 3};
constexpr std::array<Asset, 2> assets = {Asset{"/index.html", "text/html", page_bytes},
                                         Asset{"/assets/a.js", "text/javascript", page_bytes}};

const Site& site() {
  static const Site one{Gate(8421, {"localhost"}, token), assets, 1024};
  return one;
}

std::string request(const std::string& method, const std::string& target, const std::string& more = {}) {
  return method + " " + target + " HTTP/1.1\r\n" + host + more + "\r\n";
}
std::string get(const std::string& target, const std::string& more = {}) {
  return request("GET", target, more);
}
std::string line(const std::string& name, const std::string& value) { return name + ": " + value + "\r\n"; }

std::string socket_request(const std::string& more) {
  return get("/socket", "Connection: Upgrade\r\nUpgrade: WebSocket\r\n" + bearer + more);
}
const std::string version = "Sec-WebSocket-Version: 13\r\n";
const std::string key = "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";

/// Returns the step after these bytes: a status, or "more", "ask TARGET", "upgrade".
std::string step_of(HttpSession& session) {
  const Step step = session.next();
  if (const auto* answer = std::get_if<Answer>(&step))
    return answer->head.substr(9, 3) + (answer->last ? " last" : "");
  if (const auto* question = std::get_if<Question>(&step)) return "ask " + question->target;
  return std::holds_alternative<Upgrade>(step) ? "upgrade" : "more";
}
std::string step_after(const std::string& bytes) {
  HttpSession session(site(), "127.0.0.1");
  session.feed(bytes);
  return step_of(session);
}

TEST(HttpSession, ServesAssetsToAnyone) {
  HttpSession session(site(), "127.0.0.1");
  session.feed(get("/"));
  const auto page = std::get<Answer>(session.next());
  EXPECT_EQ(page.fixed.data(), page_bytes.data());
  EXPECT_NE(page.head.find("Cache-Control: no-cache\r\n"), std::string::npos);
  session.feed(get("/assets/a.js?x=y"));
  const auto script = std::get<Answer>(session.next());
  EXPECT_NE(script.head.find("Content-Type: text/javascript\r\n"), std::string::npos);
  EXPECT_NE(script.head.find("Cache-Control: max-age=31536000, immutable\r\n"), std::string::npos);
  for (const std::string& path :
       Texts{"/assets/", "/assets/b.js", "/assets/a.js/", "/assets/%61.js", "/%61ssets/a.js"}) {
    EXPECT_EQ(step_after(get(path)), "404") << path;
  }
}

TEST(HttpSession, GivesTheCookieToWhoShowsTheTokenInTheHeader) {
  const auto head_of = [](const std::string& more) {
    HttpSession session(site(), "127.0.0.1");
    session.feed(get("/series", more));
    EXPECT_TRUE(std::holds_alternative<Question>(session.next()));
    return session.format(HttpAnswer{}).head;
  };
  EXPECT_NE(head_of(bearer).find("\r\nSet-Cookie: flexura_8421=" + token +
                                 "; Path=/; HttpOnly; SameSite=Strict\r\n"),
            std::string::npos);
  const std::string cookie = line("Cookie", "flexura_8421=" + token);
  const std::string wrong = line("Authorization", "Bearer f" + token.substr(1));
  EXPECT_EQ(head_of(cookie).find("Set-Cookie"), std::string::npos);
  EXPECT_EQ(head_of(cookie + wrong).find("Set-Cookie"), std::string::npos);
  // Only in one answer, and never in a refusal.
  HttpSession session(site(), "127.0.0.1");
  session.feed(get("/series", bearer) + get("/series", cookie) + request("POST", "/series", bearer));
  (void)session.next(), (void)session.next();
  EXPECT_EQ(session.format(HttpAnswer{}).head.find("Set-Cookie"), std::string::npos);
  EXPECT_EQ(std::get<Answer>(session.next()).head.find("Set-Cookie"), std::string::npos);
}

TEST(HttpSession, SaysInEveryAnswerWhatAPageMayDo) {
  for (const std::string& bytes : Texts{get("/"), get("/nothing"), get("/nothing", "Origin: http://evil\r\n"),
                                        get("/.."), request("POST", "/series", bearer)}) {
    HttpSession session(site(), "127.0.0.1");
    session.feed(bytes);
    const std::string head = std::get<Answer>(session.next()).head;
    for (const std::string& part :
         Texts{"Content-Security-Policy: default-src 'none'; script-src 'self';", "frame-ancestors 'none'",
               "X-Content-Type-Options: nosniff\r\n", "Referrer-Policy: no-referrer\r\n",
               "Cross-Origin-Resource-Policy: same-origin\r\n", "Cache-Control: no-"}) {
      EXPECT_NE(head.find(part), std::string::npos) << part << " in " << head;
    }
    EXPECT_EQ(head.find("Access-Control"), std::string::npos);
  }
}

TEST(HttpSession, AnswersOnlyToItsName) {
  EXPECT_EQ(step_after("GET / HTTP/1.1\r\nHost: evil.example:8421\r\n\r\n"), "421");
  EXPECT_EQ(step_after("GET /socket HTTP/1.1\r\nHost: evil.example:8421\r\n" + bearer + "\r\n"), "421");
  EXPECT_EQ(step_after("GET / HTTP/1.1\r\nHost:\r\n\r\n"), "421");
  EXPECT_EQ(step_after("GET / HTTP/1.0\r\n\r\n"), "421 last");
  EXPECT_EQ(step_after("GET / HTTP/1.1\r\nHost: localhost:8421\r\n\r\n"), "200");
}

TEST(HttpSession, TakesNothingFromForeignPages) {
  const std::string foreign = "Origin: http://evil.example\r\n";
  // The page's script cannot choose Host, but an attacker's name can resolve to this machine.
  EXPECT_EQ(
      step_after("GET / HTTP/1.1\r\nHost: evil.example:8421\r\nOrigin: http://evil.example:8421\r\n\r\n"),
      "421");
  EXPECT_EQ(step_after(get("/", foreign)), "403");
  EXPECT_EQ(step_after(get("/series", foreign + bearer)), "403");
  EXPECT_EQ(step_after(socket_request(version + key + foreign)), "403");
  EXPECT_EQ(step_after(socket_request(version + key + "Origin: http://127.0.0.1:8422\r\n")), "403");
  EXPECT_EQ(step_after(socket_request(version + key + "Origin: null\r\n")), "403");
  EXPECT_EQ(step_after(socket_request(version + key + "Origin: http://localhost:8421\r\n")), "upgrade");
  for (const std::string& site : Texts{"cross-site", "same-site", ""}) {
    EXPECT_EQ(step_after(get("/report", bearer + line("Sec-Fetch-Site", site))), "403") << site;
  }
  EXPECT_EQ(step_after(get("/report", bearer + "Sec-Fetch-Site: none\r\n")), "ask /report");
  EXPECT_EQ(step_after(get("/", "Sec-Fetch-Site: cross-site\r\n")), "200");
}

TEST(HttpSession, AsksForTheTokenBeforeAnythingElseIsTold) {
  const std::string query = "?token=" + token;
  for (const std::string& target :
       Texts{"/socket", "/image/front.png", "/series?names=a", "/report", "/nothing", "/report/"}) {
    EXPECT_EQ(step_after(get(target)), "401") << target;
    EXPECT_EQ(step_after(get(target, "Cookie: flexura_8421=" + std::string(32, '0') + "\r\n")), "401")
        << target;
    EXPECT_EQ(step_after(get(target + query)), "401") << target;
  }
  EXPECT_EQ(step_after(get("/series?names=a", bearer)), "ask /series?names=a");
  EXPECT_EQ(step_after(get("/image/front.png", "Cookie: flexura_8421=" + token + "\r\n")),
            "ask /image/front.png");
}

TEST(HttpSession, KnowsNoMethodThatChangesAnything) {
  for (const std::string& method :
       Texts{"HEAD", "POST", "PUT", "DELETE", "OPTIONS", "PATCH", "TRACE", "CONNECT", "get", "X"}) {
    for (const std::string& target : Texts{"/", "/socket", "/series", "/nothing"}) {
      EXPECT_EQ(step_after(request(method, target, bearer)), "405") << method;
    }
  }
}

TEST(HttpSession, RefusesTargetsThatAreNoPlainPath) {
  for (const std::string& target :
       Texts{"http://127.0.0.1:8421/", "*", "127.0.0.1:8421", "/../etc/passwd", "/assets/../index.html",
             "/%2e%2e/x", "/a%zz", "/a%00", "/a%0d%0aSet-Cookie:%20x"}) {
    EXPECT_EQ(step_after(get(target, bearer)), "400") << target;
  }
}

TEST(HttpSession, RefusesLongHeadersEvenBeforeTheirEnd) {
  EXPECT_EQ(step_after(get("/", "X: " + std::string(1024, 'x') + "\r\n")), "431 last");
  EXPECT_EQ(step_after("GET /" + std::string(1024, 'x')), "431 last");
  const std::string full = get("/", "X: \r\n");
  EXPECT_EQ(step_after(get("/", "X: " + std::string(1024 - full.size(), 'x') + "\r\n")), "200");
  EXPECT_EQ(step_after(get("/", "X: " + std::string(1025 - full.size(), 'x') + "\r\n")), "431 last");
}

TEST(HttpSession, EndsAfterWhatItCannotRead) {
  EXPECT_EQ(step_after("\r\n\r\n"), "400 last");
  EXPECT_EQ(step_after(get("/", "Transfer-Encoding: chunked\r\n")), "413 last");
  EXPECT_EQ(step_after(get("/", "Content-Length: 3\r\n") + "abc"), "413 last");
  EXPECT_EQ(step_after(get("/", "Content-Length: 0\r\nContent-Length: 3\r\n")), "400 last");
  EXPECT_EQ(step_after("GET / HTTP/2.0\r\n" + host + "\r\n"), "505 last");
  EXPECT_EQ(step_after("GET / HTTP/1.1\n" + host + "\r\n"), "400 last");
}

TEST(HttpSession, AnswersRequestsThatComeTogetherOrInPieces) {
  HttpSession session(site(), "127.0.0.1");
  session.feed(get("/") + get("/nothing") + get("/series", bearer) + get("/", "Connection: close\r\n"));
  EXPECT_EQ(step_of(session), "200");
  EXPECT_EQ(step_of(session), "401");
  EXPECT_EQ(step_of(session), "ask /series");
  EXPECT_EQ(step_of(session), "200 last");
  HttpSession slow(site(), "127.0.0.1");
  EXPECT_FALSE(slow.begun());
  for (const char byte : get("/")) {
    EXPECT_EQ(step_of(slow), "more");
    slow.feed({&byte, 1});
    EXPECT_TRUE(slow.begun());
  }
  EXPECT_EQ(step_of(slow), "200");
  EXPECT_FALSE(slow.begun());
}

TEST(HttpSession, BecomesAWebSocketOnlyAsItShould) {
  EXPECT_EQ(step_after(socket_request(version + key)), "upgrade");
  EXPECT_EQ(step_after(get("/socket", bearer + version + key)), "426");
  EXPECT_EQ(step_after(get("/socket", bearer + version + key + "Upgrade: websocket\r\n")), "426");
  EXPECT_EQ(step_after(get("/socket", bearer + version + key + "Connection: upgrade\r\nUpgrade: h2c\r\n")),
            "426");
  // HTTP/1.0 has no upgrade (RFC 9110, 7.8).
  std::string old = socket_request(version + key);
  old.replace(old.find("HTTP/1.1"), 8, "HTTP/1.0");
  EXPECT_EQ(step_after(old), "426 last");
  EXPECT_EQ(step_after(socket_request(key)), "426");
  EXPECT_EQ(step_after(socket_request("Sec-WebSocket-Version: 8\r\n" + key)), "426");
  EXPECT_EQ(step_after(socket_request(version)), "400");
  EXPECT_EQ(step_after(socket_request(version + key) + "\x81\x80"), "400");
  for (const std::string& bad : Texts{"", "short", "dGhlIHNhbXBsZSBub25jZQ=", "dGhlIHNhbXBsZSBub25jZQ===",
                                      "dGhlIHNhbXBsZSBub25j=Q==", "dGhlIHNhbXBsZSBub25jZ\"=="}) {
    EXPECT_EQ(step_after(socket_request(version + line("Sec-WebSocket-Key", bad))), "400") << bad;
  }
}

TEST(HttpSession, PassesTheHostsAnswerOnUnlessItWouldBreakTheHead) {
  HttpSession session(site(), "127.0.0.1");
  session.feed(get("/report", bearer));
  EXPECT_EQ(step_of(session), "ask /report");
  const Answer answer =
      session.format({.status = 404, .content_type = "text/plain", .body = "no", .policy = "sandbox"});
  EXPECT_TRUE(answer.head.starts_with("HTTP/1.1 404 Not Found\r\n"));
  EXPECT_NE(answer.head.find("Content-Security-Policy: sandbox\r\n"), std::string::npos);
  EXPECT_NE(answer.head.find("Content-Length: 2\r\n"), std::string::npos);
  EXPECT_EQ(answer.body, "no");
  for (const HttpAnswer& bad :
       {HttpAnswer{200, "a\r\nSet-Cookie: b", "", ""}, HttpAnswer{200, "a", "", "b\r\n"},
        HttpAnswer{99, "a", "", ""}, HttpAnswer{600, "a", "", ""}}) {
    EXPECT_TRUE(session.format(bad).head.starts_with("HTTP/1.1 500 "));
  }
}

}  // namespace
}  // namespace flexura
