#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/store/mcap_file.h"
#include "flexura/store/mcap_records.h"

namespace flexura {

/// One message of a log; valid as long as its McapReader.
struct McapMessage {
  const McapChannel* channel;
  std::uint64_t log_time;           ///< Simulated time, ns.
  std::uint32_t sequence;           ///< Number of the message as counted by the writer; it may wrap.
  std::span<const std::byte> data;  ///< Data as written; in the logs of runs JSON.

  /// Returns the data as text.
  [[nodiscard]] std::string_view text() const {
    return {reinterpret_cast<const char*>(data.data()), data.size()};
  }
};

/// Whether to verify checksums (`crc`) or only the structure. With `structure` all messages of a damaged log
/// are read whose structure is intact.
enum class McapCheck : std::uint8_t { crc, structure };

/// Reads the whole data section of a log, from this or another program. The memory used grows only with the
/// number of messages, because their data stay in the file's pages. A log whose writer was killed is read up
/// to its last complete chunk, and `truncated` is set. Constructors throw std::runtime_error with the log's
/// name and the position of the error in bytes. Errors are: a file that is no log, a record that exceeds its
/// part, a wrong CRC, a message without channel, a compressed chunk.
class McapReader {
 public:
  /// Also throws std::system_error if the file cannot be read.
  explicit McapReader(const std::filesystem::path& path, McapCheck check = McapCheck::crc);
  /// `bytes` must outlive the reader; `name` identifies them in errors.
  McapReader(std::span<const std::byte> bytes, const std::string& name, McapCheck check = McapCheck::crc);

  /// Returns the channels by their identifiers.
  [[nodiscard]] const std::map<std::uint16_t, McapChannel>& channels() const { return channels_; }
  /// Returns the messages in the file's order, which may differ from the order of time.
  [[nodiscard]] const std::vector<McapMessage>& messages() const { return messages_; }
  /// Returns the name of the program that wrote the log, from its header.
  [[nodiscard]] const std::string& library() const { return library_; }
  [[nodiscard]] bool truncated() const { return truncated_; }

 private:
  friend class McapScan;

  std::unique_ptr<const MappedFile> file_;
  std::map<std::uint16_t, McapChannel> channels_;  // A map, because messages point into it.
  std::vector<McapMessage> messages_;
  std::string library_;
  bool truncated_ = false;
};

}  // namespace flexura
