#include "flexura/store/mcap_reader.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "flexura/store/mcap_cursor.h"

namespace flexura {
namespace {

/// Each channel has a copy of its schema. Limits the memory for a small log with a large schema and many
/// channels, which no real writer produces.
constexpr std::size_t max_copied_schemas = std::size_t{64} << 20;

/// Limit on the content of all compressed chunks. It bounds the memory for messages, and the time, that a
/// small file can cost: a chunk of the shortest messages may expand a thousand times.
std::size_t most_content(std::size_t file_size) {
  constexpr std::size_t always = std::size_t{64} << 20, most_ratio = 256;
  return always + most_ratio * file_size;
}

/// Kind of a record, its start and its content.
struct Record {
  McapOp op;
  std::size_t start;
  McapCursor content;
};

bool starts_with(std::span<const std::byte> bytes, std::string_view text) {
  const auto expected = std::as_bytes(std::span(text));
  return bytes.size() >= text.size() && std::ranges::equal(bytes.first(text.size()), expected);
}

/// Returns text from a file for an error message: short, and harmless on a terminal.
std::string shown(std::string text) {
  constexpr std::size_t enough = 32;
  if (text.size() > enough) text = text.substr(0, enough) + "...";
  const auto printable = [](char c) { return c >= ' ' && c <= '~'; };
  std::ranges::replace_if(text, [&](char c) { return !printable(c); }, '?');
  return '"' + text + '"';
}

/// Returns true for kinds that are not allowed after the data section.
bool is_data(McapOp op) {
  static constexpr auto kinds = {McapOp::message,    McapOp::chunk,    McapOp::message_index,
                                 McapOp::attachment, McapOp::metadata, McapOp::data_end};
  return std::ranges::find(kinds, op) != kinds.end();
}

/// Returns true if the log was closed properly. Then a record that does not fit is damage, not the point
/// where a writer stopped.
bool has_end(std::span<const std::byte> log) {
  return log.size() >= 2 * mcap_magic.size() && starts_with(log.last(mcap_magic.size()), mcap_magic);
}

}  // namespace

/// One pass over a log, which fills a reader.
class McapScan {
 public:
  // `mapped`: the file of the log; null if the log is in memory.
  McapScan(std::span<const std::byte> log, const MappedFile* mapped, const std::string& name, McapCheck check,
           McapReader& to)
      : name_(name),
        cursor_(log, name_),
        check_(check),
        has_end_(has_end(log)),
        content_left_(most_content(log.size())),
        mapped_(mapped),
        to_(to) {
    to_.chunks_ = std::make_unique<McapChunks>(log, name_, mapped);
  }

  void run() {
    to_.truncated_ = true;  // Until the end is found.
    if (!take_magic("not an MCAP log")) return;
    pass();
    for (bool first = true; auto record = next(cursor_); first = false) {
      if (first != (record->op == McapOp::header)) {
        cursor_.fail("a log must begin with its header, and must have only one header", record->start);
      }
      if (record->op == McapOp::footer) {
        finish(*record);
        return;
      }
      take_top(*record);
      pass();
    }
  }

 private:
  /// Adds what was read to the data section's CRC, so that the file is read only once.
  void pass() {
    const McapCursor here = cursor_;
    const std::size_t end = here.position();
    if (check_ != McapCheck::structure && !data_end_) crc_ = mcap_crc(crc_, here.since(passed_));
    if (mapped_ != nullptr) mapped_->has_read(end - passed_);
    passed_ = end;
  }

  /// Returns false if the log ends inside the magic bytes.
  bool take_magic(const char* otherwise) {
    const std::size_t length = std::min(cursor_.remaining(), mcap_magic.size());
    if (!starts_with(cursor_.rest(), mcap_magic.substr(0, length))) cursor_.fail(otherwise);
    cursor_.take_bytes(length);
    return length == mcap_magic.size();
  }

  /// Returns the next record; std::nullopt where the log ends.
  std::optional<Record> next(McapCursor& in) const {
    const std::size_t start = in.position();
    McapCursor ahead = in;
    const bool header_fits = in.remaining() >= mcap_record_header;
    if (header_fits) {
      const auto op = McapOp{ahead.take<std::uint8_t>()};
      const auto length = ahead.take<std::uint64_t>();
      if (op == McapOp{0}) in.fail("no record has the kind 0");
      if (length <= ahead.remaining()) {
        in = ahead;
        return Record{op, start, in.take_part(length)};
      }
    }
    if (has_end_) in.fail("a record exceeds the part of the log that contains it");
    return std::nullopt;
  }

