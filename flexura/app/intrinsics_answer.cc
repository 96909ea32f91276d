#include "flexura/app/intrinsics_answer.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "flexura/base/table.h"
#include "flexura/math/median.h"
#include "flexura/math/pose.h"

namespace flexura {
namespace {

// Returns the name of an intrinsic parameter; `parameter` is its index in the order of `intrinsics_count`.
std::string parameter_name(const Intrinsics& lens, int parameter) {
  constexpr std::array<const char*, 4> names = {"fx", "fy", "cx", "cy"};
  const auto at = static_cast<std::size_t>(parameter);
  return at < names.size() ? names[at] : coefficient_names(lens.distortion.model())[at - names.size()];
}

Node whole(std::size_t value) { return {static_cast<std::int64_t>(value), {}}; }
template <typename Vector>
Node numbers(const Vector& values) {
  Node::Array entries;
  for (const double value : values) entries.push_back(number_node(value));
  return {std::move(entries), {}};
}
template <typename Matrix>
Node rows_of(const Matrix& matrix) {
  Node::Array rows;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) rows.push_back(numbers(Eigen::RowVectorXd(matrix.row(i))));
  return {std::move(rows), {}};
}

Node views_node(const BoardPictures& pictures, const IntrinsicsFit& fit, std::size_t camera) {
  Node::Array views;
  for (std::size_t i = 0; i < pictures.names.size(); ++i) {
    Node::Table entry{{"image", {}, text_node(pictures.names[i])}};
    if (!pictures.observations[i].is_found()) {
      entry.push_back({"reason", {}, text_node(pictures.observations[i].reason)});
    } else if (camera < fit.cameras.size() && i < fit.cameras[camera].view_rms.size()) {
      const auto rms = fit.cameras[camera].view_rms[i];
      entry.push_back({"rms_px", {}, rms ? number_node(*rms) : Node{}});
      const std::size_t seen = seen_points(pictures.observations[i].pixels);
      if (seen < pictures.observations[i].pixels.size()) entry.push_back({"points", {}, whole(seen)});
      if (fit.is_held_out[i]) entry.push_back({"held_out", {}, {true, {}}});
    }
    views.push_back({std::move(entry), {}});
  }
  return {std::move(views), {}};
}

void add_numbers(const CameraFit& fit, Eigen::Index estimated, bool is_alone, Node::Table& entry) {
  const Intrinsics& lens = fit.lens;
  Node::Table sigma;
  for (int i = 0; i < static_cast<int>(estimated); ++i)
    sigma.push_back({parameter_name(lens, i), {}, number_node(fit.sigma(i))});
  Node::Array undetermined;
  for (const int i : fit.undetermined) undetermined.push_back(text_node(parameter_name(lens, i)));
  entry.insert(
      entry.end(),
      {{"fx", {}, number_node(lens.fx)},
       {"fy", {}, number_node(lens.fy)},
       {"cx", {}, number_node(lens.cx)},
       {"cy", {}, number_node(lens.cy)},
       {"model", {}, text_node(name_of(lens.distortion.model()))},
       {"distortion", {}, numbers(lens.distortion)},
       {"sigma", {}, {std::move(sigma), {}}},
       {"untold", {}, {std::move(undetermined), {}}},
       {"corner_sigma_px", {}, std::isfinite(fit.corner_sigma) ? number_node(fit.corner_sigma) : Node{}},
       {"rms_px", {}, number_node(fit.rms)}});
  if (!is_alone) entry.push_back({"rms_alone_px", {}, number_node(fit.rms_alone)});
  entry.push_back({"covariance", {}, rows_of(fit.covariance.topLeftCorner(estimated, estimated))});
}

// Adds a note on pictures that fit much worse than the others.
void add_warnings(const BoardPictures& pictures, const CameraFit& fit, std::vector<std::string>& notes) {
  std::vector<double> known;
  for (const auto& rms : fit.view_rms)
    if (rms) known.push_back(*rms);
  if (known.size() < 3) return;
  const double usual = median(std::span(known));
  constexpr double suspicious = 3;
  for (std::size_t i = 0; i < fit.view_rms.size(); ++i) {
    if (!fit.view_rms[i] || *fit.view_rms[i] <= suspicious * usual) continue;
    notes.push_back(
        fmt::format("the residual of {} is {:.1f} times that of the median picture: check this picture",
                    pictures.names[i], *fit.view_rms[i] / usual));
  }
}

}  // namespace

Node board_node(const BoardTarget& board) {
  Node::Table entry{{"pattern", {}, text_node(name_of(board.pattern))},
                    {"columns", {}, {std::int64_t{board.columns}, {}}},
                    {"rows", {}, {std::int64_t{board.rows}, {}}},
                    {"square", {}, number_node(board.square)}};
  if (board.has_markers()) {
    entry.push_back({"marker", {}, number_node(board.marker)});
    entry.push_back({"family", {}, text_node(name_of(board.family))});
  }
  return {std::move(entry), {}};
}

