// Files of every kind, made by their own libraries or by hand, give the values that were written.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <variant>

#include "flexura/picture/image_file.h"
#include "tests/support/picture_files.h"
#include "tests/support/picture_values.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

TEST(PictureReader, ReadsEveryPng) {
  for_random_cases(40, [](TestRandom& random) {
    for (const bool is_interlaced : {false, true}) {
      for (const int bits : {1, 2, 4, 8}) {
        const auto gray = random_values<std::uint8_t>(random, side(random), side(random), 1, (1 << bits) - 1);
        EXPECT_EQ(read_bytes(png_file(gray, {bits, is_interlaced})), scaled(gray, bits));
        for (const bool is_gray : {false, true}) {
          const Colors colors = random_colors(random, bits, is_gray);
          EXPECT_EQ(read_bytes(png_file(gray, {bits, is_interlaced, colors})),
                    colored(gray, colors, is_gray));
        }
      }
      for (const int channels : {1, 2, 3, 4}) {
        const auto bytes = random_values<std::uint8_t>(random, side(random), side(random), channels, 255);
        EXPECT_EQ(read_bytes(png_file(bytes, {8, is_interlaced})), without_alpha(bytes));
        const auto words = random_values<std::uint16_t>(random, side(random), side(random), channels, 65535);
        EXPECT_EQ(read_words(png_file(words, {16, is_interlaced})), without_alpha(words));
      }
    }
  });
}

TEST(PictureReader, ReadsAPngsColorsBeyondItsPaletteAsBlack) {
  Image<std::uint8_t> indices(2, 1);
  indices.at(1, 0) = 3;
  EXPECT_EQ(read_bytes(png_file(indices, {8, false, {{9, 8, 7}}})).at(1, 0, 0), 0);
}

TEST(PictureReader, ReadsEveryJpegNearly) {
  for (const int channels : {1, 3}) {
    for (const bool is_progressive : {false, true}) {
      const Image<std::uint8_t> image = smooth_picture(45, 33, channels);
      EXPECT_LT(mean_difference(read_bytes(jpeg_file(image, is_progressive)), image), 4);
    }
  }
}

TEST(PictureReader, ReadsEveryTiffOfBytesAndWords) {
  for_random_cases(30, [](TestRandom& random) {
    for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_PACKBITS,
                                  COMPRESSION_ADOBE_DEFLATE, COMPRESSION_ZSTD, COMPRESSION_LZMA})
      for (const int channels : {1, 2, 3, 4}) {
        TiffForm form;
        form.compression = compression;
        form.photometric = channels < 3 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB;
        form.tile = random.integer(0, 1) * 16, form.rows = random.integer(1, 50);
        form.is_separate = random.integer(0, 1) == 1, form.is_high_first = random.integer(0, 1) == 1;
        const auto bytes = random_values<std::uint8_t>(random, side(random), side(random), channels, 255);
        EXPECT_EQ(read_bytes(tiff_file(bytes, form)), without_alpha(bytes)) << compression << " " << channels;
        const auto words = random_values<std::uint16_t>(random, side(random), side(random), channels, 65535);
        form.bits = 16;
        EXPECT_EQ(read_words(tiff_file(words, form)), without_alpha(words)) << compression << " " << channels;
      }
  });
}

TEST(PictureReader, ReadsEveryTiffOfFewBits) {
  for_random_cases(30, [](TestRandom& random) {
    for (const int bits : {1, 2, 4, 8}) {
      const auto gray = random_values<std::uint8_t>(random, side(random), side(random), 1, (1 << bits) - 1);
      TiffForm form;
      form.bits = bits, form.tile = random.integer(0, 1) * 32;
      EXPECT_EQ(read_bytes(tiff_file(gray, form)), scaled(gray, bits));
      form.photometric = PHOTOMETRIC_MINISWHITE;
      Image<std::uint8_t> turned = scaled(gray, bits);
      for (std::uint8_t& value : turned.values()) value = static_cast<std::uint8_t>(255 - value);
      EXPECT_EQ(read_bytes(tiff_file(gray, form)), turned);
      if (bits == 1)
        for (const int fax : {COMPRESSION_CCITTRLE, COMPRESSION_CCITTFAX3, COMPRESSION_CCITTFAX4}) {
          form.compression = fax;
          EXPECT_EQ(read_bytes(tiff_file(gray, form)), turned) << fax;
        }
      form.photometric = PHOTOMETRIC_PALETTE, form.compression = COMPRESSION_LZW;
      for (const bool is_gray : {false, true}) {
        form.palette = random_colors(random, bits, is_gray);
        EXPECT_EQ(read_bytes(tiff_file(gray, form)), colored(gray, form.palette, is_gray));
      }
    }
  });
}

TEST(PictureReader, ReadsTheJpegInATiffNearly) {
  for (const int tile : {0, 16})
    for (const int photometric : {PHOTOMETRIC_MINISBLACK, PHOTOMETRIC_RGB, PHOTOMETRIC_YCBCR}) {
      const auto image = smooth_picture(45, 33, photometric == PHOTOMETRIC_MINISBLACK ? 1 : 3);
      TiffForm form;
      form.compression = COMPRESSION_JPEG, form.photometric = photometric, form.tile = tile, form.rows = 16;
      EXPECT_LT(mean_difference(read_bytes(tiff_file(image, form)), image), 12);
    }
}

TEST(PictureReader, ReadsEveryPnm) {
  for_random_cases(40, [](TestRandom& random) {
    for (const bool is_plain : {false, true}) {
      const auto bits = random_values<std::uint8_t>(random, side(random), side(random), 1, 1);
      Image<std::uint8_t> bright = bits;
      for (std::uint8_t& value : bright.values()) value = value == 1 ? 0 : 255;
      EXPECT_EQ(read_bytes(pbm_file(bits, is_plain)), bright);
      for (const int channels : {1, 3}) {
        auto bytes = random_values<std::uint8_t>(random, side(random), side(random), channels, 255);
        EXPECT_EQ(read_bytes(pnm_file(bytes, 255, is_plain)), bytes);
        auto words = random_values<std::uint16_t>(random, side(random), side(random), channels, 4095);
        EXPECT_EQ(read_words(pnm_file(words, 4095, is_plain)), words);
        const auto few = random_values<std::uint8_t>(random, side(random), side(random), channels, 15);
        EXPECT_EQ(read_bytes(pnm_file(few, 15, is_plain)), scaled(few, 4));
      }
    }
  });
}

TEST(PictureReader, ReadsEveryTiffOfMoreThanEightBits) {
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

TEST(PictureReader, ReadsTheColorsThatLibtiffMixes) {
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
  // Without a profile CIELab's white is that of a screen, not exactly 255.
  for (const int value : read_one({255, 0, 0}, PHOTOMETRIC_CIELAB)) EXPECT_GT(value, 200);
  for (const int value : read_one({0, 0, 0}, PHOTOMETRIC_CIELAB)) EXPECT_LT(value, 5);
}

// Files store inks inverted: 255 for no ink.
TEST(PictureReader, ReadsTheInksOfAJpegNearly) {
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
