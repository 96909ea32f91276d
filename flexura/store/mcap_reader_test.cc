#include "flexura/store/mcap_reader.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <thread>

#include "flexura/store/mcap_summary.h"
#include "tests/mcap_testing.h"

namespace flexura {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// Returns the reader's error for invalid bytes.
std::string refusal(const std::string& bytes) {
  try {
    const McapReader log(as_log(bytes), "a.mcap");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no refusal";
}

/// Returns a log with a header and the output of `write`, without an end.
std::string by_hand(const std::function<void(McapBytes&)>& write) {
  McapBytes out;
  out.put(std::as_bytes(std::span(mcap_magic)));
  out.record(McapOp::header, [&] {
    out.put(std::string_view());
    out.put(std::string_view("by hand"));
  });
  write(out);
  return {reinterpret_cast<const char*>(out.bytes().data()), out.size()};
}

void put_message(McapBytes& out, std::uint16_t channel, std::string_view text) {
  out.record(McapOp::message, [&] {
    out.put(channel);
    out.put(std::uint32_t{0});
    out.put(std::uint64_t{7});
    out.put(std::uint64_t{7});
    out.put(std::as_bytes(std::span(text)));
  });
}

void put_chunk(McapBytes& out, std::string_view compression, const McapBytes& records) {
  out.record(McapOp::chunk, [&] {
    out.put(std::uint64_t{7});
    out.put(std::uint64_t{7});
    out.put(std::uint64_t{records.size()});
    out.put(std::uint32_t{0});
    out.put(compression);
    out.put(std::uint64_t{records.size()});
    out.put(std::span(records.bytes()));
  });
}

/// Returns the ends of the log's chunks: the only bytes at which truncation gives one message more.
std::vector<std::size_t> chunk_ends(const std::string& log) {
  std::vector<std::size_t> ends;
  std::size_t at = mcap_magic.size();
  while (at + mcap_record_header < log.size()) {
    std::uint64_t length = 0;
    for (std::size_t i = 8; i > 0; --i) length = length << 8 | static_cast<unsigned char>(log[at + i]);
    const bool chunk = log[at] == static_cast<char>(McapOp::chunk);
    at += mcap_record_header + length;
    if (chunk) ends.push_back(at);
  }
  return ends;
}

TEST(McapReader, ReadsEveryTruncationUpToItsLastCompleteChunk) {
  const std::string whole = small_log();
  const auto all = reported(McapReader(as_log(whole), "whole"));
  const auto ends = chunk_ends(whole);
  ASSERT_THAT(ends, SizeIs(4));
  for (std::size_t length = 0; length < whole.size(); ++length) {
    SCOPED_TRACE(length);
    const std::string part = whole.substr(0, length);
    const McapReader log(as_log(part), "part");
    EXPECT_TRUE(log.truncated());
    const auto chunks = std::ranges::count_if(ends, [&](std::size_t end) { return end <= length; });
    const std::size_t messages = std::min<std::size_t>(2 * static_cast<std::size_t>(chunks), 7);
    EXPECT_EQ(reported(log), std::vector(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(messages)));
  }
}

TEST(McapReader, NoticesEveryChangedByte) {
  const std::string whole = small_log();
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const int change : {0x01, 0x80, 0xFF}) {
      SCOPED_TRACE(testing::Message() << "byte " << at << " ^ " << change);
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ change);
      const bool in_last_magic = at >= whole.size() - mcap_magic.size();
      const std::string reported = refusal(bytes);
      EXPECT_THAT(reported, HasSubstr(in_last_magic ? "last bytes are wrong" : "a.mcap: byte "));
    }
  }
}

TEST(McapReader, NamesTheChecksumThatIsWrong) {
  const std::string whole = small_log();
  const auto spoilt = [&](std::size_t at) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 1);
    return bytes;
  };
  const std::size_t message = whole.find(R"({"i":3})");
  ASSERT_NE(message, std::string::npos);
  EXPECT_THAT(refusal(spoilt(message)), HasSubstr("a chunk's CRC is wrong"));
  EXPECT_THAT(refusal(spoilt(whole.find("/arm"))), HasSubstr("the data section's CRC is wrong"));
  EXPECT_THAT(refusal(spoilt(whole.rfind("/arm"))), HasSubstr("is defined twice with different contents"));
  EXPECT_THAT(refusal(spoilt(whole.size() - 12)), HasSubstr("the summary's CRC is wrong"));
  const std::string damaged = spoilt(message);
  EXPECT_THAT(McapReader(as_log(damaged), "a.mcap", McapCheck::structure).messages(), SizeIs(7));
}

