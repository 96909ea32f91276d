#include "flexura/calibrate/rig_rows.h"

#include <algorithm>
#include <array>
#include <utility>

#include "flexura/kinematics/spatial.h"
#include "flexura/math/so3.h"

namespace flexura {
namespace {

// Intervals of the backbone's image per section: arcs of an eighth of a radian for sections that bend by one.
constexpr std::size_t intervals = 8;

ShapePrior known_arm(const Arm& arm) {
  ShapePrior prior;
  prior.arm = arm;
  return prior;
}

// Unit direction of the curve at point i.
Eigen::Vector2d heading(const std::vector<CurvePoint>& points, std::size_t i) {
  const std::size_t before = i > 0 ? i - 1 : i, after = std::min(i + 1, points.size() - 1);
  return (points[after].pixel - points[before].pixel).normalized();
}

}  // namespace

RigProjector::RigProjector(const RigVariables& variables, const Eigen::VectorXd& x,
                           const std::optional<EtalonConfig>& etalon)
    : variables_(&variables), x_(x), curve_(ShapeVariables(known_arm(variables.guess().arm)), intervals) {
  RigModel model = variables.model(x);
  for (const CameraConfig& camera : model.cameras) cameras_.emplace_back(camera);
  for (std::size_t i = 0; i < variables.read().size(); ++i) {
    stances_.push_back(variables.stance(x, i));
  }
  for (std::size_t i = 0; i < variables.commanded().size(); ++i) {
    const Shape& shape = shapes_.emplace_back(Shape{model.arm, variables.pose(x, i)});
    jacobians_.emplace_back(shape.arm, shape.state);
  }
  if (etalon) etalon_.emplace(*etalon);
  jacobian_.resize(6, 3 * static_cast<Eigen::Index>(model.arm.sections.size()));
  models_ = std::move(model.cameras);
}

View RigProjector::view(std::size_t stance) const {
  const RigStance& where = stances_[stance];
  return cameras_[where.camera].view(where.stance());
}

bool RigProjector::is_in_range(std::size_t stance) const {
  const RigStance& where = stances_[stance];
  const ZoomTable& lens = cameras_[where.camera].lens();
  return where.head.zoom >= lens.first() && where.head.zoom <= lens.last();
}

std::optional<RigProjector::Shown> RigProjector::show(std::size_t pose, std::size_t stance,
                                                      const MaterialPoint& point) {
  const RigStance& where = stances_[stance];
  const BackboneJacobian& backbone = jacobians_[pose];
  const auto projection = cameras_[where.camera].project(backbone.pose(point).position, where.stance());
  if (!projection) return std::nullopt;
  backbone.at(point, jacobian_);
  Shown shown;
  shown.pixel = projection->pixel;
  shown.by_slots.resize(2, variables_->slots_a_camera(where.camera) + variables_->slots_of_arm() +
                               variables_->slots_a_pose() + stance_slots);
  add_camera_slots(*projection, stance, shown);
  add_arm_slots(*projection, pose, stance, shown);
  return shown;
}

void RigProjector::add_camera_slots(const CameraProjection& projection, std::size_t stance,
                                    Shown& shown) const {
  const RigStance& where = stances_[stance];
  const ZoomTable& lens = cameras_[where.camera].lens();
  const Intrinsics now = lens.at(where.head.zoom);
  const std::vector<ZoomRow>& rows = models_[where.camera].lens.zoom;
  const Eigen::Vector3d turn = variables_->value3(
      x_, variables_->camera_slots(where.camera) + static_cast<std::size_t>(mount_rotation_slot));
  const Eigen::Vector2d by_fx = projection.by_intrinsics.col(0), by_fy = projection.by_intrinsics.col(1);
  auto& by = shown.by_slots;
  by.middleCols<3>(mount_position_slot) = projection.by_mount.leftCols<3>();
  by.middleCols<3>(mount_rotation_slot) = projection.by_mount.rightCols<3>() * so3_left_jacobian(turn);
  by.col(pan_zero_slot) = projection.by_pan;
  by.col(tilt_zero_slot) = projection.by_tilt;
  by.middleCols<3>(tilt_axis_slot) = projection.by_tilt_axis;
  by.middleCols<3>(pupil_slot) = projection.by_pupil;
  by.col(pupil_shift_slot) = projection.by_pupil_shift;
  by.col(focal_slot) = now.fx * by_fx + now.fy * by_fy;
  by.col(aspect_slot) = now.fy * by_fy;
  by.middleCols<2>(principal_point_slot) = projection.by_intrinsics.middleCols<2>(2);
  by.middleCols<static_cast<int>(Distortion::most)>(distortion_slot) =
      projection.by_intrinsics.rightCols<static_cast<int>(Distortion::most)>();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto by_row = lens.by_row(where.head.zoom, i);
    by.col(zoom_row_slot + static_cast<Eigen::Index>(i)) =
        by_row[0] * *rows[i].fx * by_fx + by_row[1] * *rows[i].fy * by_fy;
  }
  auto by_stance = by.rightCols<stance_slots>();
  by_stance.col(0) = projection.by_pan, by_stance.col(1) = projection.by_tilt;
  by_stance.col(2) = projection.by_zoom;
  by_stance.rightCols<3>() = projection.by_stage;
}