  void take_top(Record& record) {
    if (data_end_ && is_data(record.op))
      cursor_.fail("there are data after the end of the data section", record.start);
    switch (record.op) {
      case McapOp::header:
        record.content.take_text();  // The profile.
        to_.library_ = record.content.take_text();
        break;
      case McapOp::chunk:
        if (check_ == McapCheck::skip) {
          try_chunk(record.content);
        } else {
          take_chunk(record.content);
        }
        break;
      case McapOp::data_end:
        take_data_end(record);
        break;
      default:
        take_inner(record);  // Indexes and statistics are not needed; unknown kinds are ignored.
    }
  }

  /// Takes records of the kinds that chunks also contain. Returns true for those.
  bool take_inner(Record& record) {
    switch (record.op) {
      case McapOp::schema:
        take_schema(record);
        return true;
      case McapOp::channel:
        take_channel(record);
        return true;
      case McapOp::message:
        take_message(record);
        return true;
      default:
        return false;
    }
  }

  /// Takes a chunk, or nothing of it if it is damaged.
  void try_chunk(McapCursor& in) {
    const std::size_t before = to_.messages_.size();
    McapDamage damage;
    McapCursor times = in;
    try {
      damage.from = times.take<std::uint64_t>(), damage.to = times.take<std::uint64_t>();
      take_chunk(in);
    } catch (const std::runtime_error& error) {
      to_.messages_.resize(before, {});
      chunk_ = McapChunks::plain;
      damage.what = error.what();
      to_.damage_.push_back(std::move(damage));
    }
  }

  void take_chunk(McapCursor& in) {
    in.take_bytes(2 * sizeof(std::uint64_t));  // Times of the first and the last message.
    const auto size = in.take<std::uint64_t>();
    const auto crc = in.take<std::uint32_t>();
    const std::size_t compression_at = in.position();
    const std::string compression = in.take_text();
    if (!compression.empty() && compression != mcap_zstd) {
      in.fail("a chunk is compressed (" + shown(compression) + "); only plain and zstd chunks are read",
              compression_at);
    }
    McapCursor stored = in.take_part(in.take<std::uint64_t>());
    if (compression.empty()) {
      if (stored.remaining() != size) in.fail("a plain chunk has two different sizes", stored.position());
      check_crc(crc, stored.rest(), stored, "a chunk's");
      take_records(stored);
      return;
    }
    if (size > mcap_most_chunk)
      in.fail("a compressed chunk has more than 128 MiB, " + std::to_string(size), stored.position());
    if (size > content_left_) in.fail("the compressed chunks have too much content", stored.position());
    content_left_ -= size;
    chunk_ = to_.chunks_->add(stored.rest(), size);
    const auto content = to_.chunks_->content(chunk_);
    check_crc(crc, content->bytes(), stored, "a chunk's");
    const std::string name = name_ + ": content of the chunk at byte " + std::to_string(stored.position());
    McapCursor records(content->bytes(), name);
    take_records(records);
    chunk_ = McapChunks::plain;
  }

  /// Takes the records of a chunk.
  void take_records(McapCursor& records) {
    while (!records.done()) {
      const std::size_t start = records.position();
      const auto op = McapOp{records.take<std::uint8_t>()};
      Record record{op, start, records.take_part(records.take<std::uint64_t>())};
      if (!take_inner(record) && op <= McapOp::data_end)
        records.fail("this record is not allowed in a chunk", start);
    }
  }

  void take_schema(Record& record) {
    McapCursor& in = record.content;
    const auto id = in.take<std::uint16_t>();
    McapSchema schema;
    schema.name = in.take_text();
    schema.encoding = in.take_text();
    schema.data = in.take_text();
    if (id == 0) return;  // Invalid, and to be ignored.
    const auto [known, is_new] = schemas_.try_emplace(id, schema);
    if (!is_new && known->second != schema)
      in.fail("a schema is defined twice with different contents", record.start);
  }

