#include "flexura/board/board_drawing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "flexura/base/names.h"
#include "tests/support/boards.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

const std::vector<BoardTarget> drawn_boards = {
    {.columns = 6, .rows = 5, .square = 0.03},
    {.pattern = BoardPattern::circles, .columns = 6, .rows = 4, .square = 0.02},
    {.pattern = BoardPattern::asymmetric_circles, .columns = 4, .rows = 7, .square = 0.02},
    {.pattern = BoardPattern::charuco, .columns = 5, .rows = 4, .square = 0.03, .marker = 0.02},
    {.pattern = BoardPattern::charuco,
     .columns = 5,
     .rows = 3,
     .square = 0.03,
     .marker = 0.022,
     .family = FiducialFamily::aruco_5x5},
    {.pattern = BoardPattern::apriltags,
     .columns = 4,
     .rows = 3,
     .square = 0.05,
     .marker = 0.04,
     .family = FiducialFamily::apriltag_36h11}};

bool is_drawn(const BoardDrawing& drawing, const Eigen::Vector2d& at) {
  return std::ranges::any_of(drawing.rectangles,
                             [&](const DrawnRectangle& one) {
                               return (at.array() >= one.low.array()).all() &&
                                      (at.array() < one.high.array()).all();
                             }) ||
         std::ranges::any_of(drawing.circles,
                             [&](const DrawnCircle& one) { return (at - one.center).norm() < one.radius; });
}

TEST(BoardDrawing, IsDarkWhereTheBoardIs) {
  TestRandom random(7);
  for (const BoardTarget& board : drawn_boards) {
    const BoardDrawing drawing = draw_board(board);
    for (int sample = 0; sample < 3000; ++sample) {
      const double margin = board.square;
      const Eigen::Vector2d at(random.uniform(drawing.low.x() - margin, drawing.high.x() + margin),
                               random.uniform(drawing.low.y() - margin, drawing.high.y() + margin));
      ASSERT_EQ(is_drawn(drawing, at), is_dark(board, at / board.square))
          << name_of(board.pattern) << " at " << at.transpose();
    }
  }
}

// A reader of PDF finds each object by its position in the table.
TEST(BoardDrawing, PdfTellsWhereItsObjectsAre) {
  for (const BoardTarget& board : drawn_boards) {
    const std::string pdf =
        pdf_of(draw_board(board), {.width = 0.297, .height = 0.21, .caption = "a (b) \\"});
    const std::size_t named = pdf.rfind("startxref\n") + 10;
    std::size_t table = 0;
    std::from_chars(pdf.data() + named, pdf.data() + pdf.size(), table);
    ASSERT_EQ(pdf.substr(table, 9), "xref\n0 6\n");
    for (int object = 1; object <= 5; ++object) {
      const std::size_t entry = table + 9 + 20 * static_cast<std::size_t>(object);
      std::size_t offset = 0;
      std::from_chars(pdf.data() + entry, pdf.data() + entry + 10, offset);
      const std::string head = std::to_string(object) + " 0 obj\n";
      EXPECT_EQ(pdf.substr(offset, head.size()), head);
    }
    const std::size_t stream = pdf.find("stream\n") + 7, length = pdf.find("/Length ") + 8;
    std::size_t size = 0;
    std::from_chars(pdf.data() + length, pdf.data() + pdf.size(), size);
    EXPECT_EQ(pdf.substr(stream + size, 9), "endstream");
    EXPECT_THAT(pdf, HasSubstr("(a \\(b\\) \\\\)"));
    EXPECT_THAT(pdf, HasSubstr("/MediaBox [0 0 841.88976 595.27559]"));
  }
}

TEST(BoardDrawing, SvgHasAllAreasInMillimetres) {
  for (const BoardTarget& board : drawn_boards) {
    const BoardDrawing drawing = draw_board(board);
    const std::string svg = svg_of(drawing, {.width = 0.297, .height = 0.21, .caption = "1 < 2"});
    EXPECT_THAT(svg,
                HasSubstr("width=\"297.0000mm\" height=\"210.0000mm\" viewBox=\"0 0 297.0000 210.0000\""));
    EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(svg, 'M')),
              drawing.rectangles.size() + drawing.circles.size());
    EXPECT_THAT(svg, HasSubstr("1 &lt; 2"));
  }
}

TEST(BoardDrawing, RefusesWhatCannotBeDrawn) {
  BoardTarget board = drawn_boards.back();
  board.marker = board.square;
  EXPECT_THROW((void)draw_board(board), std::invalid_argument);
  board.marker = 0.01, board.columns = 50, board.rows = 50;
  EXPECT_THROW((void)draw_board(board), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