Node camera_node(const std::string& name, const BoardPictures& pictures, const IntrinsicsFit& fit,
                 std::size_t camera, std::optional<std::int64_t> distortion) {
  std::size_t used = 0;
  for (std::size_t i = 0; i < pictures.observations.size(); ++i)
    used += pictures.observations[i].is_found() && !fit.is_held_out[i] ? 1 : 0;
  Node::Table entry{
      {"name", {}, text_node(name)},
      {"size",
       {},
       {Node::Array{{std::int64_t{pictures.size[0]}, {}}, {std::int64_t{pictures.size[1]}, {}}}, {}}},
      {"views_used", {}, whole(used)}};
  // A fit that failed early has no parameters.
  if (fit.noise > 0 || fit.is_found) {
    const CameraFit& own = fit.cameras[camera];
    add_numbers(own, distortion ? 4 + *distortion : own.lens.size(), fit.cameras.size() == 1, entry);
  }
  entry.push_back({"views", {}, views_node(pictures, fit, camera)});
  return {std::move(entry), {}};
}

Node models_node(const LensComparison& lenses) {
  Node::Array models;
  for (std::size_t i = 0; i < lenses.trials.size(); ++i) {
    const LensTrial& trial = lenses.trials[i];
    Node::Table entry{{"model", {}, text_node(name_of(trial.model))},
                      {"found", {}, {trial.fit.is_found, {}}}};
    if (!trial.fit.is_found) entry.push_back({"reason", {}, text_node(trial.fit.reason)});
    if (trial.fit.points > 0) entry.push_back({"rms_px", {}, number_node(trial.fit.rms)});
    if (trial.fit.is_found) entry.push_back({"criterion", {}, number_node(trial.criterion)});
    entry.push_back({"chosen", {}, {i == lenses.best, {}}});
    models.push_back({std::move(entry), {}});
  }
  return {std::move(models), {}};
}

Node pair_node(const IntrinsicsFit& fit) {
  const Pose& X_12 = fit.poses[1];
  const Eigen::Matrix<double, 6, 6>& covariance = fit.pose_covariance[1];
  const Eigen::Vector<double, 6> sigma = covariance.diagonal().cwiseSqrt();
  return {Node::Table{{"rms_px", {}, number_node(fit.rms)},
                      {"position", {}, numbers(X_12.position)},
                      {"rotation", {}, numbers(quaternion_wxyz(X_12.rotation))},
                      {"distance", {}, number_node(X_12.position.norm())},
                      {"sigma_position", {}, numbers(Eigen::Vector3d(sigma.head<3>()))},
                      {"sigma_rotation", {}, numbers(Eigen::Vector3d(sigma.tail<3>()))},
                      {"covariance", {}, rows_of(covariance)}},
          {}};
}

namespace {

// Adds a note on pictures whose file states another orientation than the first.
void add_turned(const BoardPictures& pictures, std::vector<std::string>& notes) {
  for (std::size_t i = 0; i < pictures.orientations.size(); ++i) {
    if (pictures.orientations[i] == pictures.orientations.front()) continue;
    notes.push_back(fmt::format(
        "{} was turned as its orientation tag says, but {} was not. If the camera was turned between "
        "the pictures, the principal point is wrong: then remove the tags",
        pictures.names[i], pictures.names.front()));
    return;
  }
}

}  // namespace

std::vector<std::string> notes_of(const std::vector<BoardPictures>& cameras, const IntrinsicsFit& fit) {
  std::vector<std::string> notes;
  for (const BoardPictures& pictures : cameras) add_turned(pictures, notes);
  for (std::size_t i = 0; i < fit.cameras.size() && i < cameras.size(); ++i) {
    add_warnings(cameras[i], fit.cameras[i], notes);
    // Fits with a larger misfit are rejected as a pair (IntrinsicsFit::reason).
    constexpr double much_worse = 2, visible = 0.3;  // px
    const double alone = fit.cameras[i].rms_alone, together = fit.cameras[i].rms;
    if (fit.cameras.size() > 1 && together > std::max(visible, much_worse * alone))
      notes.push_back(
          fmt::format("the residual of camera {} is {:.2g} px alone and {:.2g} px together with the other "
                      "camera: pictures were not taken at the same time, or a camera moved",
                      i + 1, alone, together));
    if (const LensMisfit& misfit = fit.cameras[i].misfit; fit.is_found && misfit.is_systematic())
      notes.push_back(fmt::format(
          "the residuals of camera {} are correlated between neighbouring points: the lens model does not "
          "fit the lens (--lens), or the board is not flat",
          i + 1));
    const auto& undetermined = fit.cameras[i].undetermined;
    // The coefficients of a rational lens can compensate each other.
    const bool is_rational = fit.cameras[i].lens.distortion.model() == LensModel::rational;
    if (!undetermined.empty() && undetermined.front() >= 4 && !is_rational)
      notes.push_back(
          fmt::format("{} of the lens is not observable in these views: use fewer coefficients with "
                      "--distortion, or views in which the board reaches the image's corners",
                      parameter_name(fit.cameras[i].lens, undetermined.front())));
  }
  return notes;
}

void add_held_out(const IntrinsicsFit& fit, Node::Table& answer) {
  if (!fit.held_out_rms) return;
  const auto views = static_cast<std::int64_t>(std::ranges::count(fit.is_held_out, true));
  answer.push_back(
      {"held_out",
       {},
       {Node::Table{{"views", {}, {views, {}}}, {"rms_px", {}, number_node(*fit.held_out_rms)}}, {}}});
}

}  // namespace flexura
