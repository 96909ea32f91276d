#include "flexura/store/mcap_writer.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "flexura/store/mcap_chunks.h"
#include "flexura/store/zstd.h"

namespace flexura {
namespace {

constexpr std::size_t max_chunk_size = std::size_t{1} << 30;

McapWriter::Config checked(McapWriter::Config config) {
  if (config.chunk_size == 0 || config.chunk_size > max_chunk_size) {
    throw std::invalid_argument("chunk_size is 1 to 2^30 bytes, not " + std::to_string(config.chunk_size));
  }
  return config;
}

/// Returns the next identifier; they count from 1.
template <typename T>
std::uint16_t next_id(const std::vector<T>& list) {
  if (list.size() >= std::numeric_limits<std::uint16_t>::max()) {
    throw std::length_error("a log can have at most 65535 channels");
  }
  return static_cast<std::uint16_t>(list.size() + 1);
}

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& path, Config config)
    : config_(checked(config)), file_(path) {
  McapBytes out;
  out.put(std::as_bytes(std::span(mcap_magic)));
  out.record(McapOp::header, [&] {
    out.put(std::string_view());  // No profile: no conventions beyond MCAP itself.
    out.put(std::string_view("flexura " FLEXURA_VERSION));
  });
  append(out);
}

McapWriter::~McapWriter() {
  try {
    close();
  } catch (...) {  // NOLINT(bugprone-empty-catch): a destructor has nobody to tell.
  }
}

void McapWriter::append(const McapBytes& out) {
  file_.append(out.bytes());
  crc_ = mcap_crc(crc_, out.bytes());
}

void McapWriter::require_open() const {
  if (!file_.is_open()) throw std::logic_error("the log is closed: " + file_.path().string());
}

std::uint16_t McapWriter::add_channel(McapChannel channel) {
  require_open();
  const auto same_topic = [&](const auto& other) { return other.description.topic == channel.topic; };
  if (channel.topic.empty() || std::ranges::any_of(summary_.channels, same_topic)) {
    throw std::invalid_argument("a channel needs a new, non-empty topic, not \"" + channel.topic + "\"");
  }
  const std::uint16_t id = next_id(summary_.channels);
  const McapSchema schema = channel.schema;
  const auto known = std::ranges::find(summary_.schemas, schema);
  const bool has_schema = !schema.encoding.empty();
  const bool new_schema = has_schema && known == summary_.schemas.end();
  const auto schema_id = static_cast<std::uint16_t>(has_schema ? known - summary_.schemas.begin() + 1 : 0);

  McapBytes out;
  if (new_schema) put_schema(out, schema_id, schema);
  const McapSummary::Channel entry{std::move(channel), schema_id, 0};
  put_channel(out, id, entry);
  append(out);
  if (new_schema) summary_.schemas.push_back(schema);
  summary_.channels.push_back(entry);
  chunk_index_.emplace_back();
  return id;
}

void McapWriter::write(std::uint16_t channel, std::uint64_t log_time, std::span<const std::byte> data) {
  require_open();
  if (channel == 0 || channel > summary_.channels.size()) {
    throw std::out_of_range("the log has no channel " + std::to_string(channel));
  }
  std::uint64_t& count = summary_.channels[channel - 1U].message_count;
  chunk_index_[channel - 1U].push_back({log_time, records_.size()});
  chunk_time_.add(log_time);
  records_.record(McapOp::message, [&] {
    records_.put(channel);
    records_.put(static_cast<std::uint32_t>(count));  // Sequence number; MCAP allows it to wrap.
    records_.put(log_time);
    records_.put(log_time);  // Published when logged: there is one clock.
    records_.put(data);
  });
  ++count;
  if (records_.size() >= config_.chunk_size) flush();
}

void McapWriter::flush() {
  require_open();
  if (records_.size() == 0) return;
  McapBytes out;
  McapChunkIndex chunk;
  chunk.time = chunk_time_;
  chunk.start = file_.size();
  chunk.records_size = records_.size();
  put_chunk(out, chunk);
  put_message_indexes(out, chunk);
  append(out);
  summary_.chunks.push_back(std::move(chunk));
  records_.clear();
  chunk_time_ = {};
  for (auto& entries : chunk_index_) entries.clear();
}

void McapWriter::put_chunk(McapBytes& out, McapChunkIndex& chunk) const {
  std::vector<std::byte> frame;
  if (config_.compress && records_.size() <= mcap_most_chunk) frame = zstd(records_.bytes());
  const bool is_compressed = !frame.empty() && frame.size() < records_.size();
  const std::span<const std::byte> stored(is_compressed ? frame : records_.bytes());
  if (is_compressed) chunk.compression = mcap_zstd;
  chunk.stored_size = stored.size();
  out.record(McapOp::chunk, [&] {
    out.put(chunk_time_.start);
    out.put(chunk_time_.end);
    out.put(std::uint64_t{records_.size()});
    out.put(mcap_crc(0, records_.bytes()));
    out.put(chunk.compression);
    out.put(chunk.stored_size);
    out.put(stored);
  });
  chunk.length = out.size();
}

void McapWriter::put_message_indexes(McapBytes& out, McapChunkIndex& chunk) const {
  for (std::uint16_t id = 0; const auto& entries : chunk_index_) {
    ++id;
    if (entries.empty()) continue;
    chunk.message_index_offsets[id] = chunk.start + out.size();
    out.record(McapOp::message_index, [&] {
      out.put(id);
      out.measured<std::uint32_t>([&] {
        for (const IndexEntry& entry : entries) {
          out.put(entry.time);
          out.put(entry.offset);
        }
      });
    });
  }
  chunk.message_index_length = out.size() - chunk.length;
}

void McapWriter::close() {
  if (!file_.is_open()) return;
  flush();
  McapBytes out;
  out.record(McapOp::data_end, [&] { out.put(crc_); });
  put_summary(out, file_.size() + out.size(), summary_);
  append(out);
  file_.close();
}

}  // namespace flexura
