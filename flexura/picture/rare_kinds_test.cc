// The kinds of files that cameras seldom write: every form of them gives the values that were put into it.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <variant>

#include "flexura/picture/image_file.h"
#include "tests/support/more_picture_files.h"
#include "tests/support/picture_files.h"
#include "tests/support/picture_values.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

TEST(RareKinds, ReadEveryJpeg2000) {
  for_random_cases(20, [](TestRandom& random) {
    for (const int channels : {1, 2, 3, 4})
      for (const bool is_stream : {false, true}) {
        // Without boxes nothing says that the second of two channels is alpha: as with it, the first counts.
        Jpeg2000Form form{.is_stream = is_stream, .tile = random.integer(0, 1) * 16};
        const auto bytes = random_values<std::uint8_t>(random, side(random), side(random), channels, 255);
        EXPECT_EQ(read_bytes(jpeg2000_file(bytes, form)), without_alpha(bytes)) << channels;
        form.bits = random.integer(9, 16);
        const auto words =
            random_values<std::uint16_t>(random, side(random), side(random), channels, (1 << form.bits) - 1);
        EXPECT_EQ(read_words(jpeg2000_file(words, form)), without_alpha(words)) << form.bits;
      }
    for (const int bits : {1, 2, 4}) {
      const auto few = random_values<std::uint8_t>(random, side(random), side(random), 1, (1 << bits) - 1);
      EXPECT_EQ(read_bytes(jpeg2000_file(few, {.bits = bits})), scaled(few, bits));
    }
  });
}

// Gray has no differences of colours; the others are JPEG's.
TEST(RareKinds, ReadTheBrightnessAndColorsOfJpeg2000) {
  Image<std::uint8_t> image(4, 1, 3, 128);
  const std::array<std::array<std::uint8_t, 3>, 4> luma = {
      {{77, 128, 128}, {76, 85, 255}, {150, 44, 21}, {29, 255, 107}}};
  for (int u = 0; u < 4; ++u)
    for (int c = 0; c < 3; ++c)
      image.at(u, 0, c) = luma[static_cast<std::size_t>(u)][static_cast<std::size_t>(c)];
  const auto colors = read_bytes(jpeg2000_file(image, {.space = OPJ_CLRSPC_SYCC}));
  const std::array<std::array<int, 3>, 4> expected = {{{77, 77, 77}, {254, 0, 0}, {0, 255, 1}, {0, 0, 254}}};
  for (int u = 0; u < 4; ++u)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(colors.at(u, 0, c), expected[static_cast<std::size_t>(u)][static_cast<std::size_t>(c)], 1)
          << u << " " << c;
}

// A palette stands in two boxes of the header: its colours, and which channel is painted with which of them.
TEST(RareKinds, ReadThePaletteOfJpeg2000) {
  using namespace std::string_literals;
  TestRandom random(1);
  const auto indices = random_values<std::uint8_t>(random, 21, 13, 1, 3);
  const Colors colors = random_colors(random, 2, false);
  std::string palette = high_first(4, 2) + "\3\7\7\7"s;
  for (const auto& color : colors)
    for (const std::uint8_t value : color) palette += static_cast<char>(value);
  const std::string map = "\0\0\1\0\0\0\1\1\0\0\1\2"s;
  const auto box = [](const std::string& name, const std::string& in) {
    return high_first(static_cast<std::int64_t>(8 + in.size()), 4) + name + in;
  };
  const std::string both = box("pclr", palette) + box("cmap", map);
  std::string file = jpeg2000_file(indices, {});
  const std::size_t header = file.find("jp2h") - 4, color = file.find("colr") - 4;
  const auto size = static_cast<std::int64_t>(static_cast<unsigned char>(file[header + 3]) + both.size());
  file.replace(header, 4, high_first(size, 4)).replace(color + 14, 1, "\x10").insert(color, both);
  EXPECT_EQ(read_bytes(file), colored(indices, colors, false));
}

TEST(RareKinds, ReadEveryWebp) {
  for_random_cases(20, [](TestRandom& random) {
    const auto colors = random_values<std::uint8_t>(random, side(random), side(random), 3, 255);
    EXPECT_EQ(read_bytes(webp_file(colors, true)), colors);
    auto alpha = random_values<std::uint8_t>(random, side(random), side(random), 4, 255);
    // What nobody sees, the encoder drops.
    for (int v = 0; v < alpha.height(); ++v)
      for (int u = 0; u < alpha.width(); ++u)
        alpha.at(u, v, 3) = static_cast<std::uint8_t>(alpha.at(u, v, 3) | 1);
    EXPECT_EQ(read_bytes(webp_file(alpha, true)), without_alpha(alpha));
  });
  // One picture of colours that change slowly, and at half of the size the differences of colours.
  const auto smooth = smooth_picture(45, 33, 3);
  EXPECT_LT(mean_difference(read_bytes(webp_file(smooth, false)), smooth), 12);
}

