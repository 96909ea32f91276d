// Compressed chunks: what the writer makes of them, and what the reader refuses.
#include "flexura/store/mcap_chunks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <thread>

#include "tests/mcap_testing.h"

namespace flexura {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Lt;
using testing::SizeIs;

std::string refused(const std::string& bytes) {
  try {
    const McapReader log(as_log(bytes), "a.mcap");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no refusal";
}

std::vector<std::byte> compressed(std::string_view text) { return zstd(std::as_bytes(std::span(text))); }

/// Returns a log without an end: a channel, and `count` equal compressed chunks that claim `size` bytes.
std::string chunks_by_hand(std::span<const std::byte> frames, std::uint64_t size, int count = 1) {
  McapBytes out;
  out.put(std::as_bytes(std::span(mcap_magic)));
  out.record(McapOp::header, [&] {
    out.put(std::string_view());
    out.put(std::string_view("by hand"));
  });
  put_channel(out, 1, {{.topic = "/t"}, 0, 0});
  for (int i = 0; i < count; ++i) {
    out.record(McapOp::chunk, [&] {
      out.put(std::uint64_t{7});
      out.put(std::uint64_t{7});
      out.put(size);
      out.put(std::uint32_t{0});
      out.put(mcap_zstd);
      out.put(std::uint64_t{frames.size()});
      out.put(frames);
    });
  }
  return {reinterpret_cast<const char*>(out.bytes().data()), out.size()};
}

TEST(Zstd, GivesTheBytesBack) {
  for (const std::string& text : {std::string(), std::string("one"), std::string(1'000'000, 'x')}) {
    const auto frame = compressed(text);
    const ByteBuffer content = unzstd(frame, text.size());
    EXPECT_TRUE(std::ranges::equal(content.bytes(), std::as_bytes(std::span(text))));
    EXPECT_THROW((void)unzstd(frame, text.size() + 1), std::runtime_error);
    EXPECT_THROW((void)unzstd(frame, text.size() / 2 - 1), std::runtime_error);
  }
  EXPECT_THROW((void)unzstd(std::as_bytes(std::span("no frame")), 100), std::runtime_error);
  EXPECT_THROW((void)unzstd({}, SIZE_MAX), std::runtime_error) << "without taking memory";
}

TEST(McapChunks, AreCompressedAndReadBack) {
  const TestFolder folder;
  std::vector<std::size_t> sizes;
  std::vector<std::vector<std::string>> contents;
  for (const bool compress : {true, false}) {
    const auto path = folder / (compress ? "small.mcap" : "plain.mcap");
    McapWriter log(path, {.chunk_size = 5000, .compress = compress});
    const auto arm = log.add_channel(json_channel("/arm"));
    const auto tip = log.add_channel(json_channel("/tip"));
    for (std::uint64_t i = 0; i < 1000; ++i)
      log.write(i % 3 == 0 ? tip : arm, i, R"({"bends":[[0.5,0.25]],"i":)" + std::to_string(i) + "}");
    log.close();
    sizes.push_back(file_bytes(path).size());
    contents.push_back(reported(McapReader(path)));
  }
  EXPECT_EQ(contents[0], contents[1]);
  EXPECT_THAT(sizes[0], Lt(sizes[1] / 2));
}

TEST(McapChunks, StayPlainIfCompressionDoesNotHelp) {
  const TestFolder folder;
  std::mt19937 random(1);
  std::string noise;
  for (int i = 0; i < 5000; ++i) noise += static_cast<char>(random());
  {
    McapWriter log(folder / "log.mcap");
    log.write(log.add_channel({"/noise", "x-bytes"}), 1, noise);
  }
  EXPECT_THAT(file_bytes(folder / "log.mcap"), HasSubstr(noise));
  EXPECT_EQ(McapReader(folder / "log.mcap").messages().at(0).text(), noise);
}

TEST(McapChunks, GiveMessagesInAnyOrderAndToThreads) {
  const std::string bytes = compressed_log();
  const McapReader log(as_log(bytes), "a.mcap");
  ASSERT_THAT(log.messages(), SizeIs(60));
  const auto is_right = [&](std::size_t i) {
    return log.messages()[i].text().ends_with(R"("i":)" + std::to_string(i) + "}");
  };
  for (std::size_t i = 0; i < 60; ++i) EXPECT_TRUE(is_right(i * 37 % 60));
  std::vector<std::thread> threads;
  std::vector<int> wrong(4);
  for (std::size_t thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&, thread] {
      for (std::size_t i = 0; i < 600; ++i) wrong[thread] += is_right((i * 41 + thread) % 60) ? 0 : 1;
    });
  }
  for (auto& thread : threads) thread.join();
  EXPECT_THAT(wrong, testing::Each(0));
}

