#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "flexura/store/mcap_reader.h"
#include "flexura/store/mcap_writer.h"

namespace flexura {

/// A temporary folder of the running test, removed at its end.
class TestFolder {
 public:
  TestFolder() {
    std::string name = std::filesystem::temp_directory_path() / "flexura_XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
    path_ = name;
  }
  ~TestFolder() { std::filesystem::remove_all(path_); }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline std::string file_bytes(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline std::span<const std::byte> as_log(const std::string& text) { return std::as_bytes(std::span(text)); }

/// Returns a log's messages in a form that can be compared and printed.
inline std::vector<std::string> reported(const McapReader& log) {
  std::vector<std::string> lines;
  for (const McapMessage& message : log.messages()) {
    lines.push_back(message.channel->topic + " " + std::to_string(message.log_time) + " " +
                    std::to_string(message.sequence) + " " + std::string(message.text()));
  }
  return lines;
}

inline McapChannel json_channel(const std::string& topic) {
  return {topic, "json", {"flexura" + topic, "jsonschema", R"({"type":"object"})"}, {}};
}

/// Writes a log of two channels and seven messages, in plain chunks of two, two, two and one.
inline void write_small_log(const std::filesystem::path& path) {
  McapWriter log(path, {.compress = false});
  const auto arm = log.add_channel(json_channel("/arm"));
  const auto events = log.add_channel(json_channel("/events"));
  for (std::uint64_t i = 0; i < 7; ++i) {
    log.write(i % 3 == 2 ? events : arm, 1000 * i, R"({"i":)" + std::to_string(i) + "}");
    if (i % 2 == 1) log.flush();
  }
  log.close();
}

inline std::string small_log() {
  const TestFolder folder;
  write_small_log(folder / "log.mcap");
  return file_bytes(folder / "log.mcap");
}

/// Returns a log of one channel in three compressed chunks of 20 messages each.
inline std::string compressed_log() {
  const TestFolder folder;
  McapWriter log(folder / "log.mcap");
  const auto arm = log.add_channel(json_channel("/arm"));
  for (std::uint64_t i = 0; i < 60; ++i) {
    log.write(arm, 1000 * i, R"({"bends":[[0.5,0.25],[0.5,0.25]],"i":)" + std::to_string(i) + "}");
    if (i % 20 == 19) log.flush();
  }
  log.close();
  return file_bytes(folder / "log.mcap");
}

}  // namespace flexura
