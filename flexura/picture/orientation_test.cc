#include "flexura/picture/orientation.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "flexura/picture/image_file.h"
#include "tests/support/oriented_files.h"
#include "tests/support/picture_files.h"

namespace flexura {
namespace {

// The letter F of 3 x 5 pixels as each orientation stores it, by the figure of the EXIF standard.
using Rows = std::vector<std::string>;
const Rows upright_letter = {"###", "#..", "##.", "#..", "#.."};
const std::array<Rows, 8> stored_letters = {upright_letter,
                                            Rows{"###", "..#", ".##", "..#", "..#"},
                                            Rows{"..#", "..#", ".##", "..#", "###"},
                                            Rows{"#..", "#..", "##.", "#..", "###"},
                                            Rows{"#####", "#.#..", "#...."},
                                            Rows{"#....", "#.#..", "#####"},
                                            Rows{"....#", "..#.#", "#####"},
                                            Rows{"#####", "..#.#", "....#"}};

// Each pixel becomes a block of 8 x 8, which JPEG keeps.
Image<std::uint8_t> letter(const Rows& rows) {
  constexpr int block = 8;
  Image<std::uint8_t> picture(block * static_cast<int>(rows[0].size()),
                              block * static_cast<int>(rows.size()));
  for (int v = 0; v < picture.height(); ++v)
    for (int u = 0; u < picture.width(); ++u)
      picture.at(u, v) =
          rows[static_cast<std::size_t>(v / block)][static_cast<std::size_t>(u / block)] == '#' ? 16 : 240;
  return picture;
}

Rows rows_of(const Image<std::uint8_t>& picture) {
  Rows rows;
  for (int v = 4; v < picture.height(); v += 8) {
    std::string& row = rows.emplace_back();
    for (int u = 4; u < picture.width(); u += 8) row += picture.at(u, v) < 128 ? '#' : '.';
  }
  return rows;
}

Image<std::uint8_t> read_letter(const std::string& file) {
  return std::get<Image<std::uint8_t>>(read_picture(file_bytes(file), "letter", 1U << 16U));
}

TEST(Orientation, EveryFileIsReadUpright) {
  for (int orientation = 1; orientation <= 8; ++orientation) {
    const Image<std::uint8_t> stored = letter(stored_letters[static_cast<std::size_t>(orientation - 1)]);
    for (const bool is_little : {false, true}) {
      EXPECT_EQ(rows_of(read_letter(oriented_jpeg(stored, orientation, is_little))), upright_letter)
          << orientation;
      EXPECT_EQ(rows_of(read_letter(oriented_png(stored, orientation, is_little))), upright_letter)
          << orientation;
    }
  }
}

TEST(Orientation, WordsAndColorsAreTurned) {
  Image<std::uint16_t> words(2, 1, 3);
  for (int i = 0; i < 6; ++i)
    words.values()[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(1000 * i);
  const auto turned_words = std::get<Image<std::uint16_t>>(upright(words, 6));
  ASSERT_EQ(turned_words.width(), 1);
  ASSERT_EQ(turned_words.height(), 2);
  EXPECT_EQ(turned_words.at(0, 1, 2), 5000);
  const auto half_turn = std::get<Image<std::uint16_t>>(upright(words, 3));
  EXPECT_EQ(half_turn.at(0, 0, 1), 4000);
}

// Damaged data state no orientation, wherever they end and whatever byte is wrong.
TEST(Orientation, DamagedTagsAreIgnored) {
  const Image<std::uint8_t> stored = letter(upright_letter);
  for (const std::string& file : {oriented_jpeg(stored, 6, true), oriented_png(stored, 6, false)}) {
    EXPECT_EQ(orientation_in(file_bytes(file)), 6);
    for (std::size_t size = 0; size < file.size(); ++size) {
      const int part = orientation_in(file_bytes(file.substr(0, size)));
      EXPECT_TRUE(part == 1 || part == 6);
    }
    for (std::size_t i = 0; i < file.size(); ++i) {
      std::string wrong = file;
      wrong[i] = static_cast<char>(~wrong[i]);
      const int orientation = orientation_in(file_bytes(wrong));
      EXPECT_TRUE(orientation >= 1 && orientation <= 8);
    }
  }
  EXPECT_EQ(orientation_in(file_bytes(oriented_jpeg(stored, 9, true))), 1);
  EXPECT_EQ(orientation_in(file_bytes(oriented_jpeg(stored, 0, true))), 1);
  EXPECT_EQ(orientation_in(file_bytes(jpeg(stored))), 1);
  EXPECT_EQ(orientation_in({}), 1);
}

}  // namespace
}  // namespace flexura
