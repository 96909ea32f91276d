#include "flexura/serve/outbox.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace flexura {
namespace {

std::shared_ptr<const std::string> bytes(const std::string& text) {
  return std::make_shared<const std::string>(text);
}

/// Returns all messages, with texts in quotes.
std::string drained(Outbox& outbox) {
  std::string all;
  while (const auto message = outbox.next()) {
    outbox.done();
    all += message->text ? '"' + *message->bytes + '"' : *message->bytes;
    all += ' ';
  }
  return all;
}

TEST(Outbox, KeepsAllTextsInTheirOrder) {
  Outbox outbox(10, 100);
  for (const char* text : {"a", "b", "c"}) EXPECT_TRUE(outbox.push(text));
  EXPECT_EQ(drained(outbox), "\"a\" \"b\" \"c\" ");
}

TEST(Outbox, HasRoomUpToAQuarterOfWhatMayWait) {
  Outbox few(8, 1000), small(1000, 80);
  EXPECT_TRUE(few.push("a"));
  EXPECT_TRUE(few.has_room());
  EXPECT_TRUE(few.push("b"));
  EXPECT_FALSE(few.has_room());
  (void)few.next();
  EXPECT_TRUE(few.has_room()) << "what is being sent waits no more";
  EXPECT_TRUE(small.push(std::string(19, 'a')));
  EXPECT_TRUE(small.has_room());
  EXPECT_TRUE(small.push("b"));
  EXPECT_FALSE(small.has_room());
  small.post(1, bytes("state"));
  (void)small.next();
  EXPECT_TRUE(small.has_room());
}

TEST(Outbox, KeepsTheNewestOfEachStream) {
  Outbox outbox(10, 100);
  outbox.post(1, bytes("old"));
  outbox.post(2, bytes("image"));
  outbox.post(1, bytes("new"));
  EXPECT_EQ(outbox.bytes(), 8U);
  EXPECT_EQ(drained(outbox), "new image ");
  EXPECT_EQ(outbox.bytes(), 0U);
}

TEST(Outbox, LetsStreamsTakeTurns) {
  Outbox outbox(10, 100);
  std::string sent;
  for (int i = 0; i < 4; ++i) {
    outbox.post(1, bytes("s"));
    outbox.post(2, bytes("i"));
    sent += *outbox.next()->bytes;
    outbox.done();
  }
  EXPECT_EQ(sent, "sisi");
}

TEST(Outbox, LetsTextsAndStreamsTakeTurns) {
  Outbox outbox(10, 100);
  for (const char* text : {"a", "b", "c"}) EXPECT_TRUE(outbox.push(text));
  outbox.post(1, bytes("s"));
  outbox.post(2, bytes("i"));
  EXPECT_EQ(drained(outbox), "\"a\" s \"b\" i \"c\" ");
}

TEST(Outbox, BoundsHowManyTextsWait) {
  Outbox outbox(2, 100);
  EXPECT_TRUE(outbox.push("a"));
  EXPECT_TRUE(outbox.push("b"));
  EXPECT_FALSE(outbox.push("c"));
  EXPECT_EQ(drained(outbox), "\"a\" \"b\" ");
  EXPECT_TRUE(outbox.push("d"));
}

TEST(Outbox, BoundsHowMuchTextWaits) {
  Outbox outbox(10, 5);
  EXPECT_TRUE(outbox.push("abc"));
  EXPECT_FALSE(outbox.push("def"));
  EXPECT_TRUE(outbox.push("de"));
  EXPECT_FALSE(outbox.push("f"));
  EXPECT_EQ(outbox.bytes(), 5U);
}

TEST(Outbox, CountsWhatIsBeingSent) {
  Outbox outbox(10, 100);
  EXPECT_TRUE(outbox.push("abc"));
  EXPECT_FALSE(outbox.is_sending());
  const auto message = outbox.next();
  EXPECT_EQ(outbox.bytes(), 3U);
  EXPECT_TRUE(outbox.is_sending());
  outbox.done();
  EXPECT_FALSE(outbox.is_sending());
  EXPECT_EQ(outbox.bytes(), 0U);
  EXPECT_FALSE(outbox.next());
}

}  // namespace
}  // namespace flexura
