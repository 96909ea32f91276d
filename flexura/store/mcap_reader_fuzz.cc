#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "flexura/store/mcap_reader.h"

namespace {

/// Reads bytes as a log and accesses all results. Most mutations have wrong CRCs, hence with and without
/// them.
void read(std::span<const std::byte> bytes, flexura::McapCheck check) {
  // As stated for the reader.
  const std::size_t most = (std::size_t{64} << 20) + 257 * bytes.size();
  try {
    const flexura::McapReader log(bytes, "input", check);
    std::size_t content = 0;
    for (const auto& message : log.messages()) {
      const std::string text = message.text();
      content += text.size();
      const auto channel = log.channels().begin()->second.topic.size();
      if (text.size() != message.size || channel > most || message.channel->topic.size() > most)
        __builtin_trap();
    }
    if (content > most) __builtin_trap();
  } catch (const std::runtime_error&) {  // NOLINT(bugprone-empty-catch): bad logs are refused so.
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span bytes(reinterpret_cast<const std::byte*>(data), size);
  read(bytes, flexura::McapCheck::crc);
  read(bytes, flexura::McapCheck::structure);
  return 0;
}
