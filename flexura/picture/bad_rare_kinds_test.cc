// What is wrong with a file of the rarer kinds: one line each.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "flexura/base/source.h"
#include "flexura/picture/image_file.h"
#include "tests/support/more_picture_files.h"
#include "tests/support/picture_files.h"

namespace flexura {
namespace {

using namespace std::string_literals;

// What is wrong with a file; nothing when it is read.
std::string problem_of(const std::string& file) {
  try {
    (void)read_picture(file_bytes(file), "file", 4096);
  } catch (const InputError& error) {
    return std::string(error.what()).substr(6);
  }
  return "";
}

std::string with(std::string file, std::size_t at, const std::string& bytes) {
  return file.replace(at, bytes.size(), bytes);
}

// Where a JPEG 2000 file's size marker has its numbers: width, height, left, top, then the tiles'.
std::size_t size_numbers(const std::string& file) { return file.find("\xFF\x51") + 6; }

const std::string is_huge = ": expected at most 4096 px", has_none = ": expected one pixel at least",
                  damage = " file is damaged, or of a sort that cannot be read: ";

TEST(BadRareKinds, OfFloatingPointAreNamed) {
  const std::string expected =
      " file has floating point values: expected a kind of file with whole ones of 1 to 16 bits";
  EXPECT_EQ(problem_of("\x76\x2F\x31\x01\x02\0\0\0"s), "the OpenEXR" + expected);
  EXPECT_EQ(problem_of("#?RADIANCE\n"), "the Radiance HDR" + expected);
  EXPECT_EQ(problem_of("#?RGBE\n"), "the Radiance HDR" + expected);
  EXPECT_EQ(problem_of("PF\n1 1\n-1\n"), "the PFM" + expected);
  EXPECT_EQ(problem_of("Pf 1 1\n-1\n"), "the PFM" + expected);
}

TEST(BadRareKinds, HugeOrWithoutPixelsAreCalledSo) {
  const std::string jp2 = jpeg2000_file(Image<std::uint8_t>(3, 3, 3), {});
  const std::size_t size = size_numbers(jp2);
  EXPECT_EQ(problem_of(with(jp2, size, "\x7F\xFF\xFF\xFF\x7F\xFF\xFF\xFF"s)),
            "2147483647 x 2147483647 px" + is_huge);
  EXPECT_EQ(problem_of(with(jp2, size, "\0\0\0\0"s)), "0 x 3 px" + has_none);
  EXPECT_EQ(problem_of(jpeg2000_file(Image<std::uint8_t>(65, 64), {})), "65 x 64 px" + is_huge);
  EXPECT_EQ(problem_of(webp_file(Image<std::uint8_t>(65, 64, 3), true)), "65 x 64 px" + is_huge);
  const std::string sun = sun_raster_file(Image<std::uint8_t>(3, 3), {});
  EXPECT_EQ(problem_of(with(sun, 4, "\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF")),
            "4294967295 x 4294967295 px" + is_huge);
  EXPECT_EQ(problem_of(with(sun, 8, "\0\0\0\0"s)), "3 x 0 px" + has_none);
  const std::string rest = "\nDEPTH 1\nMAXVAL 255\nENDHDR\n";
  EXPECT_EQ(problem_of("P7\nWIDTH 99999999999999999999\nHEIGHT 1" + rest), "2147483648 x 1 px" + is_huge);
  EXPECT_EQ(problem_of("P7\nWIDTH 65536\nHEIGHT 65536" + rest), "65536 x 65536 px" + is_huge);
  EXPECT_EQ(problem_of("P7\nWIDTH 0\nHEIGHT 1" + rest), "0 x 1 px" + has_none);
  const std::string palette(1024, '\0');
  EXPECT_EQ(problem_of(bmp_begin(65536, 65536, 8, 1, palette)), "65536 x 65536 px" + is_huge);
}

TEST(BadRareKinds, OfAFormThatIsNotReadAreCalledSo) {
  const Image<std::uint8_t> gray(3, 3), colors(4, 4, 3);
  EXPECT_EQ(
      problem_of(jpeg2000_file(gray, {.is_signed = true})),
      "the JPEG 2000 file has signed values of 8 bits: expected 1 to 16, as many in each channel, without "
      "a sign");
  EXPECT_EQ(problem_of(jpeg2000_file(gray, {.bits = 20})),
            "the JPEG 2000 file has values of 20 bits: expected 1 to 16, as many in each channel, without a "
            "sign");
  EXPECT_EQ(problem_of(jpeg2000_file(Image<std::uint8_t>(3, 3, 5), {})),
            "the JPEG 2000 file has 5 values a pixel: expected gray or colours, with alpha or without");
  const std::string jp2 = jpeg2000_file(Image<std::uint8_t>(3, 3, 4), {});
  const std::string inks = with(jp2, jp2.find("colr") + 7, "\0\0\0\x0C"s);
  EXPECT_EQ(problem_of(inks), "the JPEG 2000 file has colours of kind CMYK: expected gray, sRGB or sYCC");
  EXPECT_EQ(problem_of(jpeg2000_file(colors, {.space = OPJ_CLRSPC_SYCC, .step = 2})),
            "the JPEG 2000 file has channels of fewer pixels than the picture: expected a value a pixel in "
            "each");
  const std::string moving =
      "WEBPVP8X" + low_first(10, 4) + "\x02\0\0\0"s + low_first(2, 3) + low_first(2, 3);
  EXPECT_EQ(problem_of("RIFF" + low_first(22, 4) + moving),
            "the WebP file has moving pictures: expected a single one");
  const std::string sun = sun_raster_file(gray, {});
  EXPECT_EQ(problem_of(with(sun, 15, "\4")), "the Sun raster file has 4 bits a pixel: expected 1, 8, 24, 32");
  EXPECT_EQ(problem_of(with(sun, 23, "\4")), "the Sun raster file is of type 4: expected 0 to 3");
  EXPECT_EQ(
      problem_of(with(sun, 27, "\2")),
      "the Sun raster file has a palette of type 2 and 0 bytes: expected none, or one of red, green and "
      "blue for 1 or 8 bits a pixel");
  EXPECT_EQ(problem_of(pam_file(Image<std::uint8_t>(3, 3, 4), 255, "CMYK")),
            "the PAM file has 4 values a pixel (\"CMYK\"): expected gray or RGB, with alpha or without");
  EXPECT_EQ(problem_of(pam_file(Image<std::uint8_t>(3, 3, 5), 255, "")),
            "the PAM file has 5 values a pixel: expected gray or RGB, with alpha or without");
  EXPECT_EQ(problem_of(pam_file(gray, 65536, "")), "the PAM file says 65536 for white: expected 1 to 65535");
}

TEST(BadRareKinds, OfABmpThatIsNotReadAreCalledSo) {
  const std::string bmp = bmp_file(Image<std::uint8_t>(3, 3, 3), {});
  EXPECT_EQ(problem_of(with(bmp, 28, "\2")), "the BMP file has 2 bits a pixel: expected 1, 4, 8, 16, 24, 32");
  EXPECT_EQ(
      problem_of(with(bmp, 30, "\1")),
      "the BMP file has compression 1 of 24 bits a pixel: expected none, runs (RLE4, RLE8) or bit fields");
  EXPECT_EQ(problem_of(bmp_fields_file(Image<std::uint16_t>(3, 3, 3), 16, {0xF800, 0x7A0, 0x1F}, true)),
            "the BMP file has the bit field 0x7a0: expected bits in one run, within 16 bits");
  EXPECT_EQ(problem_of(bmp_fields_file(Image<std::uint16_t>(3, 3, 3), 16, {0x1F0000, 0x7E0, 0x1F}, true)),
            "the BMP file has the bit field 0x1f0000: expected bits in one run, within 16 bits");
  const std::string begin = bmp_begin(4, 3, 8, 1, std::string(1024, '\0'));
  EXPECT_EQ(problem_of(begin + "\5\1\0\1"s), "the BMP" + damage + "a run beyond its row");
  EXPECT_EQ(problem_of(begin + "\0\0\0\0\0\0\1\1\0\1"s), "the BMP" + damage + "a run beyond its row");
  EXPECT_EQ(problem_of(begin + "\0\2\0\xFF\0\1"s), "the BMP" + damage + "a jump out of the picture");
  EXPECT_EQ(problem_of(begin + "\1\1"), "the BMP file is cut short");
}

TEST(BadRareKinds, DamagedAreCalledSo) {
  const std::string pam = "P7\nWIDTH 1\nHEIGHT 1\n";
  EXPECT_EQ(problem_of(pam + "DEPTH 1\nENDHDR\n\xFF"), "the PAM" + damage + "no MAXVAL");
  EXPECT_EQ(problem_of(pam + "DEPTH one\nENDHDR\n"), "the PAM" + damage + "DEPTH without a number");
  EXPECT_EQ(problem_of(pam + "COLOUR 1\nENDHDR\n"), "the PAM" + damage + "a line of \"COLOUR\"");
  const std::string webp = webp_file(smooth_picture(21, 13, 3), true);
  EXPECT_EQ(problem_of(with(webp, 20, "x")), "the WebP" + damage + "values that no encoder writes");
  EXPECT_EQ(problem_of(with(webp, 4, "\xFF")), "the WebP file is cut short");
  const std::string stream = jpeg2000_file(smooth_picture(21, 13, 3), {.is_stream = true, .tile = 16});
  const std::string jpeg2000 = "the JPEG 2000" + damage;
  EXPECT_EQ(problem_of(with(stream, 2, "\xFF\x52")),
            "not a picture that can be read: expected PNG, JPEG, JPEG 2000, TIFF, WebP, PNM, PAM, BMP or Sun "
            "raster");
  const std::size_t numbers = size_numbers(stream);
  EXPECT_EQ(problem_of(with(stream, numbers + 16, "\0\0\0\0"s)), jpeg2000 + "tiles beside the picture");
  EXPECT_EQ(problem_of(with(stream, numbers + 16, "\0\0\0\1\0\0\0\1"s)), "the JPEG 2000 file is cut short");
  const std::size_t second = stream.find("\xFF\x90\0\x0A\0\1"s);
  ASSERT_NE(second, std::string::npos);
  EXPECT_EQ(problem_of(with(stream, second + 5, "\0"s)), jpeg2000 + "a tile is missing");
  EXPECT_EQ(problem_of(with(stream, second + 5, "\7")),
            jpeg2000 + "no tile's part at byte " + std::to_string(second) + " of the stream");
  // Precincts of few pixels, in a file that has no byte for each.
  std::string fine = jpeg2000_file(Image<std::uint8_t>(4, 4), {.is_stream = true, .precinct = 4});
  const std::string side = "\0\0\0\x40\0\0\0\x40"s;
  EXPECT_EQ(problem_of(fine), "");
  fine = with(with(fine, size_numbers(fine), side), size_numbers(fine) + 16, side);
  EXPECT_EQ(problem_of(fine), "the JPEG 2000 file is cut short");
  // What OpenJPEG says of it.
  const std::size_t style = stream.find("\xFF\x52");
  EXPECT_THAT(problem_of(with(stream, style + 9, "\xFF")), testing::StartsWith(jpeg2000));
}

}  // namespace
}  // namespace flexura