TEST(RareKinds, ReadEverySunRaster) {
  for_random_cases(40, [](TestRandom& random) {
    for (const int type : {0, 1, 2, 3}) {
      for (const int bits : {1, 8}) {
        // Few values, so that there are runs.
        const int most = random.integer(1, (1 << bits) - 1);
        const auto indices = random_values<std::uint8_t>(random, side(random), side(random), 1, most);
        auto plain = scaled(indices, bits);
        if (bits == 1)
          for (std::uint8_t& value : plain.values()) value = value == 0 ? 255 : 0;
        EXPECT_EQ(read_bytes(sun_raster_file(indices, {bits, type})), plain) << bits << " " << type;
        for (const bool is_gray : {false, true}) {
          const Colors colors = random_colors(random, bits, is_gray);
          EXPECT_EQ(read_bytes(sun_raster_file(indices, {bits, type, colors})),
                    colored(indices, colors, is_gray));
        }
      }
      for (const int bits : {24, 32}) {
        const auto colors = random_values<std::uint8_t>(random, side(random), side(random), 3,
                                                        random.integer(0, 1) * 254 + 1);
        EXPECT_EQ(read_bytes(sun_raster_file(colors, {bits, type})), colors) << bits << " " << type;
      }
    }
  });
}

TEST(RareKinds, ReadEveryPam) {
  constexpr std::array<const char*, 5> tuples = {"", "GRAYSCALE", "GRAYSCALE_ALPHA", "RGB", "RGB_ALPHA"};
  for_random_cases(40, [&](TestRandom& random) {
    for (const int channels : {1, 2, 3, 4}) {
      const char* name = random.integer(0, 1) == 0 ? "" : tuples[static_cast<std::size_t>(channels)];
      const auto bytes = random_values<std::uint8_t>(random, side(random), side(random), channels, 255);
      EXPECT_EQ(read_bytes(pam_file(bytes, 255, name)), without_alpha(bytes));
      const auto words = random_values<std::uint16_t>(random, side(random), side(random), channels, 4095);
      EXPECT_EQ(read_words(pam_file(words, 4095, name)), without_alpha(words));
      const auto few = random_values<std::uint8_t>(random, side(random), side(random), channels, 15);
      EXPECT_EQ(read_bytes(pam_file(few, 15, name)), without_alpha(scaled(few, 4)));
    }
    // A byte each, and 1 is white.
    const auto bits = random_values<std::uint8_t>(random, side(random), side(random), 1, 1);
    EXPECT_EQ(read_bytes(pam_file(bits, 1, "BLACKANDWHITE")), scaled(bits, 1));
  });
}

TEST(RareKinds, ReadEveryBmpInRuns) {
  for_random_cases(40, [](TestRandom& random) {
    for (const int bits : {4, 8}) {
      const int most = random.integer(0, (1 << bits) - 1);
      const auto indices = random_values<std::uint8_t>(random, random.integer(1, 300), side(random), 1, most);
      for (const bool is_gray : {false, true}) {
        const Colors colors = random_colors(random, bits, is_gray);
        EXPECT_EQ(read_bytes(bmp_runs_file(random, indices, bits, colors)),
                  colored(indices, colors, is_gray));
      }
    }
  });
}

TEST(RareKinds, ReadTheJumpsOfABmpInRunsAsItsFirstColor) {
  using namespace std::string_literals;
  std::string palette;
  for (int i = 0; i < 256; ++i) palette += low_first(std::int64_t{0x010101} * i, 4);
  const std::string begin = bmp_begin(4, 3, 8, 1, palette);
  // From the lowest row: one pixel, two to the right and one up, one pixel, the end.
  const auto image = read_bytes(begin + "\1\7\0\2\2\1\1\x9\0\1"s);
  Image<std::uint8_t> expected(4, 3);
  expected.at(0, 2) = 7, expected.at(3, 1) = 9;
  EXPECT_EQ(image, expected);
  // The end's sign may be missing, rows may end early.
  EXPECT_EQ(read_bytes(begin + "\0\0\0\0\4\5"s).at(3, 0), 5);
}

