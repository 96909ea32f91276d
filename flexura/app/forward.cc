#include "flexura/app/forward.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "flexura/base/problems.h"
#include "flexura/base/table.h"
#include "flexura/kinematics/shape.h"
#include "flexura/log/messages.h"
#include "flexura/model/arm_config.h"
#include "flexura/model/arm_model.h"
#include "flexura/store/json.h"

namespace flexura {

namespace {

/// A line of input. The shape's fields are beside `at`, not in a nested table.
struct ForwardRequest {
  std::optional<std::vector<double>> cord_angles;
  std::optional<std::vector<double>> archings;
  std::optional<std::vector<std::array<double, 2>>> bends;
  std::optional<std::vector<double>> stretches;
  std::optional<std::vector<double>> at;  ///< Arc lengths along the current, possibly stretched, backbone, m.

  [[nodiscard]] ShapeConfig shape() const { return {cord_angles, archings, bends, stretches}; }
};

const Table<ForwardRequest>& fields_of(const ForwardRequest*) {
  static const auto table =
      Table<ForwardRequest>("fk request",
                            "Shape of the arm, and positions along the arm whose poses the answer gives.")
          .field("cord_angles", &ForwardRequest::cord_angles,
                 {.meaning = "cords' angles from +X", .unit = Unit::radian, .range = angle_range})
          .field("archings", &ForwardRequest::archings,
                 {.meaning = "archings", .unit = Unit::radian, .range = arching_range})
          .field("bends", &ForwardRequest::bends,
                 {.meaning = "bend vectors", .unit = Unit::radian, .range = bend_range})
          .field("stretches", &ForwardRequest::stretches,
                 {.meaning = "factors on the sections' lengths", .range = above_up_to(0, 100)})
          .field("at", &ForwardRequest::at,
                 {.meaning = "arc lengths", .unit = Unit::metre, .range = at_least(0), .count = {0, 100000}});
  return table;
}

Node answer(const ArmModel& arm, const ForwardRequest& request) {
  const Backbone backbone = arm.backbone(arm_state(arm.driven(), request.shape()));
  Node::Array bases;
  for (const Arc& arc : backbone.arcs())
    if (arc.section == bases.size()) bases.push_back(point_node(arc.X_WS.position));
  bases.push_back(point_node(backbone.tip().position));
  Node::Table members{{"tip", {}, pose_node(backbone.tip())}, {"bases", {}, {std::move(bases), {}}}};
  if (request.at) {
    Node::Array poses;
    for (const double s : *request.at) poses.push_back(pose_node(backbone.pose(s)));
    members.push_back({"at", {}, {std::move(poses), {}}});
  }
  return {std::move(members), {}};
}

ForwardRequest read_forward_request(const ArmModel& model, std::string_view line) {
  const Arm& arm = model.driven();
  const Node document = parse_json(line, "");
  Reader reader;
  ForwardRequest request;
  const bool read = fields_of(static_cast<const ForwardRequest*>(nullptr)).read(document, reader, request);
  if (read) {
    const ShapeConfig shape = request.shape();
    check_shape(shape, arm.kind, arm.sections.size(), "", reader);
    if (!shape.cord_angles && !shape.archings && !shape.bends && !shape.stretches) {
      reader.problem("the request has no shape: expected cord_angles, archings, bends or stretches");
    }
    if (reader.problems().empty()) check_bends(arm, shape, "", reader);
  }
  const bool may_have_no_shape = !model.actuation().is_linear();
  if ((request.at || may_have_no_shape) && reader.problems().empty()) {
    const ArmState shape = model.actuation().shape(arm_state(arm, request.shape()));
    const bool has_shape =
        std::ranges::all_of(shape.bends, [](const Eigen::Vector2d& bend) { return bend.allFinite(); });
    if (!has_shape) reader.problem("the arm has no equilibrium");
    const double length = has_shape && request.at ? model.backbone_of_shape(shape).length() : 0;
    for (std::size_t i = 0; has_shape && request.at && i < request.at->size(); ++i) {
      if ((*request.at)[i] <= length * (1 + 1e-12)) continue;  // The tolerance of Backbone::pose().
      reader.problem_at(fmt::format("at[{}]", i),
                        fmt::format("{} is beyond the tip: expected at most {} m", (*request.at)[i], length));
    }
  }
  reader.throw_if_any();
  return request;
}

}  // namespace

std::string answer_forward(const ArmModel& arm, std::string_view line) {
  try {
    return write_json(answer(arm, read_forward_request(arm, line)));
  } catch (const InputError& error) {
    return write_json({Node::Table{{"error", {}, {joined(error.problems()), {}}}}, {}});
  }
}

}  // namespace flexura