  void take_channel(Record& record) {
    McapCursor& in = record.content;
    const auto id = in.take<std::uint16_t>();
    const auto schema_id = in.take<std::uint16_t>();
    McapChannel channel;
    channel.topic = in.take_text();
    channel.encoding = in.take_text();
    McapCursor metadata = in.take_part(in.take<std::uint32_t>());
    while (!metadata.done()) {
      std::string key = metadata.take_text();
      channel.metadata[std::move(key)] = metadata.take_text();
    }
    const auto schema = schemas_.find(schema_id);
    if (schema != schemas_.end()) {
      copied_schemas_ += schema->second.data.size();
      if (copied_schemas_ > max_copied_schemas)
        in.fail("the channels' schemas need too much memory", record.start);
      channel.schema = schema->second;
    } else if (schema_id != 0) {
      in.fail("a channel has an unknown schema, " + std::to_string(schema_id), record.start);
    }
    const auto [known, is_new] = to_.channels_.try_emplace(id, channel);
    if (!is_new && known->second != channel)
      in.fail("a channel is defined twice with different contents", record.start);
  }

  void take_message(Record& record) {
    McapCursor& in = record.content;
    const auto id = in.take<std::uint16_t>();
    const auto sequence = in.take<std::uint32_t>();
    const auto log_time = in.take<std::uint64_t>();
    in.take_bytes(sizeof(std::uint64_t));  // Publication time.
    const auto channel = to_.channels_.find(id);
    if (channel == to_.channels_.end()) {
      // A skipped chunk may have defined it.
      if (!to_.damage_.empty()) return;
      in.fail("a message is on an unknown channel, " + std::to_string(id), record.start);
    }
    to_.messages_.push_back(
        {&channel->second, log_time, sequence, chunk_, to_.chunks_.get(), in.position(), in.remaining()});
  }

  void take_data_end(Record& record) {
    const auto crc = record.content.take<std::uint32_t>();
    data_end_ = cursor_.position();
    if (to_.damage_.empty()) check_crc(crc, crc_, record.content, "the data section's");
  }

  void finish(Record& record) {
    McapCursor& in = record.content;
    if (!data_end_) in.fail("the log ends before its data section ends", record.start);
    if (in.remaining() != mcap_footer_length) in.fail("a footer has 20 bytes", record.start);
    const auto summary_start = in.take<std::uint64_t>();
    if (summary_start != 0 && summary_start != *data_end_) {
      in.fail("the footer has a wrong position of the summary", record.start);
    }
    in.take_bytes(sizeof(std::uint64_t));  // Start of the summary's offsets.
    const auto summary = in.since(*data_end_);
    check_crc(in.take<std::uint32_t>(), summary, in, "the summary's");
    if (!take_magic("the log's last bytes are wrong")) return;
    if (!cursor_.done()) cursor_.fail("there are bytes after the end of the log");
    to_.truncated_ = false;
  }

  void check_crc(std::uint32_t expected, std::span<const std::byte> bytes, const McapCursor& where,
                 const std::string& whose) const {
    if (check_ != McapCheck::structure) check_crc(expected, mcap_crc(0, bytes), where, whose);
  }
  void check_crc(std::uint32_t expected, std::uint32_t found, const McapCursor& where,
                 const std::string& whose) const {
    constexpr std::uint32_t not_given = 0;
    if (check_ == McapCheck::structure || expected == not_given) return;
    if (found != expected) where.fail(whose + " CRC is wrong");
  }

  const std::string& name_;
  McapCursor cursor_;
  McapCheck check_;
  bool has_end_;
  std::optional<std::size_t> data_end_;  ///< End of the data section's last record.
  std::size_t passed_ = 0;               ///< Number of bytes in crc_.
  std::uint32_t crc_ = 0;                ///< Of the data section.
  std::map<std::uint16_t, McapSchema> schemas_;
  std::size_t copied_schemas_ = 0;           ///< Bytes.
  std::size_t content_left_;                 ///< Bytes that further compressed chunks may have.
  std::uint32_t chunk_ = McapChunks::plain;  ///< The compressed chunk that is being read.
  const MappedFile* mapped_;
  McapReader& to_;
};

McapReader::McapReader(const std::filesystem::path& path, McapCheck check)
    : file_(std::make_unique<const MappedFile>(path)) {
  const std::string name = path.string();
  McapScan(file_->bytes(), file_.get(), name, check, *this).run();
}

McapReader::McapReader(std::span<const std::byte> bytes, const std::string& name, McapCheck check) {
  McapScan(bytes, nullptr, name, check, *this).run();
}

}  // namespace flexura
