#include <utility>

#include "flexura/picture/bmp_header.h"
#include "flexura/picture/picture_kinds.h"

namespace flexura {
namespace {

// Where the next pixel goes: rows come in the file's order.
class BmpPen {
 public:
  explicit BmpPen(const BmpHeader& header)
      : image_(static_cast<int>(header.width), static_cast<int>(header.height)),
        is_top_first_(header.is_top_first) {}

  void put(std::uint8_t index) {
    if (row_ >= image_.height() || column_ >= image_.width()) throw damaged("BMP", "a run beyond its row");
    image_.at(column_++, is_top_first_ ? row_ : image_.height() - 1 - row_) = index;
  }
  void end_row() { column_ = 0, ++row_; }
  // What is jumped over stays 0.
  void jump(int columns, int rows) {
    column_ += columns, row_ += rows;
    if (row_ > image_.height() || column_ > image_.width()) throw damaged("BMP", "a jump out of the picture");
  }
  [[nodiscard]] bool is_done() const {
    return row_ >= image_.height() || (row_ == image_.height() - 1 && column_ == image_.width());
  }
  [[nodiscard]] Image<std::uint8_t>& image() { return image_; }

 private:
  Image<std::uint8_t> image_;
  bool is_top_first_;
  int column_ = 0, row_ = 0;
};

class RunReader {
 public:
  RunReader(std::span<const std::uint8_t> runs, const BmpHeader& header)
      : runs_(runs), is_of_4_(header.bits == 4), pen_(header) {}

  // Two bytes at a time: a count and what it is of, or 0 and a sign.
  Image<std::uint8_t> read() {
    constexpr std::uint8_t end_of_row = 0, end = 1, jump = 2;
    // Some writers leave the end's sign out.
    while (!(runs_.empty() && pen_.is_done())) {
      const auto count = next(), value = next();
      if (count > 0)
        put_run(count, value);
      else if (value == end_of_row)
        pen_.end_row();
      else if (value == end)
        break;
      else if (value == jump)
        put_jump();
      else
        put_each(value);
    }
    return std::move(pen_.image());
  }

 private:
  std::uint8_t next() {
    if (runs_.empty()) throw cut_short("BMP");
    const std::uint8_t value = runs_.front();
    runs_ = runs_.subspan(1);
    return value;
  }
  // The first of a byte's two pixels is the higher one.
  [[nodiscard]] std::uint8_t part(std::uint8_t value, int index) const {
    if (!is_of_4_) return value;
    return static_cast<std::uint8_t>(index % 2 == 0 ? value >> 4U : value & 0xFU);
  }
  void put_run(int count, std::uint8_t value) {
    for (int i = 0; i < count; ++i) pen_.put(part(value, i));
  }
  void put_jump() {
    const int columns = next(), rows = next();
    pen_.jump(columns, rows);
  }
  // Pixels as they are, filled up to two bytes.
  void put_each(int count) {
    std::uint8_t value = 0;
    for (int i = 0; i < count; ++i) {
      if (!is_of_4_ || i % 2 == 0) value = next();
      pen_.put(part(value, i));
    }
    const int bytes = is_of_4_ ? (count + 1) / 2 : count;
    if (bytes % 2 == 1) next();
  }

  std::span<const std::uint8_t> runs_;
  bool is_of_4_;
  BmpPen pen_;
};

}  // namespace

Image<std::uint8_t> read_bmp_runs(std::span<const std::uint8_t> runs, const BmpHeader& header) {
  return RunReader(runs, header).read();
}

}  // namespace flexura