TEST(McapChunks, OfATruncatedLogAreReadUpToTheLastCompleteOne) {
  const std::string whole = compressed_log();
  const auto all = reported(McapReader(as_log(whole), "whole"));
  std::size_t most = 0;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    SCOPED_TRACE(length);
    const std::string part = whole.substr(0, length);
    const McapReader log(as_log(part), "part");
    EXPECT_TRUE(log.truncated());
    EXPECT_EQ(log.messages().size() % 20, 0U);
    EXPECT_GE(log.messages().size(), most);
    most = log.messages().size();
    EXPECT_EQ(reported(log), std::vector(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(most)));
  }
  EXPECT_EQ(most, 60U);
}

TEST(McapChunks, NoticeEveryChangedByte) {
  const std::string whole = compressed_log();
  for (std::size_t at = 0; at < whole.size(); ++at) {
    SCOPED_TRACE(at);
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x10);
    EXPECT_THAT(refused(bytes), HasSubstr("a.mcap: "));
  }
}

TEST(McapChunks, DoNotBelieveSizes) {
  const auto frame = compressed(std::string(1000, '\x90'));
  EXPECT_THAT(refused(chunks_by_hand(frame, 999)), HasSubstr("a chunk does not decompress"));
  EXPECT_THAT(refused(chunks_by_hand(frame, 1001)), HasSubstr("it has 1000 bytes, not 1001"));
  EXPECT_THAT(refused(chunks_by_hand(frame, UINT64_MAX)), HasSubstr("has more than 128 MiB"));
  EXPECT_THAT(refused(chunks_by_hand(frame, 64U << 20)), HasSubstr("cannot hold 67108864"));
  EXPECT_THAT(refused(chunks_by_hand({}, 10)), HasSubstr("a chunk does not decompress"));
}

TEST(McapChunks, NameTheByteInsideThem) {
  // A message of 100 bytes in a chunk that ends after 9.
  McapBytes records;
  records.put(static_cast<std::uint8_t>(McapOp::message));
  records.put(std::uint64_t{100});
  EXPECT_THAT(refused(chunks_by_hand(zstd(records.bytes()), records.size())),
              testing::MatchesRegex("a.mcap: content of the chunk at byte [0-9]+: byte 9: needs 100 bytes "
                                    "where 0 are left"));
}

TEST(McapChunks, ThatExpandTooFarAreRefused) {
  // 40 MiB of unknown records, which are skipped: one chunk is within the limit, two of them are not.
  McapBytes records;
  records.record(McapOp{0x90}, [&] { records.put(std::string(40U << 20, '\0')); });
  const auto frame = zstd(records.bytes());
  ASSERT_THAT(frame, SizeIs(Lt(10'000U)));
  const std::string one = chunks_by_hand(frame, records.size());
  EXPECT_THAT(McapReader(as_log(one), "a.mcap").messages(), IsEmpty());
  EXPECT_THAT(refused(chunks_by_hand(frame, records.size(), 2)), HasSubstr("have too much content"));
}

}  // namespace
}  // namespace flexura