// The point's own Jacobian is in jacobian_.
void RigProjector::add_arm_slots(const CameraProjection& projection, std::size_t pose, std::size_t stance,
                                 Shown& shown) const {
  const Shape& shape = shapes_[pose];
  const auto sections = static_cast<Eigen::Index>(shape.arm.sections.size());
  const Eigen::Index first = variables_->slots_a_camera(stances_[stance].camera),
                     own = first + variables_->slots_of_arm();
  const RigResponse& response = variables_->response();
  const auto inputs = static_cast<Eigen::Index>(response.inputs());
  shown.by_slots.middleCols(own, variables_->slots_a_pose()).setZero();
  for (Eigen::Index i = 0; i < sections; ++i) {
    const auto section = static_cast<std::size_t>(i);
    const Eigen::Matrix<double, 2, 3> by_state = projection.by_point * jacobian_.block<3, 3>(0, 3 * i);
    shown.by_slots.col(first + i) = shape.state.stretches[section] * by_state.col(2);
    shown.by_slots.col(first + sections + i) =
        by_state.leftCols<2>() * variables_->commanded()[pose].bends[section];
    shown.by_slots.middleCols<2>(own + 2 * i) = by_state.leftCols<2>();
    if (inputs == 0) continue;
    for (Eigen::Index j = 0; j < inputs; ++j)
      shown.by_slots.col(first + 2 * sections + i * inputs + j) =
          by_state.leftCols<2>() * response.input(pose, section, static_cast<std::size_t>(j));
    const auto driven = static_cast<Eigen::Index>(response.section_of(section));
    shown.by_slots.middleCols<2>(own + 2 * (sections + driven)) +=
        response.share(section) * (by_state.leftCols<2>() * response.axes(pose).directions);
  }
}

bool RigProjector::rows(const RigImage& image, RigRows& rows) {
  if (!is_in_range(image.stance)) return false;
  const std::size_t camera = stances_[image.stance].camera;
  const std::array<std::pair<std::size_t, std::size_t>, 4> ranges = {
      std::pair{variables_->camera_slots(camera),
                static_cast<std::size_t>(variables_->slots_a_camera(camera))},
      {variables_->arm_slots(), static_cast<std::size_t>(variables_->slots_of_arm())},
      {variables_->pose_slots(image.pose), static_cast<std::size_t>(variables_->slots_a_pose())},
      {variables_->stance_slots_of(image.stance), static_cast<std::size_t>(stance_slots)}};
  rows.columns.clear(), rows.sizes.clear(), picked_.clear();
  Eigen::Index local = 0;
  for (const auto& [first, count] : ranges) {
    for (std::size_t slot = first; slot < first + count; ++slot, ++local) {
      if (variables_->column(slot) < 0) continue;
      rows.columns.push_back(variables_->column(slot));
      picked_.push_back(local);
    }
  }
  const std::size_t count = image.things() + image.markers.size();
  rows.residuals.resize(static_cast<Eigen::Index>(count));
  rows.derivatives.resize(rows.residuals.size(), static_cast<Eigen::Index>(picked_.size()));
  return add_markers(image, rows) && add_points(image, rows) && add_etalon(image, rows);
}

