#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <stdexcept>
#include <string>

#include "flexura/picture/picture_kinds.h"

namespace flexura {
namespace {

// PAM is Netpbm's: https://netpbm.sourceforge.net/doc/pam.html.
struct PamHeader {
  std::optional<std::int64_t> width, height, depth, most;
  std::string tuples;
  std::size_t end = 0;  // Where the values begin.
};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks_of_pam = " \t\v\f\r";
  const std::size_t begin = text.find_first_not_of(blanks_of_pam);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks_of_pam) - begin + 1);
}

std::int64_t pam_number(std::string_view key, std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  constexpr std::int64_t huge = std::int64_t{1} << 31U;
  if (error == std::errc::result_out_of_range) return huge;
  if (text.empty() || error != std::errc() || end != text.data() + text.size() || value < 0)
    throw damaged("PAM", fmt::format("{} without a number", key));
  return std::min(value, huge);
}

// One line of the header; false at its end.
bool read_line(std::string_view line, PamHeader* header) {
  line = trimmed(line);
  if (line.empty() || line.front() == '#') return true;
  const std::size_t space = std::min(line.find_first_of(" \t\v\f"), line.size());
  const std::string_view key = line.substr(0, space), value = trimmed(line.substr(space));
  if (key == "ENDHDR") return false;
  if (key == "WIDTH") {
    header->width = pam_number(key, value);
  } else if (key == "HEIGHT") {
    header->height = pam_number(key, value);
  } else if (key == "DEPTH") {
    header->depth = pam_number(key, value);
  } else if (key == "MAXVAL") {
    header->most = pam_number(key, value);
  } else if (key == "TUPLTYPE") {
    // Several lines are one name.
    header->tuples += (header->tuples.empty() ? "" : " ") + std::string(value);
  } else {
    constexpr std::size_t enough = 20;
    throw damaged("PAM", fmt::format("a line of \"{}\"", key.substr(0, enough)));
  }
  return true;
}

PamHeader read_header(std::string_view file) {
  PamHeader header;
  for (std::size_t at = 3;;) {
    const std::size_t end = file.find('\n', at);
    if (end == std::string_view::npos) throw cut_short("PAM");
    const bool goes_on = read_line(file.substr(at, end - at), &header);
    at = end + 1;
    if (goes_on) continue;
    header.end = at;
    break;
  }
  for (const auto& [key, value] : {std::pair("WIDTH", header.width), std::pair("HEIGHT", header.height),
                                   std::pair("DEPTH", header.depth), std::pair("MAXVAL", header.most)})
    if (!value) throw damaged("PAM", fmt::format("no {}", key));
  return header;
}

// 1 for gray, 3 for colours; alpha follows them.
std::size_t colors_of(const PamHeader& header) {
  struct Tuples {
    std::string_view name;
    std::int64_t depth;
  };
  constexpr std::array<Tuples, 6> known = {{{"BLACKANDWHITE", 1},
                                            {"GRAYSCALE", 1},
                                            {"RGB", 3},
                                            {"BLACKANDWHITE_ALPHA", 2},
                                            {"GRAYSCALE_ALPHA", 2},
                                            {"RGB_ALPHA", 4}}};
  const std::int64_t depth = *header.depth;
  const bool is_known = std::ranges::any_of(known, [&](const Tuples& tuples) {
    return depth == tuples.depth && (header.tuples.empty() || header.tuples == tuples.name);
  });
  if (!is_known) {
    constexpr std::size_t enough = 40;
    std::string name = header.tuples.substr(0, enough);
    std::ranges::replace_if(name, [](char c) { return c < ' ' || c > '~'; }, '?');
    throw std::runtime_error(
        fmt::format("the PAM file has {} values a pixel{}: expected gray or RGB, with alpha or without",
                    depth, name.empty() ? "" : fmt::format(" (\"{}\")", name)));
  }
  return depth < 3 ? 1 : 3;
}

template <typename Value>
Image<Value> image_of(const PamHeader& header, const std::uint8_t* from) {
  const std::size_t colors = colors_of(header);
  Image<Value> image(static_cast<int>(*header.width), static_cast<int>(*header.height),
                     static_cast<int>(colors));
  const std::size_t step = static_cast<std::size_t>(*header.depth) * sizeof(Value);
  const std::int64_t most = *header.most;
  Value* to = image.values().data();
  for (std::size_t pixels = image.values().size() / colors; pixels > 0; --pixels, from += step)
    for (std::size_t c = 0; c < colors; ++c) {
      const std::int64_t written =
          sizeof(Value) == 1 ? from[c] : from[2 * c] * std::int64_t{256} + from[2 * c + 1];
      const std::int64_t value = std::min(written, most);
      *to++ = sizeof(Value) == 1 ? byte_of(value, most) : static_cast<Value>(value);
    }
  return image;
}

}  // namespace

Picture read_pam(std::span<const std::uint8_t> file, std::size_t most_pixels) {
  const PamHeader header = read_header({reinterpret_cast<const char*>(file.data()), file.size()});
  check_picture_size(*header.width, *header.height, most_pixels);
  constexpr std::int64_t most_value = 65535;
  if (*header.most < 1 || *header.most > most_value)
    throw std::runtime_error(
        fmt::format("the PAM file says {} for white: expected 1 to {}", *header.most, most_value));
  (void)colors_of(header);  // Before room is asked for: four values a pixel at most.
  const std::int64_t size = *header.width * *header.height * *header.depth * (*header.most > 255 ? 2 : 1);
  if (static_cast<std::int64_t>(file.size() - header.end) < size) throw cut_short("PAM");
  const std::uint8_t* values = file.data() + header.end;
  if (*header.most > 255) return image_of<std::uint16_t>(header, values);
  return image_of<std::uint8_t>(header, values);
}

}  // namespace flexura