TEST(McapReader, SkipsADamagedChunkAndReportsTheTimeThatIsLost) {
  const std::string whole = small_log();
  const auto all = reported(McapReader(as_log(whole), "a.mcap"));
  for (std::size_t chunk = 0; chunk < 4; ++chunk) {
    std::string bytes = whole;
    bytes[whole.find(fmt::format(R"({{"i":{}}})", 2 * chunk))] ^= 1;
    const McapReader log(as_log(bytes), "a.mcap", McapCheck::skip);
    auto left = all;
    const auto first = left.begin() + static_cast<std::ptrdiff_t>(2 * chunk);
    left.erase(first, std::min(first + 2, left.end()));
    EXPECT_EQ(reported(log), left);
    EXPECT_FALSE(log.truncated());
    ASSERT_THAT(log.damage(), SizeIs(1));
    EXPECT_EQ(log.damage()[0].from, 2000 * chunk);
    EXPECT_EQ(log.damage()[0].to, std::min<std::uint64_t>(2000 * chunk + 1000, 6000));
    EXPECT_THAT(log.damage()[0].what, HasSubstr("a chunk's CRC is wrong"));
  }
  EXPECT_THAT(McapReader(as_log(whole), "a.mcap", McapCheck::skip).damage(), IsEmpty());
}

// Any changed byte: nothing that was not written is read, or the log is refused.
TEST(McapReader, ReadsNothingFalseWhenItSkips) {
  const std::string whole = small_log();
  const auto all = reported(McapReader(as_log(whole), "a.mcap"));
  int skipped = 0;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    SCOPED_TRACE(at);
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x80);
    try {
      const McapReader log(as_log(bytes), "a.mcap", McapCheck::skip);
      for (const std::string& message : reported(log)) EXPECT_THAT(all, testing::Contains(message));
      skipped += log.damage().empty() ? 0 : 1;
    } catch (const std::runtime_error&) {
    }
  }
  EXPECT_GT(skipped, 100);
}

TEST(McapReader, RefusesWhatIsNoLog) {
  EXPECT_EQ(refusal("PNG and so on"), "a.mcap: byte 0: not an MCAP log");
  EXPECT_THAT(refusal(small_log() + "x"), HasSubstr("there are bytes after the end of the log"));
  const TestFolder folder;
  EXPECT_THROW(McapReader(folder / "none.mcap"), std::system_error);
  EXPECT_THROW(McapReader(folder / ""), std::system_error) << "a folder";
  EXPECT_THROW(McapReader("/dev/zero"), std::system_error);
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THROW(McapReader(folder / "pipe"), std::system_error);
}

TEST(McapReader, NamesTheCompressionItDoesNotRead) {
  const auto log = by_hand([](McapBytes& out) { put_chunk(out, "lz4", {}); });
  EXPECT_THAT(refusal(log), HasSubstr(R"(a chunk is compressed ("lz4"))"));
}

TEST(McapReader, RefusesMessagesWithoutAChannel) {
  const auto log = by_hand([](McapBytes& out) { put_message(out, 3, "m"); });
  EXPECT_THAT(refusal(log), HasSubstr("unknown channel, 3"));
}

TEST(McapReader, DoesNotBelieveLengths) {
  const auto log = by_hand([](McapBytes& out) {
    McapBytes records;
    records.put(static_cast<std::uint8_t>(McapOp::schema));
    records.put(UINT64_MAX);
    put_chunk(out, "", records);
  });
  EXPECT_THAT(refusal(log), HasSubstr("needs 18446744073709551615 bytes where 0 are left"));
}

TEST(McapReader, RefusesSchemasThatWouldFillTheMemory) {
  const auto log = by_hand([](McapBytes& out) {
    put_schema(out, 1, {"big", "jsonschema", std::string(1'000'000, ' ')});
    for (std::uint16_t id = 1; id < 100; ++id) put_channel(out, id, {{.topic = "/t"}, 1, 0});
  });
  EXPECT_THAT(refusal(log), HasSubstr("schemas need too much memory"));
}

