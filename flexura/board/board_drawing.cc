#include "flexura/board/board_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "flexura/base/names.h"
#include "flexura/board/fiducial.h"
#include "flexura/board/fiducial_board.h"

namespace flexura {
namespace {

using Eigen::Vector2d;

constexpr double caption_size = 0.0035;  // Height of the letters, m.
constexpr double caption_place = 0.005;  // Distance of the text from the lower edge of the sheet, m.

void add_squares(const BoardTarget& board, BoardDrawing& drawing) {
  for (int row = 0; row <= board.rows; ++row)
    for (int column = row % 2; column <= board.columns; column += 2)
      drawing.rectangles.push_back(
          {board.square * Vector2d(column - 1, row - 1), board.square * Vector2d(column, row)});
}

// The black cells of a row that touch are one rectangle.
void add_marker(FiducialFamily family, int id, const Vector2d& corner, double side, BoardDrawing& drawing) {
  const int cells = side_of(family) + 2;
  const double cell = side / cells;
  for (int row = 0; row < cells; ++row) {
    for (int column = 0; column < cells;) {
      int end = column;
      while (end < cells && is_black_cell(family, id, row, end)) ++end;
      if (end > column)
        drawing.rectangles.push_back(
            {corner + cell * Vector2d(column, row), corner + cell * Vector2d(end, row + 1)});
      column = end + 1;
    }
  }
}

void add_circles(const BoardTarget& board, BoardDrawing& drawing) {
  const double radius = (board.pattern == BoardPattern::circles ? 0.3 : 0.42) * board.square;
  for (const Vector2d& point : board.points()) drawing.circles.push_back({point, radius});
}

std::string with_entities(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else {
      result += c;
    }
  }
  return result;
}

}  // namespace

BoardDrawing draw_board(const BoardTarget& board) {
  BoardDrawing drawing;
  if (board.has_markers()) {
    if (!(board.marker > 0) || !(board.marker < board.square))
      throw std::invalid_argument("the markers of a board must be smaller than its squares");
    if (board.markers() > count_of(board.family))
      throw std::invalid_argument(fmt::format("a board of {} markers, but the family {} has only {}",
                                              board.markers(), name_of(board.family),
                                              count_of(board.family)));
  }
  if (board.pattern == BoardPattern::chessboard || board.pattern == BoardPattern::charuco)
    add_squares(board, drawing);
  if (board.pattern == BoardPattern::circles || board.pattern == BoardPattern::asymmetric_circles)
    add_circles(board, drawing);
  if (board.has_markers()) {
    const FiducialPlaces places = fiducial_layouts(board).front();
    for (std::size_t id = 0; id < places.size(); ++id)
      add_marker(board.family, static_cast<int>(id), places[id][0], board.marker, drawing);
  }
  drawing.low = Vector2d::Constant(1e9), drawing.high = -drawing.low;
  const auto include = [&](const Vector2d& low, const Vector2d& high) {
    drawing.low = drawing.low.cwiseMin(low), drawing.high = drawing.high.cwiseMax(high);
  };
  for (const DrawnRectangle& one : drawing.rectangles) include(one.low, one.high);
  for (const DrawnCircle& one : drawing.circles)
    include(one.center - Vector2d::Constant(one.radius), one.center + Vector2d::Constant(one.radius));
  return drawing;
}

