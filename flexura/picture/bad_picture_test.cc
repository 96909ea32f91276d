// Invalid or damaged pictures: one line each, nothing on stderr, and no memory for sizes that are only
// claimed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "flexura/base/source.h"
#include "flexura/picture/image_file.h"
#include "tests/support/picture_files.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr std::size_t most = 4096;

// Returns the error message of a file; "" if it is read.
std::string complaint(const std::string& file) {
  try {
    (void)read_picture(file_bytes(file), "file", most);
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 1U);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    EXPECT_THAT(error.what(), StartsWith("file: "));
    return std::string(error.what()).substr(6);
  }
  return "";
}

// One valid file of each kind, and of each form with separate code.
std::vector<std::string> good_files() {
  TestRandom random(1);
  const auto gray = random_values<std::uint8_t>(random, 21, 13, 1, 255),
             colors = random_values<std::uint8_t>(random, 21, 13, 3, 255),
             bits = random_values<std::uint8_t>(random, 21, 13, 1, 1);
  const auto words = random_values<std::uint16_t>(random, 21, 13, 3, 65535);
  std::vector<std::string> files = {png(gray),
                                    png(words),
                                    png_file(colors, {8, true}),
                                    png_file(bits, {1, true, {{1, 2, 3}, {4, 5, 6}}}),
                                    jpeg(gray),
                                    jpeg(colors),
                                    jpeg_file(colors, true),
                                    pbm_file(bits, true),
                                    pbm_file(bits, false)};
  for (const bool is_plain : {false, true})
    files.insert(files.end(), {pnm_file(gray, 255, is_plain), pnm_file(words, 65535, is_plain)});
  for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_PACKBITS, COMPRESSION_JPEG,
                                COMPRESSION_ADOBE_DEFLATE, COMPRESSION_ZSTD, COMPRESSION_LZMA})
    files.insert(
        files.end(),
        {tiff_file(gray, {.compression = compression, .rows = 16}),
         tiff_file(
             colors,
             {.compression = compression, .photometric = PHOTOMETRIC_RGB, .tile = 16, .is_separate = true})});
  files.push_back(tiff_file(words, {.bits = 16, .photometric = PHOTOMETRIC_RGB}));
  files.push_back(tiff_file(bits, {.bits = 1, .compression = COMPRESSION_CCITTFAX4}));
  files.push_back(tiff_file(random_values<std::uint16_t>(random, 21, 13, 3, 4095),
                            {.bits = 12, .photometric = PHOTOMETRIC_RGB}));
  const auto inks = random_values<std::uint8_t>(random, 21, 13, 4, 255);
  files.insert(files.end(), {jpeg_file(inks, false), jpeg_file(inks, true, true)});
  return files;
}

TEST(BadPicture, OfNoKindIsCalledSo) {
  EXPECT_EQ(complaint(""), "the file is empty");
  const std::string none = "not a picture that can be read: expected PNG, JPEG, TIFF or PNM";
  for (const char* text : {"P", "P5", "P7 332", "Pnm", "PFM", "GIF89a", "RIFF", "RIFF....WAVEfmt ", "II*",
                           "\xFF\xD8", "\xFF\x4F\xFF", "\x59\xA6", "hello"})
    EXPECT_EQ(complaint(text), none) << text;
}

TEST(BadPicture, OfAKindThatIsNotReadIsNamed) {
  using namespace std::string_literals;
  const std::vector<std::array<std::string, 2>> cases = {{"\0\0\0\x0CjP  \r\n"s, "JPEG 2000"},
                                                         {"\xFF\x4F\xFF\x51\0"s, "JPEG 2000"},
                                                         {"RIFF\x14\0\0\0WEBPVP8L"s, "WebP"},
                                                         {"P7\nWIDTH 1\n", "PAM"},
                                                         {"BM\x46\0\0\0"s, "BMP"},
                                                         {"\x59\xA6\x6A\x95\0"s, "Sun raster"},
                                                         {"PF\n1 1\n-1\n", "PFM"},
                                                         {"Pf\n1 1\n-1\n", "PFM"},
                                                         {"\x76\x2F\x31\x01\x02\0"s, "OpenEXR"},
                                                         {"#?RADIANCE\n", "Radiance HDR"},
                                                         {"#?RGBE\n", "Radiance HDR"}};
  for (const auto& [file, name] : cases)
    EXPECT_EQ(complaint(file), name + " files are not read: expected PNG, JPEG, TIFF or PNM");
}

