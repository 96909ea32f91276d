#include "flexura/app/intrinsics_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "flexura/base/bytes.h"
#include "flexura/base/node.h"
#include "flexura/base/source.h"
#include "flexura/board/board_bundle.h"
#include "flexura/picture/orientation.h"
#include "flexura/store/text_file.h"
#include "flexura/vision/picture_file.h"

namespace flexura {
namespace {

// Parses the whole text as a number; std::nullopt if that fails.
template <typename Number>
std::optional<Number> number_in(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<double> finite(std::string_view text) {
  const auto value = number_in<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::string quoted(const std::string& text) { return Node{text, {}}.brief(); }

ZoomGroup zoom_group(const std::string& text) {
  const auto fail = [&] {
    return input_error("--zoom",
                       quoted(text) + ": expected RATIO=FOLDER, RATIO@COUNT=FOLDER or @COUNT=FOLDER");
  };
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals + 1 == text.size()) throw fail();
  const std::string_view position = std::string_view(text).substr(0, equals);
  const std::size_t at = position.find('@');
  const std::string_view ratio = position.substr(0, at);
  ZoomGroup group;
  group.folder = text.substr(equals + 1);
  if (!ratio.empty() || at == std::string_view::npos) {
    group.ratio = finite(ratio);
    if (!group.ratio || *group.ratio <= 0) throw fail();
  }
  if (at != std::string_view::npos) {
    group.count = finite(position.substr(at + 1));
    if (!group.count) throw fail();
  }
  return group;
}

// Returns the views of cameras whose pictures correspond one to one.
std::vector<BoardView> views_of(const std::vector<BoardPictures>& cameras) {
  std::vector<BoardView> views(cameras.front().observations.size());
  for (std::size_t view = 0; view < views.size(); ++view)
    for (const BoardPictures& camera : cameras)
      views[view].pixels.push_back(camera.observations[view].pixels);
  return views;
}

// Rejects a point count smaller than the board's: the detected points would be a different part of it in each
// picture.
void refuse_larger(const BoardPictures& pictures, const BoardTarget& board) {
  const auto found = std::ranges::count_if(pictures.observations, &BoardObservation::is_found),
             larger = std::ranges::count_if(pictures.observations, &BoardObservation::is_larger);
  if (larger <= found) return;
  const auto first = std::ranges::find_if(pictures.observations, &BoardObservation::is_larger);
  throw input_error(
      "--board",
      fmt::format("{}x{}: the board has more points than this in {} of {} pictures ({} is the first): "
                  "expected the numbers of all its inner corners (or circles)",
                  board.columns, board.rows, larger, pictures.names.size(),
                  pictures.names[static_cast<std::size_t>(first - pictures.observations.begin())]));
}

// Points that are not seen are NaN.
bool are_equal(const std::vector<Eigen::Vector2d>& one, const std::vector<Eigen::Vector2d>& other) {
  return std::ranges::equal(one, other, [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a == b || (!is_seen(a) && !is_seen(b));
  });
}

// Rejects pictures given twice, which would count as two observations. Copies have bitwise equal corners,
// whatever their names; noise makes two pictures of one board differ.
void refuse_twice(const std::vector<BoardPictures>& cameras) {
  std::vector<std::pair<const std::string*, const BoardObservation*>> once;
  std::vector<std::pair<std::string, std::string>> twice;
  for (const BoardPictures& camera : cameras) {
    for (std::size_t i = 0; i < camera.names.size(); ++i) {
      const BoardObservation& observation = camera.observations[i];
      if (!observation.is_found()) continue;
      const auto same = std::ranges::find_if(
          once, [&](const auto& earlier) { return are_equal(earlier.second->pixels, observation.pixels); });
      if (same == once.end())
        once.emplace_back(&camera.names[i], &observation);
      else
        twice.emplace_back(camera.names[i], *same->first);
    }
  }
  if (twice.empty()) return;
  const auto& [name, earlier] = twice.front();
  throw input_error(
      name, fmt::format("{}{}: expected each picture once",
                        name == earlier ? "is given twice" : fmt::format("the same picture as {}", earlier),
                        twice.size() > 1 ? fmt::format(" (and {} more like it)", twice.size() - 1) : ""));
}

}  // namespace

BoardPictures look_for_board(const std::vector<std::string>& files, const BoardTarget& board,
                             const std::string& option, Progress& progress) {
  if (files.size() < 2)
    throw input_error(
        option,
        fmt::format("{} picture{}: expected at least two, which show the board from different directions",
                    files.size(), files.size() == 1 ? "" : "s"));
  BoardPictures pictures;
  pictures.names = files;
  std::size_t done = 0;
  for (const std::string& name : files) {
    progress.update(static_cast<double>(done++) / static_cast<double>(files.size()), name);
    const std::string file = read_text_file(name, most_picture_bytes);
    pictures.orientations.push_back(orientation_in(bytes_of(file)));
    const Photograph photograph = decode_picture(bytes_of(file), name);
    const std::array<int, 2> size = {photograph.bytes.width(), photograph.bytes.height()};
    if (pictures.observations.empty()) pictures.size = size;
    if (size != pictures.size)
      throw input_error(name, fmt::format("{} x {} px{}: expected {} x {} px, as {}", size[0], size[1],
                                          pictures.orientations.back() == pictures.orientations.front()
                                              ? ""
                                              : " when turned as its orientation tag says",
                                          pictures.size[0], pictures.size[1], files.front()));
    pictures.observations.push_back(find_board(gray_picture(photograph.bytes), board));
  }
  progress.update(1, files.back());
  refuse_larger(pictures, board);
  return pictures;
}

std::vector<ZoomGroup> zoom_groups(const std::vector<std::string>& zooms) {
  std::vector<ZoomGroup> groups;
  for (const std::string& text : zooms) {
    const ZoomGroup& group = groups.emplace_back(zoom_group(text));
    if (group.ratio.has_value() != groups.front().ratio.has_value() ||
        group.count.has_value() != groups.front().count.has_value())
      throw input_error(
          "--zoom",
          quoted(text) + ": expected a ratio in all groups or in none, and a count in all groups or in none");
  }
  if (groups.size() < 2) throw input_error("--zoom", "one group of pictures: expected at least two");
  return groups;
}

std::vector<std::string> pictures_in(const std::string& folder) {
  // Includes kinds that cannot be read: an error that names them is better than a fit of the others alone.
  static const std::vector<std::string> kinds = {".png",  ".jpg",  ".jpeg", ".jp2", ".j2k", ".tif",
                                                 ".tiff", ".webp", ".bmp",  ".dib", ".pbm", ".pgm",
                                                 ".ppm",  ".pnm",  ".pam",  ".ras", ".sr"};
  std::error_code error;
  std::vector<std::string> files;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::string kind = entry->path().extension().string();
    std::ranges::transform(kind, kind.begin(), [](char c) {
      return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    if (std::ranges::count(kinds, kind) > 0) files.push_back(entry->path().string());
  }
  if (error) throw input_error(folder, "the folder cannot be read");
  std::ranges::sort(files);
  return files;
}

std::optional<LensModel> lens_model_of(const IntrinsicsArguments& arguments) {
  const std::vector<std::string>& names = names_of(static_cast<const LensModel*>(nullptr));
  const auto at = std::ranges::find(names, arguments.lens);
  if (at != names.end()) return static_cast<LensModel>(at - names.begin());
  if (arguments.lens == "best") return std::nullopt;
  throw input_error("--lens", fmt::format("{}: expected one of {}, best", text_node(arguments.lens).brief(),
                                          fmt::join(names, ", ")));
}

LensComparison compare_pictures(const IntrinsicsArguments& arguments, const BoardTarget& board,
                                const std::vector<BoardPictures>& pictures) {
  refuse_twice(pictures);
  std::vector<std::array<int, 2>> sizes;
  sizes.reserve(pictures.size());
  for (const BoardPictures& camera : pictures) sizes.push_back(camera.size);
  const std::vector<BoardView> views = views_of(pictures);
  const auto model = lens_model_of(arguments);
  IntrinsicsConfig config{.model = model.value_or(LensModel::brown),
                          .hold_out = static_cast<int>(arguments.hold_out.value_or(0)),
                          .orders = board.equal_orders()};
  if (arguments.distortion) config.distortion = static_cast<int>(*arguments.distortion);
  if (!model) return compare_lenses(board.points(), views, sizes, config);
  return {{{config.model, fit_intrinsics(board.points(), views, sizes, config), 0}}, 0};
}

IntrinsicsFit fit_pictures(const IntrinsicsArguments& arguments, const BoardTarget& board,
                           const std::vector<BoardPictures>& pictures) {
  return compare_pictures(arguments, board, pictures).trials.front().fit;
}

}  // namespace flexura
