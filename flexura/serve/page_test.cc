// Unpacks a page as embedded by cmake/Page.cmake.
#include "embedded/page.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "flexura/serve/server.h"
#include "tests/support/checkout.h"

namespace flexura {
namespace {

std::string unpacked(std::span<const std::uint8_t> gzip) {
  std::string text(100000, '\0');
  z_stream stream{};
  inflateInit2(&stream, 16 + MAX_WBITS);
  stream.next_in = const_cast<Bytef*>(gzip.data());
  stream.avail_in = static_cast<uInt>(gzip.size());
  stream.next_out = reinterpret_cast<Bytef*>(text.data());
  stream.avail_out = static_cast<uInt>(text.size());
  if (inflate(&stream, Z_FINISH) != Z_STREAM_END || stream.avail_in != 0) throw std::runtime_error("no gzip");
  text.resize(stream.total_out);
  inflateEnd(&stream);
  return text;
}

TEST(Page, HoldsEachFileUnderItsPath) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 3> expected = {
      {{"/assets/greeting.js", "text/javascript; charset=utf-8"},
       {"/icon.svg", "image/svg+xml"},
       {"/index.html", "text/html; charset=utf-8"}}};
  const auto page = embedded::page();
  ASSERT_EQ(page.size(), expected.size());
  for (std::size_t i = 0; i < page.size(); ++i) {
    EXPECT_EQ(page[i].path, expected[i].first);
    EXPECT_EQ(page[i].content_type, expected[i].second);
    std::ifstream file(checkout_file("tests/page" + std::string(page[i].path)), std::ios::binary);
    EXPECT_EQ(unpacked(page[i].gzip), std::string(std::istreambuf_iterator<char>(file), {}));
    // No name and no time of the file: equal bytes in every build.
    EXPECT_TRUE(std::ranges::all_of(page[i].gzip.subspan(3, 5), [](std::uint8_t byte) { return byte == 0; }));
  }
}

}  // namespace
}  // namespace flexura
