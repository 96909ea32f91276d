// Logs read by @mcap/core, an independent program (tests/node).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>

#include "tests/mcap_testing.h"
#include "tests/support/checkout.h"

namespace flexura {
namespace {

using nlohmann::json;

const std::filesystem::path node_folder = checkout_file("tests/node");

/// Returns the output of a command; if it fails, an empty text and a test failure.
std::string output_of(const std::string& command) {
  FILE* const pipe = ::popen(command.c_str(), "r");
  std::string output;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) output += static_cast<char>(c);
  EXPECT_EQ(::pclose(pipe), 0) << command;
  return output;
}

/// Skipped if the readers are not installed (npm ci in tests/node), unless they are required.
class McapCore : public testing::Test {
 protected:
  void SetUp() override {
    const bool there = std::filesystem::exists(node_folder / "node_modules/@mcap/core") &&
                       std::filesystem::exists(node_folder / "node_modules/fzstd") &&
                       std::system("node --version > /dev/null 2>&1") == 0;
    if (there) return;
    if (std::getenv("FLEXURA_REQUIRE_NODE") != nullptr) FAIL() << "needs node and `npm ci` in tests/node";
    GTEST_SKIP() << "needs node and `npm ci` in tests/node";
  }

  static json read(const std::filesystem::path& log) {
    return json::parse(
        output_of("node '" + (node_folder / "read_mcap.mjs").string() + "' '" + log.string() + "'"));
  }

  void write_and_read(bool compress);

  TestFolder folder_;
};

/// Writes a log of 3001 messages, and expects @mcap/core to read them.
void McapCore::write_and_read(bool compress) {
  {
    McapWriter log(folder_ / "log.mcap", {.chunk_size = 10'000, .compress = compress});
    const auto arm = log.add_channel(json_channel("/arm"));
    const auto tip = log.add_channel({"/tip", "json", json_channel("/arm").schema, {{"unit", "m"}}});
    const auto raw = log.add_channel({"/raw", "x-text"});
    log.add_channel(json_channel("/silent"));
    for (std::uint64_t i = 0; i < 3000; ++i) {
      log.write(i % 2 == 0 ? arm : tip, 1000 + 10 * i, R"({"i":)" + std::to_string(i) + "}");
    }
    log.write(raw, 5, "before all others, written last");
  }
  const json channels = json::parse(R"([
    {"topic": "/arm", "encoding": "json", "schema": "flexura/arm", "schemaEncoding": "jsonschema", "count": 1500},
    {"topic": "/tip", "encoding": "json", "schema": "flexura/arm", "schemaEncoding": "jsonschema", "count": 1500},
    {"topic": "/raw", "encoding": "x-text", "schema": null, "schemaEncoding": null, "count": 1},
    {"topic": "/silent", "encoding": "json", "schema": "flexura/silent", "schemaEncoding": "jsonschema", "count": 0}
  ])");
  const json raw = {{"topic", "/raw"}, {"time", "5"}, {"data", "before all others, written last"}};
  const json first = {{"topic", "/arm"}, {"time", "1000"}, {"data", R"({"i":0})"}};
  const json last = {{"topic", "/tip"}, {"time", "30990"}, {"data", R"({"i":2999})"}};

  const json read_back = read(folder_ / "log.mcap");
  EXPECT_THAT(read_back["library"].get<std::string>(), testing::StartsWith("flexura 0."));
  EXPECT_EQ(read_back["indexed"],
            json({{"channels", channels}, {"start", "5"}, {"end", "30990"}, {"first", raw}, {"last", last}}));
  EXPECT_EQ(
      read_back["streamed"],
      json({{"channels", channels}, {"start", "5"}, {"end", "30990"}, {"first", first}, {"last", raw}}));
}

TEST_F(McapCore, ReadsWhatWasWritten) {
  for (const bool compress : {true, false}) {
    SCOPED_TRACE(compress);
    std::filesystem::remove(folder_ / "log.mcap");
    write_and_read(compress);
  }
}

TEST_F(McapCore, ReadsAnEmptyLog) {
  McapWriter(folder_ / "log.mcap").close();
  const json nothing = {{"channels", json::array()},
                        {"start", nullptr},
                        {"end", nullptr},
                        {"first", nullptr},
                        {"last", nullptr}};
  EXPECT_EQ(read(folder_ / "log.mcap")["indexed"], nothing);
  EXPECT_EQ(read(folder_ / "log.mcap")["streamed"], nothing);
}

TEST_F(McapCore, NoticesADamagedLog) {
  write_small_log(folder_ / "log.mcap");
  std::string bytes = file_bytes(folder_ / "log.mcap");
  bytes[bytes.find(R"({"i":3})") + 5] = '4';
  std::ofstream(folder_ / "damaged.mcap", std::ios::binary) << bytes;
  const std::string command = "node '" + (node_folder / "read_mcap.mjs").string() + "' '" +
                              (folder_ / "damaged.mcap").string() + "' 2>&1 | grep -c 'Incorrect chunk CRC'";
  EXPECT_NE(output_of(command), "0\n");
}

}  // namespace
}  // namespace flexura
