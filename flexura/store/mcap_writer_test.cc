#include "flexura/store/mcap_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "tests/mcap_testing.h"
#include "tests/support/full_disk.h"

namespace flexura {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

TEST(McapWriter, WritesWhatTheReaderReads) {
  const TestFolder folder;
  write_small_log(folder / "log.mcap");
  const McapReader log(folder / "log.mcap");
  EXPECT_FALSE(log.truncated());
  EXPECT_THAT(log.library(), testing::StartsWith("flexura 0."));
  EXPECT_THAT(reported(log),
              ElementsAre(R"(/arm 0 0 {"i":0})", R"(/arm 1000 1 {"i":1})", R"(/events 2000 0 {"i":2})",
                          R"(/arm 3000 2 {"i":3})", R"(/arm 4000 3 {"i":4})", R"(/events 5000 1 {"i":5})",
                          R"(/arm 6000 4 {"i":6})"));
  EXPECT_THAT(log.channels(), SizeIs(2));
  EXPECT_EQ(log.channels().at(1), json_channel("/arm"));
  EXPECT_EQ(log.channels().at(2), json_channel("/events"));
}

TEST(McapWriter, GivesTheSameBytesTwice) {
  const std::string once = small_log();
  EXPECT_GT(once.size(), 500U);
  EXPECT_EQ(once, small_log());
}

using TwoTimes = std::pair<std::uint64_t, std::uint64_t>;

// Returns the first two numbers of each record of this kind.
std::vector<TwoTimes> times_in(McapOp kind, const std::string& log) {
  const auto number = [&](std::size_t at) {
    std::uint64_t value = 0;
    for (std::size_t i = 8; i-- > 0;) value = value << 8 | static_cast<unsigned char>(log.at(at + i));
    return value;
  };
  std::vector<TwoTimes> times;
  for (std::size_t at = mcap_magic.size(); at + mcap_record_header < log.size();
       at += mcap_record_header + number(at + 1)) {
    if (log[at] != static_cast<char>(kind)) continue;
    times.emplace_back(number(at + mcap_record_header), number(at + mcap_record_header + 8));
  }
  return times;
}

// With these times a reader finds a time without reading all chunks.
TEST(McapWriter, SaysOfEachChunkFromWhenToWhenItsMessagesAre) {
  for (const McapOp kind : {McapOp::chunk, McapOp::chunk_index})
    EXPECT_THAT(times_in(kind, small_log()), ElementsAre(TwoTimes(0, 1000), TwoTimes(2000, 3000),
                                                         TwoTimes(4000, 5000), TwoTimes(6000, 6000)));
}

TEST(McapWriter, KeepsAnEmptyLogReadable) {
  const TestFolder folder;
  McapWriter(folder / "log.mcap").close();
  const McapReader log(folder / "log.mcap");
  EXPECT_FALSE(log.truncated());
  EXPECT_THAT(log.channels(), IsEmpty());
  EXPECT_THAT(log.messages(), IsEmpty());
}

TEST(McapWriter, KeepsChannelsWithoutMessages) {
  const TestFolder folder;
  McapChannel image{"/camera/1", "jpeg", {}, {{"width", "640"}, {"height", "480"}}};
  {
    McapWriter log(folder / "log.mcap");
    log.add_channel(image);
  }
  const McapReader log(folder / "log.mcap");
  EXPECT_FALSE(log.truncated());
  EXPECT_EQ(log.channels().at(1), image);
}

TEST(McapWriter, CarriesAnyBytes) {
  const TestFolder folder;
  std::string every_byte;
  for (int i = 0; i < 256; ++i) every_byte += static_cast<char>(i);
  {
    McapWriter log(folder / "log.mcap");
    const auto image = log.add_channel({"/image", "x-bytes"});
    log.write(image, 5, every_byte);
    log.write(image, 6, std::span<const std::byte>());
  }
  const McapReader log(folder / "log.mcap");
  ASSERT_THAT(log.messages(), SizeIs(2));
  EXPECT_EQ(log.messages()[0].text(), every_byte);
  EXPECT_EQ(log.messages()[1].text(), "");
}

TEST(McapWriter, GivesAMessageBiggerThanAChunkAChunkOfItsOwn) {
  const TestFolder folder;
  const std::string big(100'000, 'x');
  McapWriter log(folder / "log.mcap", {.chunk_size = 1000});
  const auto channel = log.add_channel(json_channel("/arm"));
  log.write(channel, 1, big);
  EXPECT_EQ(McapReader(folder / "log.mcap").messages().size(), 1U) << "a full chunk is written at once";
  log.write(channel, 2, "small");
  EXPECT_EQ(McapReader(folder / "log.mcap").messages().size(), 1U) << "the next one is not full";
  log.close();
  const McapReader read(folder / "log.mcap");
  ASSERT_THAT(read.messages(), SizeIs(2));
  EXPECT_EQ(read.messages()[0].text(), big);
  EXPECT_EQ(read.messages()[1].text(), "small");
}

TEST(McapWriter, KeepsTheOrderOfWritingWhateverTheTimes) {
  const TestFolder folder;
  {
    McapWriter log(folder / "log.mcap");
    const auto channel = log.add_channel(json_channel("/arm"));
    for (const std::uint64_t time : {5U, 1U, 9U, 1U}) log.write(channel, time, "m");
    log.write(channel, UINT64_MAX, "last");
  }
  EXPECT_THAT(reported(McapReader(folder / "log.mcap")),
              ElementsAre("/arm 5 0 m", "/arm 1 1 m", "/arm 9 2 m", "/arm 1 3 m",
                          "/arm 18446744073709551615 4 last"));
}

TEST(McapWriter, SharesASchemaBetweenChannels) {
  const TestFolder folder;
  const McapSchema pose{"Pose", "jsonschema", R"({"title":"Pose"})"};
  {
    McapWriter log(folder / "log.mcap");
    log.add_channel({"/tip", "json", pose, {}});
    log.add_channel({"/base", "json", pose, {}});
  }
  const std::string bytes = file_bytes(folder / "log.mcap");
  std::size_t copies = 0;
  for (std::size_t at = 0; (at = bytes.find(pose.data, at)) != std::string::npos; ++at) ++copies;
  EXPECT_EQ(copies, 2U) << "one in the data, one in the summary";
  EXPECT_EQ(McapReader(folder / "log.mcap").channels().at(2).schema, pose);
}

TEST(McapWriter, RefusesUnknownChannelsAndTakenTopics) {
  const TestFolder folder;
  McapWriter log(folder / "log.mcap");
  EXPECT_THROW(log.write(1, 0, "m"), std::out_of_range);
  const auto channel = log.add_channel(json_channel("/arm"));
  EXPECT_THROW(log.write(0, 0, "m"), std::out_of_range);
  EXPECT_THROW(log.write(static_cast<std::uint16_t>(channel + 1), 0, "m"), std::out_of_range);
  EXPECT_THROW(log.add_channel(json_channel("/arm")), std::invalid_argument);
  EXPECT_THROW(log.add_channel(json_channel("")), std::invalid_argument);
  log.close();
  log.close();
  EXPECT_THROW(log.write(channel, 0, "m"), std::logic_error);
  EXPECT_THROW(log.add_channel(json_channel("/late")), std::logic_error);
  EXPECT_THROW(log.flush(), std::logic_error);
  EXPECT_THAT(reported(McapReader(folder / "log.mcap")), IsEmpty());
}

TEST(McapWriter, NeverOverwrites) {
  const TestFolder folder;
  write_small_log(folder / "log.mcap");
  const std::string before = file_bytes(folder / "log.mcap");
  try {
    McapWriter again(folder / "log.mcap");
    FAIL() << "it opened a log that exists";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code(), std::errc::file_exists);
    EXPECT_THAT(error.what(), HasSubstr(folder / "log.mcap"));
  }
  EXPECT_EQ(file_bytes(folder / "log.mcap"), before);
}

TEST(McapWriter, SaysWhichFileItCannotCreate) {
  const TestFolder folder;
  try {
    McapWriter log(folder / "no/such/folder/log.mcap");
    FAIL() << "it made a file in a folder that does not exist";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code(), std::errc::no_such_file_or_directory);
    EXPECT_THAT(error.what(), HasSubstr("no/such/folder/log.mcap"));
  }
  EXPECT_THROW(McapWriter(folder / "log.mcap", {.chunk_size = 0}), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(folder / "log.mcap"));
}

TEST(McapWriter, LeavesCompleteChunksWhenTheDiskIsFull) {
  const TestFolder folder;
  const auto path = folder / "log.mcap";
  std::size_t accepted = 0;
  {
    McapWriter log(path, {.chunk_size = 1000});
    const auto channel = log.add_channel(json_channel("/arm"));
    const FullDisk disk(10'000);
    try {
      while (accepted < 1000) log.write(channel, ++accepted, std::string(500, 'x'));
      FAIL() << "the limit did not hold";
    } catch (const std::system_error& error) {
      EXPECT_EQ(error.code(), std::errc::file_too_large);
      EXPECT_THAT(error.what(), HasSubstr(path.string()));
    }
    EXPECT_THROW(log.write(channel, 0, "m"), std::logic_error);
  }
  const McapReader log(path);
  EXPECT_TRUE(log.truncated());
  // Two messages per chunk; the last chunk did not fit.
  EXPECT_EQ(log.messages().size(), accepted - 2);
  EXPECT_GT(accepted, 10U);
}

}  // namespace
}  // namespace flexura
