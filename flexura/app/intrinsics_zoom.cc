#include "flexura/app/intrinsics_zoom.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "flexura/app/intrinsics_answer.h"
#include "flexura/app/intrinsics_files.h"
#include "flexura/app/intrinsics_pictures.h"
#include "flexura/base/source.h"
#include "flexura/base/work_progress.h"
#include "flexura/camera/zoom.h"

namespace flexura {
namespace {

// One calibrated position of a zoom.
struct MeasuredZoom {
  ZoomGroup group;
  BoardPictures pictures;
  IntrinsicsFit fit;

  [[nodiscard]] double focal_length() const {
    return std::sqrt(fit.cameras.front().lens.fx * fit.cameras.front().lens.fy);
  }
};

// Returns the lens with all positions, by increasing focal length. Missing ratios are set to those of the
// focal lengths.
LensConfig zoom_lens(std::vector<MeasuredZoom>& zooms) {
  std::ranges::sort(zooms, {}, &MeasuredZoom::focal_length);
  const double shortest = zooms.front().focal_length();
  LensConfig lens;
  for (MeasuredZoom& zoom : zooms) {
    if (!zoom.group.ratio) zoom.group.ratio = zoom.focal_length() / shortest;
    const Intrinsics& own = zoom.fit.cameras.front().lens;
    lens.zoom.push_back(
        {*zoom.group.ratio, zoom.group.count, own.fx, own.fy, own.cx, own.cy, own.distortion});
  }
  // The lens at ratio 1 comes from the row nearest to it, divided by that row's ratio.
  const ZoomRow& one = *std::ranges::min_element(
      lens.zoom, {}, [](const ZoomRow& row) { return std::abs(std::log(row.ratio)); });
  lens.fx = *one.fx / one.ratio, lens.fy = *one.fy / one.ratio;
  lens.cx = one.cx, lens.cy = one.cy, lens.distortion = *one.distortion;
  lens.model = one.distortion->model();
  return lens;
}

// Returns notes on given ratios that contradict the focal lengths.
std::vector<std::string> notes_on_ratios(const std::vector<MeasuredZoom>& zooms) {
  constexpr double far = 0.05;  // Relative difference.
  std::vector<std::string> notes;
  const auto has_ratio = [](const MeasuredZoom& zoom) { return zoom.group.ratio && zoom.fit.is_found; };
  const auto given = std::ranges::find_if(zooms, has_ratio);
  if (given == zooms.end()) return notes;
  const MeasuredZoom& first = *given;
  for (const MeasuredZoom& zoom : zooms) {
    if (!has_ratio(zoom)) continue;
    const double reported = *zoom.group.ratio / *first.group.ratio,
                 seen = zoom.focal_length() / first.focal_length();
    if (!(std::abs(std::log(reported / seen)) <= far))
      notes.push_back(
          fmt::format("{}: the given zoom ratio is {:.4g} times that of {}, but the measured focal length is "
                      "{:.4g} times as long",
                      zoom.group.folder, reported, first.group.folder, seen));
  }
  return notes;
}

Node zoom_node(const IntrinsicsArguments& arguments, const std::string& name, const MeasuredZoom& zoom) {
  Node::Table entry;
  if (zoom.group.ratio) entry.push_back({"ratio", {}, number_node(*zoom.group.ratio)});
  if (zoom.group.count) entry.push_back({"count", {}, number_node(*zoom.group.count)});
  entry.push_back({"folder", {}, text_node(zoom.group.folder)});
  if (!zoom.fit.is_found) entry.push_back({"reason", {}, text_node(zoom.fit.reason)});
  if (const auto notes = notes_of({zoom.pictures}, zoom.fit); !notes.empty())
    entry.push_back({"notes", {}, texts_node(notes)});
  add_held_out(zoom.fit, entry);
  Node camera = camera_node(name, zoom.pictures, zoom.fit, 0, arguments.distortion);
  auto& members = *camera.as<Node::Table>();
  entry.insert(entry.end(), members.begin(), members.end());
  return {std::move(entry), {}};
}

}  // namespace

Node zoom_answer(const IntrinsicsArguments& arguments, const BoardTarget& board, Progress& progress) {
  const std::string name = names_of_cameras(arguments, {"camera"}).front();
  std::vector<MeasuredZoom> zooms;
  std::string reason;
  const std::vector<ZoomGroup> groups = zoom_groups(arguments.zooms);
  WorkProgress work(progress, std::vector<double>(groups.size(), 1));
  for (const ZoomGroup& group : groups) {
    MeasuredZoom& zoom = zooms.emplace_back();
    zoom.group = group;
    const auto files = pictures_in(group.folder);
    zoom.pictures = look_for_board(files, board, group.folder, work.piece(zooms.size() - 1));
    if (zoom.pictures.size != zooms.front().pictures.size)
      throw input_error(group.folder, fmt::format("the pictures do not have the size of those in {}",
                                                  zooms.front().group.folder));
    zoom.fit = fit_pictures(arguments, board, {zoom.pictures});
    if (!zoom.fit.is_found && reason.empty()) reason = group.folder + ": " + zoom.fit.reason;
  }
  CalibratedCamera camera{name, first_pose(arguments), {}, zooms.front().pictures.size, {}};
  const std::vector<std::string> notes = notes_on_ratios(zooms);  // Before missing ratios are filled in.
  if (reason.empty()) {
    camera.lens = zoom_lens(zooms);
    if (const auto fault = ZoomTable::fault(camera.lens))
      reason = fmt::format("the result is not a valid zoom table: {}: {}", fault->path, fault->what);
  }
  Node::Table answer{{"found", {}, {reason.empty(), {}}}};
  if (!reason.empty()) answer.push_back({"reason", {}, text_node(reason)});
  answer.push_back({"board", {}, board_node(board)});
  Node::Array entries;
  for (const MeasuredZoom& zoom : zooms) entries.push_back(zoom_node(arguments, name, zoom));
  if (reason.empty()) {
    double square = 0;
    std::size_t points = 0;
    for (const MeasuredZoom& zoom : zooms) {
      points += zoom.fit.points;
      square += zoom.fit.rms * zoom.fit.rms * static_cast<double>(zoom.fit.points);
    }
    const double rms = std::sqrt(square / static_cast<double>(points));
    answer.push_back({"rms_px", {}, number_node(rms)});
    write_files(arguments, {camera}, {rms, points, entries}, answer);
  }
  if (!notes.empty()) answer.push_back({"notes", {}, texts_node(notes)});
  answer.push_back({"zoom", {}, {std::move(entries), {}}});
  return {std::move(answer), {}};
}

}  // namespace flexura