void RigProjector::set_row(Eigen::Index row, const Shown& shown, const Eigen::Vector2d& way,
                           const Eigen::Vector2d& seen, double sigma, RigRows& rows) const {
  rows.residuals[row] = way.dot(shown.pixel - seen) / sigma;
  for (std::size_t i = 0; i < picked_.size(); ++i)
    rows.derivatives(row, static_cast<Eigen::Index>(i)) = way.dot(shown.by_slots.col(picked_[i])) / sigma;
}

bool RigProjector::add_markers(const RigImage& image, RigRows& rows) {
  Eigen::Index row = 0;
  for (const SeenMarker& marker : image.markers) {
    const auto shown = show(image.pose, image.stance, material_point(variables_->guess().arm, marker.s));
    if (!shown) return false;
    set_row(row++, *shown, Eigen::Vector2d::UnitX(), marker.pixel, marker.sigma, rows);
    set_row(row++, *shown, Eigen::Vector2d::UnitY(), marker.pixel, marker.sigma, rows);
    rows.sizes.push_back(2);
  }
  return true;
}

// Each point is matched to the nearest one of the backbone's image, searched a little way on from the
// previous one. Residuals are taken across the image there, so that the derivative by the curve parameter
// does not matter.
bool RigProjector::add_points(const RigImage& image, RigRows& rows) {
  if (image.points.empty()) return true;
  curve_.set(shapes_[image.pose]);
  if (!image_.set(view(image.stance), curve_)) return false;
  const auto knots = static_cast<std::size_t>(image_.last());
  const std::size_t back = 1 + knots / 16, ahead = 2 + knots / 6;
  CurveImage::Window window = image_.everywhere();
  auto row = static_cast<Eigen::Index>(2 * image.markers.size());
  for (std::size_t i = 0; i < image.points.size(); ++i) {
    const CurvePoint& point = image.points[i];
    const CurveImage::Point near = image_.nearest(point.pixel, heading(image.points, i), window);
    const auto at = static_cast<std::size_t>(near.place);
    window = {at > back ? at - back : 0, at + ahead, at};
    const std::size_t section = std::min(at, knots - 1) / intervals;
    const double fraction =
        (near.place - static_cast<double>(section * intervals)) / static_cast<double>(intervals);
    const auto shown = show(image.pose, image.stance, {section, fraction});
    if (!shown) return false;
    set_row(row++, *shown, {-near.tangent.y(), near.tangent.x()}, point.pixel, point.sigma, rows);
    rows.sizes.push_back(1);
  }
  return true;
}

// Residuals are taken across the part's image at its nearest point, for the same reason. The cylinder is
// fixed: neither the arm nor its pose matters.
bool RigProjector::add_etalon(const RigImage& image, RigRows& rows) {
  if (image.etalon.empty()) return true;
  if (!etalon_) return false;
  const RigStance& where = stances_[image.stance];
  const View view = this->view(image.stance);
  auto row = rows.residuals.size() - static_cast<Eigen::Index>(image.etalon.size());
  Shown shown;
  shown.by_slots.setZero(2, variables_->slots_a_camera(where.camera) + variables_->slots_of_arm() +
                                variables_->slots_a_pose() + stance_slots);
  for (const EtalonPoint& seen : image.etalon) {
    const auto point = etalon_->nearest(seen, view);
    if (!point) return false;
    const auto projection = cameras_[where.camera].project(*point, where.stance());
    if (!projection) return false;
    shown.pixel = projection->pixel;
    add_camera_slots(*projection, image.stance, shown);
    const auto line = etalon_->line(seen.part, seen.number, view.X_WC.position, seen.half);
    const Eigen::Vector2d along = (projection->by_point * line->direction).normalized();
    set_row(row++, shown, {-along.y(), along.x()}, seen.pixel, seen.sigma, rows);
    rows.sizes.push_back(1);
  }
  return true;
}

}  // namespace flexura
