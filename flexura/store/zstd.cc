#include "flexura/store/zstd.h"

#include <zstd.h>

#include <stdexcept>
#include <string>

namespace flexura {
namespace {

// Contexts take much memory, so each thread keeps one.
struct FreeContext {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

// The shortest block has 4 bytes and repeats one byte up to 128 KiB times (RFC 8878, 3.1.1.2).
constexpr std::size_t most_expansion = std::size_t{128} * 1024 / 4;

}  // namespace

std::vector<std::byte> zstd(std::span<const std::byte> bytes) {
  constexpr int level = 3;  // libzstd's own choice: faster than the messages are made.
  thread_local const std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
  if (context == nullptr) throw std::runtime_error("zstd did not start");
  std::vector<std::byte> frame(ZSTD_compressBound(bytes.size()));
  const std::size_t size =
      ZSTD_compressCCtx(context.get(), frame.data(), frame.size(), bytes.data(), bytes.size(), level);
  if (ZSTD_isError(size) != 0)
    throw std::runtime_error(std::string("zstd did not compress: ") + ZSTD_getErrorName(size));
  frame.resize(size);
  return frame;
}

ByteBuffer unzstd(std::span<const std::byte> frames, std::size_t size) {
  if (size / most_expansion > frames.size())
    throw std::runtime_error(std::to_string(frames.size()) + " bytes cannot hold " + std::to_string(size));
  thread_local const std::unique_ptr<ZSTD_DCtx, FreeContext> context(ZSTD_createDCtx());
  if (context == nullptr) throw std::runtime_error("zstd did not start");
  ByteBuffer content{std::make_unique_for_overwrite<std::byte[]>(size), size};
  const std::size_t found =
      ZSTD_decompressDCtx(context.get(), content.start.get(), size, frames.data(), frames.size());
  if (ZSTD_isError(found) != 0) throw std::runtime_error(ZSTD_getErrorName(found));
  if (found != size)
    throw std::runtime_error("it has " + std::to_string(found) + " bytes, not " + std::to_string(size));
  return content;
}

}  // namespace flexura
