#include "flexura/app/intrinsics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <ostream>
#include <system_error>
#include <utility>
#include <vector>

#include "flexura/app/commands.h"
#include "flexura/app/intrinsics_answer.h"
#include "flexura/app/intrinsics_files.h"
#include "flexura/app/intrinsics_pictures.h"
#include "flexura/app/intrinsics_table.h"
#include "flexura/app/intrinsics_units.h"
#include "flexura/app/intrinsics_zoom.h"
#include "flexura/app/terminal_progress.h"
#include "flexura/base/source.h"
#include "flexura/base/work_progress.h"
#include "flexura/math/arrays.h"
#include "flexura/store/json.h"

namespace flexura {
namespace {

void check_file(const std::string& option, const std::string& file) {
  if (file.empty() || std::filesystem::path(file).extension() == ".toml") return;
  throw input_error(option,
                    fmt::format("{}: expected a file name that ends in .toml", text_node(file).brief()));
}

// Throws InputError if the folder of an output file is missing: checked before minutes of work, not after.
void check_folder(const std::string& option, const std::string& file) {
  const auto folder = std::filesystem::path(file).parent_path();
  std::error_code error;
  if (folder.empty() || std::filesystem::is_directory(folder, error)) return;
  throw input_error(option, fmt::format("{}: no folder {}: expected an existing folder",
                                        text_node(file).brief(), text_node(folder.string()).brief()));
}

void check_lens(const IntrinsicsArguments& arguments) {
  const auto model = lens_model_of(arguments);
  if (!model && !arguments.zooms.empty())
    throw input_error("--lens", "best: expected brown, rational or fisheye for --zoom");
  if (!arguments.distortion) return;
  if (!model) throw input_error("--distortion", "expected a lens model, instead of --lens best");
  const std::vector<std::string>& names = coefficient_names(*model);
  if (*arguments.distortion < 0 || *arguments.distortion > static_cast<std::int64_t>(names.size()))
    throw input_error("--distortion", fmt::format("{}: expected 0 to {} of {}", *arguments.distortion,
                                                  names.size(), fmt::join(names, ", ")));
}

void check(const IntrinsicsArguments& arguments) {
  const bool has_pair = !arguments.left.empty() || !arguments.right.empty();
  const int kinds =
      (arguments.images.empty() ? 0 : 1) + (has_pair ? 1 : 0) + (arguments.zooms.empty() ? 0 : 1);
  if (kinds != 1)
    throw input_error("IMAGE", "expected pictures of one camera, or --left and --right, or --zoom groups");
  if (arguments.left.size() != arguments.right.size())
    throw input_error(
        "--right",
        fmt::format(
            "{} picture{} for {} of --left: expected one per picture of --left, taken at the same time",
            arguments.right.size(), arguments.right.size() == 1 ? "" : "s", arguments.left.size()));
  check_lens(arguments);
  constexpr std::int64_t most = 1000000;
  if (arguments.hold_out && (*arguments.hold_out < 2 || *arguments.hold_out > most))
    throw input_error(
        "--hold-out",
        fmt::format("{}: expected 2 or more: every Nth view is excluded from the fit", *arguments.hold_out));
  for (const double x : arguments.position)
    if (!std::isfinite(x)) throw input_error("--position", "expected three finite numbers X,Y,Z");
  if (arguments.rotation.size() == 4) {
    const std::string problem = quaternion_problem(
        {arguments.rotation[0], arguments.rotation[1], arguments.rotation[2], arguments.rotation[3]});
    if (!problem.empty()) throw input_error("--rotation", problem);
  }
  check_file("--out", arguments.out), check_file("--rig", arguments.rig);
  if (!arguments.rig_from.empty() && arguments.rig.empty())
    throw input_error("--rig-from", "needs --rig, the file to write");
  if (!arguments.zooms.empty() && !arguments.out.empty())
    throw input_error("--out", "the file cannot store a lens at several zooms: expected --rig FILE");
  check_folder("--out", arguments.out), check_folder("--rig", arguments.rig);
}

// Calibrates one camera, or two with a fixed pose relative to each other.
Node cameras_answer(const IntrinsicsArguments& arguments, const BoardTarget& board, Progress& progress) {
  const bool is_pair = arguments.images.empty();
  const auto names = names_of_cameras(
      arguments, is_pair ? std::vector<std::string>{"left", "right"} : std::vector<std::string>{"camera"});
  const std::vector<std::string>& first = is_pair ? arguments.left : arguments.images;
  // The fit takes about as long as the search in half of the pictures.
  WorkProgress work(progress, {static_cast<double>(first.size()), static_cast<double>(arguments.right.size()),
                               0.5 * static_cast<double>(first.size())});
  std::vector<BoardPictures> pictures;
  pictures.push_back(look_for_board(first, board, is_pair ? "--left" : "IMAGE", work.piece(0)));
  if (is_pair) pictures.push_back(look_for_board(arguments.right, board, "--right", work.piece(1)));
  work.piece(2).update(0, "fitting the cameras");
  const LensComparison lenses = compare_pictures(arguments, board, pictures);
  const IntrinsicsFit& fit = lenses.trials[lenses.best].fit;
  Node::Table answer{{"found", {}, {fit.is_found, {}}}};
  if (!fit.is_found) answer.push_back({"reason", {}, text_node(fit.reason)});
  answer.push_back({"board", {}, board_node(board)});
  if (lenses.trials.size() > 1) answer.push_back({"models", {}, models_node(lenses)});
  auto notes = notes_of(pictures, fit);
  for (std::string& note : unit_notes(arguments, board, fit)) notes.push_back(std::move(note));
  if (!notes.empty()) answer.push_back({"notes", {}, texts_node(notes)});
  if (fit.points > 0) answer.push_back({"rms_px", {}, number_node(fit.rms)});
  add_held_out(fit, answer);
  Node::Array entries;
  for (std::size_t i = 0; i < names.size(); ++i)
    entries.push_back(camera_node(names[i], pictures[i], fit, i, arguments.distortion));
  if (fit.is_found) {
    std::vector<CalibratedCamera> cameras;
    cameras.reserve(names.size());
    for (std::size_t i = 0; i < names.size(); ++i)
      cameras.push_back({names[i], first_pose(arguments) * fit.poses[i], lens_config(fit.cameras[i].lens),
                         pictures[i].size, view_prior_of(fit, i)});
    Node::Array details = entries;
    if (is_pair) details.push_back(pair_node(fit));
    write_files(arguments, cameras, {fit.rms, fit.points, details}, answer);
    if (is_pair) answer.push_back({"pair", {}, pair_node(fit)});
  }
  answer.push_back({"cameras", {}, {std::move(entries), {}}});
  return {std::move(answer), {}};
}

// A glob without a match stays as it is written: then the file is missing, not a picture.
void check_are_there(const IntrinsicsArguments& arguments) {
  for (const auto* files : {&arguments.images, &arguments.left, &arguments.right})
    for (const std::string& file : *files)
      if (std::error_code error; !std::filesystem::exists(file, error))
        throw input_error(file, "no such file");
}

}  // namespace

int intrinsics_command(const IntrinsicsArguments& arguments, std::ostream& out, std::ostream& err) {
  check(arguments);
  const BoardTarget board = board_of(arguments);
  check_are_there(arguments);
  TerminalProgress progress(err);
  const Node answer = arguments.zooms.empty() ? cameras_answer(arguments, board, progress)
                                              : zoom_answer(arguments, board, progress);
  progress.clear();
  if (arguments.json) {
    out << write_json(answer, 2) << '\n';
  } else {
    print_intrinsics(answer, out);
  }
  return *answer.find("found")->as<bool>() ? exit_done : exit_missed;
}

}  // namespace flexura
