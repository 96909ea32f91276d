#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>

#include "flexura/store/mcap_reader.h"

namespace {

/// Reads bytes as a log and accesses all results. Most mutations have wrong CRCs, hence with and without
/// them.
void read(std::span<const std::byte> bytes, flexura::McapCheck check) {
  try {
    const flexura::McapReader log(bytes, "input", check);
    for (const auto& message : log.messages()) {
      const bool inside = message.data.data() >= bytes.data() &&
                          message.data.data() + message.data.size() <= bytes.data() + bytes.size();
      const auto channel = log.channels().begin()->second.topic.size();
      if (!inside || channel > bytes.size() || message.channel->topic.size() > bytes.size()) __builtin_trap();
    }
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
