#include "flexura/store/mcap_chunks.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace flexura {
namespace {

// Neighbours in time are often in neighbouring chunks: a camera's picture and the state next to it.
constexpr std::size_t most_held = 4;
constexpr std::size_t most_held_bytes = std::size_t{16} << 20;  // A larger chunk is held alone.

}  // namespace

std::uint32_t McapChunks::add(std::span<const std::byte> frames, std::size_t size) {
  chunks_.push_back({frames, size});
  return static_cast<std::uint32_t>(chunks_.size());
}

std::shared_ptr<const ByteBuffer> McapChunks::content(std::uint32_t chunk) const {
  {
    const std::scoped_lock lock(mutex_);
    const auto known = std::ranges::find(held_, chunk, &Held::chunk);
    if (known != held_.end()) {
      std::rotate(known, known + 1, held_.end());
      return held_.back().content;
    }
  }
  const Chunk& source = chunks_.at(chunk - 1U);
  if (mapped_ != nullptr) mapped_->require_whole();
  std::shared_ptr<const ByteBuffer> content;
  try {
    content = std::make_shared<const ByteBuffer>(unzstd(source.frames, source.size));
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(name_ + ": byte " + std::to_string(source.frames.data() - file_.data()) +
                             ": a chunk does not decompress: " + error.what());
  }
  if (mapped_ != nullptr) mapped_->has_read(source.frames.size());
  const std::scoped_lock lock(mutex_);
  held_.push_back({chunk, content});
  const auto held_bytes = [&] {
    return std::accumulate(held_.begin(), held_.end(), std::size_t{0},
                           [](std::size_t sum, const Held& held) { return sum + held.content->size; });
  };
  while (held_.size() > 1 && (held_.size() > most_held || held_bytes() > most_held_bytes))
    held_.erase(held_.begin());
  return content;
}

std::string McapChunks::text(std::uint32_t chunk, std::size_t offset, std::size_t size) const {
  const auto copied = [&](std::span<const std::byte> bytes) {
    const auto part = bytes.subspan(offset, size);
    return std::string(reinterpret_cast<const char*>(part.data()), part.size());
  };
  if (chunk != plain) return copied(content(chunk)->bytes());
  if (mapped_ != nullptr) mapped_->require_whole();
  std::string text = copied(file_);
  if (mapped_ != nullptr) mapped_->has_read(size);
  return text;
}

}  // namespace flexura