TEST(McapReader, ReadsMessagesOutsideChunksAndSkipsUnknownRecords) {
  const auto log = by_hand([](McapBytes& out) {
    out.record(McapOp{0x90}, [&] { out.put(std::uint64_t{1}); });
    put_channel(out, 9, {{.topic = "/t"}, 0, 0});
    put_message(out, 9, "plain");
  });
  EXPECT_THAT(reported(McapReader(as_log(log), "a.mcap")), testing::ElementsAre("/t 7 0 plain"));
}

TEST(McapReader, KeepsItsMessagesWhenMoved) {
  const TestFolder folder;
  write_small_log(folder / "log.mcap");
  McapReader first(folder / "log.mcap");
  const McapReader second = std::move(first);
  ASSERT_THAT(second.messages(), SizeIs(7));
  EXPECT_EQ(second.messages()[2].channel, &second.channels().at(2));
  EXPECT_EQ(second.messages()[2].text(), R"({"i":2})");
}

/// Writes messages 0, 1, 2, ... until it is killed.
[[noreturn]] void write_for_ever(const std::filesystem::path& path) {
  McapWriter log(path, {.chunk_size = 2000});
  const auto channel = log.add_channel(json_channel("/count"));
  for (std::uint64_t i = 0;; ++i) log.write(channel, i, std::to_string(i));
}

TEST(McapReader, ReadsWhatAKilledWriterLeft) {
  constexpr unsigned seed = 20240501;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::size_t most = 0;
  for (int round = 0; round < 8; ++round) {
    const TestFolder folder;
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) write_for_ever(folder / "log.mcap");
    while (!std::filesystem::exists(folder / "log.mcap")) std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 20'000));
    ASSERT_EQ(::kill(child, SIGKILL), 0);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    const McapReader log(folder / "log.mcap");
    EXPECT_TRUE(log.truncated());
    for (std::size_t i = 0; i < log.messages().size(); ++i) {
      ASSERT_EQ(log.messages()[i].log_time, i);
      ASSERT_EQ(log.messages()[i].text(), std::to_string(i));
    }
    most = std::max(most, log.messages().size());
  }
  EXPECT_GT(most, 100U) << "no writer got far enough to test anything";
}

TEST(McapReader, ReadsALogThatIsStillBeingWritten) {
  const TestFolder folder;
  McapWriter log(folder / "log.mcap");
  const auto channel = log.add_channel(json_channel("/arm"));
  log.write(channel, 1, "one");
  EXPECT_THAT(McapReader(folder / "log.mcap").messages(), IsEmpty());
  log.flush();
  EXPECT_THAT(McapReader(folder / "log.mcap").messages(), SizeIs(1));
}

// Returns the bytes of files that are mapped into this process and in memory.
double mapped_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("RssFile:")) return 1024 * std::stod(line.substr(8));
  return 0;
}

TEST(McapReader, KeepsLittleOfALargeFileInMemory) {
  const TestFolder folder;
  constexpr std::size_t messages = 1024, length = 65536;
  {
    McapWriter log(folder / "log.mcap");
    const auto channel = log.add_channel({"/image", "x-bytes"});
    std::mt19937_64 random(1);
    std::string noise(length, ' ');
    for (std::size_t i = 0; i < messages; ++i) {
      for (std::size_t k = 0; k < length; k += 8) {
        const std::uint64_t bits = random();
        std::memcpy(noise.data() + k, &bits, sizeof bits);
      }
      log.write(channel, i, noise);
    }
  }
  const double before = mapped_memory();
  if (before == 0) GTEST_SKIP() << "the system does not report mapped memory";
  double most = 0;
  const McapReader log(folder / "log.mcap");
  most = std::max(most, mapped_memory());
  ASSERT_THAT(log.messages(), SizeIs(messages));
  for (const McapMessage& message : log.messages()) {
    ASSERT_EQ(message.text().size(), length);
    most = std::max(most, mapped_memory());
  }
  std::printf("%.1f of %.1f MB in memory\n", (most - before) / 1e6, 1e-6 * messages * length);
  // A window, and what the system reads around the pages.
  EXPECT_LT(most - before, 3.0 * MappedFile::window);
}

}  // namespace
}  // namespace flexura
