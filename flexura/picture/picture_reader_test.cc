// Every kind of file, made by its own library or by hand, gives the values that were put into it.
#include <gtest/gtest.h>

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

TEST(PictureReader, ReadsEveryBmp) {
  for_random_cases(40, [](TestRandom& random) {
    for (const bool is_top_first : {false, true}) {
      const bool is_short = !is_top_first && random.integer(0, 1) == 1;
      for (const int bits : {1, 4, 8}) {
        const auto indices =
            random_values<std::uint8_t>(random, side(random), side(random), 1, (1 << bits) - 1);
        for (const bool is_gray : {false, true}) {
          const Colors colors = random_colors(random, bits, is_gray);
          EXPECT_EQ(read_bytes(bmp_file(indices, {bits, is_top_first, is_short, colors})),
                    colored(indices, colors, is_gray));
        }
      }
      const auto colors = random_values<std::uint8_t>(random, side(random), side(random), 3, 255);
      for (const int bits : {24, 32})
        EXPECT_EQ(read_bytes(bmp_file(colors, {bits, is_top_first, is_short})), colors);
    }
  });
}

}  // namespace
}  // namespace flexura
