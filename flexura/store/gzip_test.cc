#include "flexura/store/gzip.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <string>

namespace flexura {
namespace {

// Returns the content of a gzip file by zlib.
std::string unpacked(std::vector<std::uint8_t> file) {
  std::string text(100'000, '\0');
  z_stream stream{};
  EXPECT_EQ(inflateInit2(&stream, 15 + 16), Z_OK);
  stream.next_in = file.data();
  stream.avail_in = static_cast<uInt>(file.size());
  stream.next_out = reinterpret_cast<Bytef*>(text.data());
  stream.avail_out = static_cast<uInt>(text.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  text.resize(stream.total_out);
  inflateEnd(&stream);
  return text;
}

TEST(Gzip, ReadsBackAndIsTheSameEachTime) {
  for (const std::string& text : {std::string(), std::string("a page"), std::string(50'000, 'x')}) {
    EXPECT_EQ(unpacked(gzip(text)), text);
    EXPECT_EQ(gzip(text), gzip(text));
  }
  EXPECT_LT(gzip(std::string(50'000, 'x')).size(), 500);
  // No date, no name.
  EXPECT_EQ(gzip("a page")[3], 0);
  EXPECT_EQ(gzip("a page")[4], 0);
}

}  // namespace
}  // namespace flexura