// All areas are one path: separate neighbours would have a light seam on a screen.
std::string svg_of(const BoardDrawing& drawing, const BoardSheet& sheet) {
  constexpr double mm = 1000;
  const Vector2d shift = 0.5 * (Vector2d(sheet.width, sheet.height) - drawing.low - drawing.high);
  std::string path;
  for (const DrawnRectangle& one : drawing.rectangles) {
    const Vector2d low = mm * (one.low + shift), size = mm * (one.high - one.low);
    path += fmt::format("M{:.4f} {:.4f}h{:.4f}v{:.4f}h{:.4f}z\n", low.x(), low.y(), size.x(), size.y(),
                        -size.x());
  }
  for (const DrawnCircle& one : drawing.circles) {
    const Vector2d left = mm * (one.center + shift - Vector2d(one.radius, 0));
    const double radius = mm * one.radius;
    path += fmt::format("M{:.4f} {:.4f}a{:.4f} {:.4f} 0 1 1 {:.4f} 0a{:.4f} {:.4f} 0 1 1 {:.4f} 0z\n",
                        left.x(), left.y(), radius, radius, 2 * radius, radius, radius, -2 * radius);
  }
  const double width = mm * sheet.width, height = mm * sheet.height;
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.4f}mm\" height=\"{1:.4f}mm\" "
      "viewBox=\"0 0 {0:.4f} {1:.4f}\">\n<rect width=\"{0:.4f}\" height=\"{1:.4f}\" fill=\"white\"/>\n"
      "<path fill=\"black\" d=\"{2}\"/>\n<text x=\"{3:.4f}\" y=\"{4:.4f}\" font-family=\"sans-serif\" "
      "font-size=\"{5:.4f}\" fill=\"gray\">{6}</text>\n</svg>\n",
      width, height, path, mm * caption_place, height - mm * caption_place, mm * caption_size,
      with_entities(sheet.caption));
}

std::string pdf_of(const BoardDrawing& drawing, const BoardSheet& sheet) {
  constexpr double point = 72 / 0.0254;  // PDF's unit, per metre. y points up.
  const Vector2d shift = 0.5 * (Vector2d(sheet.width, sheet.height) - drawing.low - drawing.high);
  const auto place = [&](const Vector2d& at) {
    return Vector2d(point * (at.x() + shift.x()), point * (sheet.height - at.y() - shift.y()));
  };
  std::string page = "0 g\n";
  for (const DrawnRectangle& one : drawing.rectangles) {
    const Vector2d corner = place({one.low.x(), one.high.y()}), size = point * (one.high - one.low);
    page += fmt::format("{:.5f} {:.5f} {:.5f} {:.5f} re\n", corner.x(), corner.y(), size.x(), size.y());
  }
  for (const DrawnCircle& one : drawing.circles) {
    // Four cubic curves, which deviate from the circle by less than 3e-4 of its radius.
    constexpr double handle = 0.5522847498;
    const Vector2d c = place(one.center);
    const double r = point * one.radius, h = handle * r;
    page += fmt::format("{:.5f} {:.5f} m\n", c.x() + r, c.y());
    const auto curve = [&](double x1, double y1, double x2, double y2, double x3, double y3) {
      page += fmt::format("{:.5f} {:.5f} {:.5f} {:.5f} {:.5f} {:.5f} c\n", c.x() + x1, c.y() + y1, c.x() + x2,
                          c.y() + y2, c.x() + x3, c.y() + y3);
    };
    curve(r, h, h, r, 0, r), curve(-h, r, -r, h, -r, 0), curve(-r, -h, -h, -r, 0, -r),
        curve(h, -r, r, -h, r, 0);
  }
  page += "f\n";
  std::string caption;
  for (const char c : sheet.caption) {
    if (c == '(' || c == ')' || c == '\\') caption += '\\';
    caption += c;
  }
  page += fmt::format("0.5 g BT /F1 {:.5f} Tf {:.5f} {:.5f} Td ({}) Tj ET\n", point * caption_size,
                      point * caption_place, point * caption_place, caption);
  std::string text = "%PDF-1.4\n";
  std::vector<std::size_t> offsets;
  const auto object = [&](const std::string& body) {
    offsets.push_back(text.size());
    text += fmt::format("{} 0 obj\n{}\nendobj\n", offsets.size(), body);
  };
  object("<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>");
  object("<< /Type /Pages /Kids [3 0 R] /Count 1 >>");
  object(
      fmt::format("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {:.5f} {:.5f}] /Contents 4 0 R "
                  "/Resources << /Font << /F1 5 0 R >> >> >>",
                  point * sheet.width, point * sheet.height));
  object(fmt::format("<< /Length {} >>\nstream\n{}endstream", page.size(), page));
  object("<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>");
  const std::size_t table = text.size();
  text += fmt::format("xref\n0 {}\n0000000000 65535 f \n", offsets.size() + 1);
  for (const std::size_t offset : offsets) text += fmt::format("{:010} 00000 n \n", offset);
  text +=
      fmt::format("trailer\n<< /Size {} /Root 1 0 R >>\nstartxref\n{}\n%%EOF\n", offsets.size() + 1, table);
  return text;
}

}  // namespace flexura
