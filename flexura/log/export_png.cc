#include "flexura/log/export_png.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace flexura {
namespace {

constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";
constexpr std::size_t header_size = 13;  // Of the chunk IHDR.

std::string big_endian(std::uint32_t value, int bytes) {
  std::string text;
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8)
    text += static_cast<char>(static_cast<unsigned char>(value >> shift));
  return text;
}

std::uint32_t number_at(std::string_view bytes) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i)
    value = value << 8 | static_cast<unsigned char>(bytes[static_cast<std::size_t>(i)]);
  return value;
}

// A chunk of a PNG file: its length, type, data and checksum.
std::string chunk(const std::string& type, const std::string& data) {
  const std::string checked = type + data;
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
  return big_endian(static_cast<std::uint32_t>(data.size()), 4) + checked +
         big_endian(static_cast<std::uint32_t>(sum), 4);
}

// The parts of a PNG file that its animation needs.
struct PngParts {
  std::string header;  // Data of IHDR.
  std::string pixels;  // Data of all IDAT, compressed.
};

PngParts parts_of(std::string_view png) {
  PngParts picture;
  if (!png.starts_with(signature)) throw std::runtime_error("an image of the log is not a PNG picture");
  png.remove_prefix(signature.size());
  while (png.size() >= 12) {
    const std::size_t length = number_at(png);
    if (length > png.size() - 12) break;
    const std::string_view type = png.substr(4, 4), data = png.substr(8, length);
    if (type == "IHDR") picture.header = data;
    if (type == "IDAT") picture.pixels += data;
    png.remove_prefix(12 + length);
  }
  if (picture.header.size() != header_size || picture.pixels.empty())
    throw std::runtime_error("an image of the log is a damaged PNG picture");
  return picture;
}

class AnimatedPngWriter : public FilmWriter {
 public:
  AnimatedPngWriter(const std::filesystem::path& file, double frame_rate)
      : name_(file.string()), file_(file, std::ios::binary), frame_rate_(frame_rate) {}

  void put(const std::string& png, std::int64_t times) override {
    const PngParts picture = parts_of(png);
    if (pictures_ == 0) {
      header_ = picture.header;
      file_ << signature << chunk("IHDR", header_);
      control_at_ = file_.tellp();
      write_control();
    } else if (picture.header != header_) {
      throw std::runtime_error("the images of a camera differ in size or kind");
    }
    const std::int64_t begin = milliseconds(frames_);
    frames_ += times;
    // A delay has 16 bits.
    constexpr std::int64_t longest = 65535;
    for (std::int64_t left = milliseconds(frames_) - begin; left > 0; left -= longest)
      write_frame(picture, std::min(left, longest));
    if (!file_) throw std::runtime_error(fmt::format("cannot write {}", name_));
  }
  void finish() override {
    file_ << chunk("IEND", "");
    file_.seekp(control_at_);
    write_control();
    if (!file_.flush()) throw std::runtime_error(fmt::format("cannot write {}", name_));
  }

 private:
  // When this frame is due, in ms: rounding does not add up.
  [[nodiscard]] std::int64_t milliseconds(std::int64_t frames) const {
    return std::llround(1000 * static_cast<double>(frames) / frame_rate_);
  }
  // How many pictures there are, and that they repeat for ever. Written again when their number is known.
  void write_control() { file_ << chunk("acTL", big_endian(pictures_, 4) + big_endian(0, 4)); }

  void write_frame(const PngParts& picture, std::int64_t delay) {
    const std::string size = header_.substr(0, 8), offset = big_endian(0, 4) + big_endian(0, 4);
    const std::string time = big_endian(static_cast<std::uint32_t>(delay), 2) + big_endian(1000, 2);
    const std::string replaces_all(2, '\0');
    file_ << chunk("fcTL", big_endian(sequence_++, 4) + size + offset + time + replaces_all);
    file_ << (pictures_ == 0 ? chunk("IDAT", picture.pixels)
                             : chunk("fdAT", big_endian(sequence_++, 4) + picture.pixels));
    ++pictures_;
  }

  std::string name_;
  std::ofstream file_;
  double frame_rate_;
  std::string header_;  // IHDR's data of all pictures.
  std::streampos control_at_;
  std::int64_t frames_ = 0;
  std::uint32_t pictures_ = 0, sequence_ = 0;
};

}  // namespace

ExportResult export_png(const std::filesystem::path& results, const std::vector<CameraConfig>& cameras,
                        Progress* progress) {
  return export_films(
      results, "png", cameras,
      [](const std::filesystem::path& stem, const SensorConfig& sensor) {
        return std::make_unique<AnimatedPngWriter>(stem.string() + ".png", sensor.frame_rate);
      },
      progress);
}

}  // namespace flexura
