#include "flexura/store/gzip.h"

#include <zlib.h>

#include <stdexcept>

namespace flexura {

std::vector<std::uint8_t> gzip(std::string_view bytes) {
  constexpr int gzip_window = 15 + 16, memory = 8;
  z_stream stream{};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, gzip_window, memory, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::runtime_error("zlib did not start");
  std::vector<std::uint8_t> file(deflateBound(&stream, bytes.size()));
  // zlib's interface takes non-const bytes, but compression does not change them.
  stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = file.data();
  stream.avail_out = static_cast<uInt>(file.size());
  const int end = deflate(&stream, Z_FINISH);
  file.resize(stream.total_out);
  deflateEnd(&stream);
  if (end != Z_STREAM_END) throw std::runtime_error("zlib did not compress");
  return file;
}

}  // namespace flexura