// Number of bytes that identify a file's kind.
std::size_t least_name(char first) { return first == 'P' ? 3 : 4; }

TEST(BadPicture, CutShortIsCalledSo) {
  for (const std::string& file : good_files()) {
    ASSERT_EQ(complaint(file), "");
    for (std::size_t size = 0; size < file.size(); size += one_case_of) {
      const std::string line = complaint(file.substr(0, size));
      // A plain number may be cut; a TIFF file may be identified by another sign.
      const bool is_plain = file[0] == 'P' && file[1] <= '3', is_tiff = file[0] == 'I',
                 is_named = size >= least_name(file[0]);
      if (is_plain || is_tiff || !is_named) continue;
      EXPECT_THAT(line, HasSubstr("file is truncated"))
          << size << " of " << file.size() << " " << file.substr(0, 2);
    }
  }
  const std::string tiff = tiff_file(Image<std::uint8_t>(21, 13), {});
  for (const std::size_t size : {4U, 6U, 7U, 8U, 50U, 281U})
    EXPECT_EQ(complaint(tiff.substr(0, size)), "the TIFF file is truncated");
  EXPECT_EQ(complaint("P2 2 1 9 1 "), "the PNM file is truncated");
}

TEST(BadPicture, HugeOrWithoutPixelsIsCalledSo) {
  const std::string line = ": expected at most 4096 px", none = ": expected at least one pixel";
  const std::string png_claim = png(Image<std::uint8_t>(3, 3));
  const auto claim = [](std::string file, std::size_t at, const std::string& size) {
    return file.replace(at, size.size(), size);
  };
  using namespace std::string_literals;
  EXPECT_EQ(complaint(claim(png_claim, 16, "\x7F\xFF\xFF\xFF\x7F\xFF\xFF\xFF"s)),
            "2147483647 x 2147483647 px" + line);
  EXPECT_EQ(complaint(claim(png_claim, 16, "\0\0\0\0"s)), "0 x 3 px" + none);
  const std::string jpeg_claim = jpeg(Image<std::uint8_t>(3, 3));
  const std::size_t frame = jpeg_claim.find("\xFF\xC0") + 5;
  EXPECT_EQ(complaint(claim(jpeg_claim, frame, "\xF0\x00\xF0\x00"s)), "61440 x 61440 px" + line);
  EXPECT_EQ(complaint(claim(jpeg_claim, frame, "\x00\x00\x00\x03"s)), "3 x 0 px" + none);
  EXPECT_EQ(complaint("P5 100000 100000 255\n"), "100000 x 100000 px" + line);
  EXPECT_EQ(complaint("P5 0 1 255\n"), "0 x 1 px" + none);
  EXPECT_EQ(complaint("P6 99999999999999999999 1 255\n"), "2147483648 x 1 px" + line);
  const std::string tiff_claim = tiff_file(Image<std::uint8_t>(3, 3), {});
  const std::string width = "\x00\x01\x03\x00\x01\x00\x00\x00\x03\x00"s;
  const std::size_t tag = tiff_claim.find(width);
  ASSERT_NE(tag, std::string::npos);
  EXPECT_EQ(complaint(claim(tiff_claim, tag + 8, "\xFF\xFF"s)), "65535 x 3 px" + line);
  EXPECT_EQ(complaint(tiff_file(Image<std::uint8_t>(65, 64), {})), "65 x 64 px" + line);
  EXPECT_EQ(complaint(png(Image<std::uint8_t>(65, 64))), "65 x 64 px" + line);
}