TEST(RareKinds, ReadEveryBmpOfBitFields) {
  struct Case {
    int bits;
    std::array<std::uint32_t, 3> masks;
    bool has_masks;
  };
  const std::array<Case, 6> cases = {{{16, {0x7C00, 0x3E0, 0x1F}, false},
                                      {16, {0x7C00, 0x3E0, 0x1F}, true},
                                      {16, {0xF800, 0x7E0, 0x1F}, true},
                                      {16, {0xF, 0xF0, 0x700}, true},
                                      {32, {0xFF, 0xFF00, 0xFF0000}, true},
                                      {32, {0xFF000000, 0xFF0000, 0xFF00}, true}}};
  for_random_cases(20, [&](TestRandom& random) {
    for (const auto& [bits, masks, has_masks] : cases) {
      Image<std::uint16_t> values(side(random), side(random), 3);
      Image<std::uint8_t> expected(values.width(), values.height(), 3);
      for (std::size_t i = 0; i < values.values().size(); ++i) {
        const int most = (1 << std::popcount(masks[i % 3])) - 1;
        const int value = random.integer(0, most);
        values.values()[i] = static_cast<std::uint16_t>(value);
        expected.values()[i] = static_cast<std::uint8_t>((value * 255 + most / 2) / most);
      }
      EXPECT_EQ(read_bytes(bmp_fields_file(values, bits, masks, has_masks)), expected) << bits;
    }
  });
  // Ten bits for each: their upper eight.
  Image<std::uint16_t> words(1, 1, 3);
  words.at(0, 0, 0) = 1023, words.at(0, 0, 1) = 512, words.at(0, 0, 2) = 7;
  const auto bytes = read_bytes(bmp_fields_file(words, 32, {0x3FF00000, 0xFFC00, 0x3FF}, true));
  EXPECT_EQ(bytes.at(0, 0, 0), 255);
  EXPECT_EQ(bytes.at(0, 0, 1), 128);
  EXPECT_EQ(bytes.at(0, 0, 2), 1);
}

TEST(RareKinds, ReadEveryTiffOfMoreThanEightBits) {
  for_random_cases(30, [](TestRandom& random) {
    for (const int bits : {10, 12, 14})
      for (const int channels : {1, 3, 4}) {
        TiffForm form{.bits = bits, .photometric = channels == 1 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB};
        form.tile = random.integer(0, 1) * 16, form.rows = random.integer(1, 50);
        form.is_separate = random.integer(0, 1) == 1, form.is_high_first = random.integer(0, 1) == 1;
        const auto words =
            random_values<std::uint16_t>(random, side(random), side(random), channels, (1 << bits) - 1);
        EXPECT_EQ(read_words(tiff_file(words, form)), without_alpha(words)) << bits << " " << channels;
      }
  });
}

TEST(RareKinds, ReadTheColorsThatLibtiffMixes) {
  const auto read_one = [](std::initializer_list<std::uint8_t> values, int photometric) {
    Image<std::uint8_t> image(3, 2, static_cast<int>(values.size()));
    for (std::size_t i = 0; i < image.values().size(); ++i)
      image.values()[i] = values.begin()[i % values.size()];
    const auto colors = read_bytes(tiff_file(image, {.photometric = photometric}));
    EXPECT_EQ(colors.width(), 3);
    EXPECT_EQ(colors.height(), 2);
    return std::array<int, 3>{colors.at(2, 1, 0), colors.at(2, 1, 1), colors.at(2, 1, 2)};
  };
  // Inks of 255 are full ones; brightness 76 with these differences is red.
  EXPECT_EQ(read_one({0, 255, 0, 0}, PHOTOMETRIC_SEPARATED), (std::array<int, 3>{255, 0, 255}));
  EXPECT_EQ(read_one({0, 0, 0, 255}, PHOTOMETRIC_SEPARATED), (std::array<int, 3>{0, 0, 0}));
  const auto red = read_one({76, 85, 255}, PHOTOMETRIC_YCBCR);
  EXPECT_NEAR(red[0], 254, 2);
  EXPECT_NEAR(red[1], 0, 2);
  // Without a profile CIELab's white is a screen's, not quite 255.
  for (const int value : read_one({255, 0, 0}, PHOTOMETRIC_CIELAB)) EXPECT_GT(value, 200);
  for (const int value : read_one({0, 0, 0}, PHOTOMETRIC_CIELAB)) EXPECT_LT(value, 5);
}

// Inks stand inverted in files: 255 for none.
TEST(RareKinds, ReadTheInksOfAJpegNearly) {
  for (const bool is_luma : {false, true})
    for (const bool is_progressive : {false, true}) {
      Image<std::uint8_t> inks(45, 33, 4, 255);
      Image<std::uint8_t> expected(45, 33, 3);
      for (int v = 0; v < inks.height(); ++v)
        for (int u = 0; u < inks.width(); ++u)
          for (int c = 0; c < 3; ++c) {
            inks.at(u, v, c) = static_cast<std::uint8_t>(60 + 3 * u + v + 10 * c);
            inks.at(u, v, 3) = static_cast<std::uint8_t>(255 - 3 * v);
            expected.at(u, v, c) = static_cast<std::uint8_t>(inks.at(u, v, c) * inks.at(u, v, 3) / 255);
          }
      EXPECT_LT(mean_difference(read_bytes(jpeg_file(inks, is_progressive, is_luma)), expected), 4);
    }
}

}  // namespace
}  // namespace flexura