TEST(BadPicture, OfAFormThatIsNotReadIsCalledSo) {
  EXPECT_EQ(complaint(jpeg_file(smooth_picture(8, 8, 2), false)),
            "the JPEG file has 2 values per pixel: expected gray, colours or four inks (CMYK)");
  EXPECT_EQ(complaint(tiff(Image<float>(3, 3))),
            "the TIFF file has floating point values of 32 bits: expected unsigned integers of 1, 2, 4, 8, "
            "10, 12, 14 or 16 bits");
  EXPECT_EQ(
      complaint(tiff_file(Image<std::uint8_t>(3, 3, 3), {.photometric = PHOTOMETRIC_ICCLAB})),
      "the TIFF file has colours of kind 9: expected gray, RGB, a palette, or CMYK, YCbCr or CIELab of 8 "
      "bits");
  EXPECT_EQ(complaint(tiff_file(Image<std::uint8_t>(9, 9),
                                {.bits = 1, .compression = COMPRESSION_JBIG, .rows = 9})),
            "the TIFF file has compression 34661: expected a common compression");
  EXPECT_EQ(complaint("P5 1 1 65536\n"), "the PNM file has 65536 for white: expected 1 to 65535");
}

TEST(BadPicture, DamagedIsCalledSoWithWhatTheLibrarySays) {
  const std::string is_damaged = "file is damaged, or of a kind that is not supported: ";
  std::string file = png(smooth_picture(21, 13, 1));
  file[file.size() - 13] ^= 1;  // Of the checksum before the last chunk.
  EXPECT_EQ(complaint(file), "the PNG " + is_damaged + "IDAT: CRC error");
  EXPECT_THAT(complaint("\x89PNG\n\x1A\n but no more"), HasSubstr("the PNG " + is_damaged));
  EXPECT_THAT(complaint("\xFF\xD8\xFF\xD8 twice"), HasSubstr("the JPEG " + is_damaged));
  EXPECT_EQ(complaint("P2 2 1 9 1 x"), "the PNM " + is_damaged + "no number at byte 11");
  EXPECT_EQ(complaint("P2 2 1 255 1 999"),
            "the PNM " + is_damaged + "a value of 999, which is above the value 255 of white");
  EXPECT_EQ(complaint("P5 2 1 9\n\t\n"),
            "the PNM " + is_damaged + "a value of 10, which is above the value 9 of white");
  EXPECT_EQ(complaint("P1 2 1 1 3"), "the PNM " + is_damaged + "bits that are neither 0 nor 1");
  std::string tiff = tiff_file(smooth_picture(21, 13, 1), {.compression = COMPRESSION_ADOBE_DEFLATE});
  tiff[8] = 'y';
  EXPECT_THAT(complaint(tiff), HasSubstr("the TIFF " + is_damaged));
}

TEST(BadPicture, IsReadOrRefusedInSilenceWhateverItsBytes) {
  const std::vector<std::string> files = good_files();
  testing::internal::CaptureStderr();
  for_random_cases(4000, [&](TestRandom& random) {
    std::string file = files[static_cast<std::size_t>(random.integer(0, static_cast<int>(files.size()) - 1))];
    for (int changes = random.integer(1, 4); changes > 0; --changes)
      file[static_cast<std::size_t>(random.integer(0, static_cast<int>(file.size()) - 1))] =
          static_cast<char>(random.integer(0, 255));
    (void)complaint(file);
  });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(BadPicture, OfOneThreadIsNothingToOthers) {
  const std::vector<std::string> files = good_files();
  std::vector<Picture> pictures;
  pictures.reserve(files.size());
  for (const std::string& file : files) pictures.push_back(read_picture(file_bytes(file), "file", most));
  std::array<int, 8> wrong{};
  std::vector<std::thread> threads;
  threads.reserve(wrong.size());
  for (int& mine : wrong)
    threads.emplace_back([&] {
      for (int turn = 0; turn < 20; ++turn)
        for (std::size_t i = 0; i < files.size(); ++i) {
          if (read_picture(file_bytes(files[i]), "file", most) != pictures[i]) ++mine;
          try {
            (void)read_picture(file_bytes(files[i]).first(files[i].size() / 2), "file", most);
          } catch (const InputError&) {
            continue;
          }
          ++mine;
        }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(wrong, testing::Each(0));
}

}  // namespace
}  // namespace flexura
