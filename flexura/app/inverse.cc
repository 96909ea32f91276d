#include "flexura/app/inverse.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "flexura/base/problems.h"
#include "flexura/base/table.h"
#include "flexura/kinematics/inverse.h"
#include "flexura/kinematics/shape.h"
#include "flexura/log/messages.h"
#include "flexura/math/arrays.h"
#include "flexura/model/arm_config.h"
#include "flexura/store/json.h"

namespace flexura {

// In InverseObjective's namespace, for the argument-dependent lookup of the field tables.
static const std::vector<std::string>& names_of(const InverseObjective*) {
  static const std::vector<std::string> names{"none", "least_bending", "mid_range"};
  return names;
}

namespace {

using Triple = std::array<double, 3>;

/// A line of input.
struct InverseRequest {
  std::optional<Triple> position;  ///< m
  std::optional<Triple> direction;
  std::optional<std::array<double, 4>> rotation;  ///< (w, x, y, z)
  std::optional<std::vector<Triple>> curve;       ///< m
  std::optional<double> tolerance;                ///< For a curve, m.
  InverseObjective objective = InverseObjective::none;
  bool all = false;
  std::optional<ShapeConfig> start;
};

const Table<InverseRequest>& fields_of(const InverseRequest*) {
  // Larger than any arm, and small enough to keep sums of squares finite.
  constexpr double farthest = 1e10;
  static const auto table =
      Table<InverseRequest>("ik request", "Target of the tip or of the whole arm.")
          .field(
              "position", &InverseRequest::position,
              {.meaning = "the tip's position", .unit = Unit::metre, .range = between(-farthest, farthest)})
          .field("direction", &InverseRequest::direction, {.meaning = "direction of the tip's z axis"})
          .field("rotation", &InverseRequest::rotation,
                 {.meaning = "quaternion (w, x, y, z) of the tip's frame", .range = between(-2, 2)})
          .field("curve", &InverseRequest::curve,
                 {.meaning = "points along the whole arm",
                  .unit = Unit::metre,
                  .range = between(-farthest, farthest),
                  .count = {2, 10000}})
          .field("tolerance", &InverseRequest::tolerance,
                 {.meaning = "largest distance of the arm from the curve",
                  .unit = Unit::metre,
                  .range = above_up_to(0, farthest)})
          .field("prefer", &InverseRequest::objective, {.meaning = "which of many solutions to prefer"})
          .renamed("wish", "prefer")
          .field("all", &InverseRequest::all, {.meaning = "whether to return all distinct solutions"})
          .field("start", &InverseRequest::start, {.meaning = "the shape from which the search begins"});
  return table;
}

void check_target(const InverseRequest& request, Reader& reader) {
  if (request.position.has_value() == request.curve.has_value()) {
    reader.problem("expected either position or curve");
  }
  if (request.curve) {
    if (request.direction || request.rotation || request.all) {
      reader.problem_at(
          "curve", "cannot be combined with direction, rotation or all: expected these only with a position");
    }
    const auto& points = *request.curve;
    double length = 0;
    for (std::size_t i = 1; i < points.size(); ++i)
      length += (vector(points[i]) - vector(points[i - 1])).norm();
    if (!(length > 0)) reader.problem_at("curve", "has no length");
  }
  if (request.tolerance && !request.curve) reader.problem_at("tolerance", "is for a curve");
  if (request.direction && request.rotation) {
    reader.problem("gives the orientation twice: expected either direction or rotation");
  }
  if (request.direction && vector(*request.direction).isZero(0.0)) {
    reader.problem_at("direction", "is zero: expected a vector other than zero");
  }
  if (request.rotation) {
    const std::string problem = quaternion_problem(*request.rotation);
    if (!problem.empty()) reader.problem_at("rotation", problem);
  }
}

InverseRequest read_inverse_request(const Arm& arm, std::string_view line) {
  const Node document = parse_json(line, "");
  Reader reader;
  InverseRequest request;
  if (fields_of(static_cast<const InverseRequest*>(nullptr)).read(document, reader, request)) {
    check_target(request, reader);
    if (request.start) check_shape(*request.start, arm.kind, arm.sections.size(), "start", reader);
    if (request.start && reader.problems().empty()) check_bends(arm, *request.start, "start", reader);
  }
  reader.throw_if_any();
  return request;
}

TipTarget tip_target(const InverseRequest& request) {
  TipTarget target;
  target.position = vector(*request.position);
  if (request.direction) target.direction = vector(*request.direction);
  if (request.rotation) target.rotation = rotation_of(*request.rotation);
  return target;
}

bool stretches(const Arm& arm) {
  return std::ranges::any_of(
      arm.sections, [](const Section& section) { return section.stretch_limits != std::array{1.0, 1.0}; });
}

// Adds the state and its errors as members of a solution or of the whole answer.
void add_state(const Arm& arm, const InverseRequest& request, const InverseResult& result,
               Node::Table& members) {
  Node::Array bends;
  for (const Eigen::Vector2d& bend : result.state.bends) {
    // Adding zero turns a negative zero into a positive one.
    if (arm.kind == ArmKind::planar) {
      bends.push_back({-0.5 * bend.x() + 0.0, {}});
    } else {
      bends.push_back({Node::Array{{bend.x() + 0.0, {}}, {bend.y() + 0.0, {}}}, {}});
    }
  }
  members.push_back({arm.kind == ArmKind::planar ? "archings" : "bends", {}, {std::move(bends), {}}});
  if (stretches(arm)) {
    Node::Array factors;
    for (const double stretch : result.state.stretches) factors.push_back({stretch, {}});
    members.push_back({"stretches", {}, {std::move(factors), {}}});
  }
  members.push_back({"position_error", {}, {result.position_error, {}}});
  if (request.direction || request.rotation) {
    members.push_back({"angle_error", {}, {result.angle_error, {}}});
  }
}

Node answer_one(const Arm& arm, const InverseRequest& request, const InverseResult& result) {
  if (!result.tip.allFinite())
    throw InputError(std::vector<Problem>{{{}, "the arm has no equilibrium under its weight and loads"}});
  Node::Table members{{"converged", {}, {result.converged(), {}}},
                      {"reason", {}, {std::string(name_of(result.outcome)), {}}}};
  add_state(arm, request, result, members);
  if (request.curve) members.push_back({"tolerance", {}, {result.position_tolerance, {}}});
  if (!result.converged()) {
    members.push_back({"nearest", {}, point_node(result.tip)});
    members.push_back({"distance", {}, {result.position_error, {}}});
    members.push_back({"proven", {}, {result.is_proven, {}}});
  }
  return {std::move(members), {}};
}

Node answer(const ArmModel& model, const InverseRequest& request) {
  const Arm& arm = model.driven();
  InverseConfig config;
  config.objective = request.objective;
  if (request.start) config.start = arm_state(arm, *request.start);
  config.position_tolerance = request.tolerance;
  if (request.curve) {
    CurveTarget target;
    for (const Triple& point : *request.curve) target.points.push_back(vector(point));
    return answer_one(arm, request, solve_inverse(model, target, config));
  }
  const TipTarget target = tip_target(request);
  std::vector<InverseResult> solutions;
  if (request.all) solutions = all_inverse_solutions(model, target, config);
  if (!request.all || solutions.empty()) {
    Node node = answer_one(arm, request, solve_inverse(model, target, config));
    if (request.all) node.as<Node::Table>()->push_back({"solutions", {}, {Node::Array{}, {}}});
    return node;
  }
  Node::Array list;
  for (const InverseResult& solution : solutions) {
    Node::Table members;
    add_state(arm, request, solution, members);
    list.push_back({std::move(members), {}});
  }
  Node node = answer_one(arm, request, solutions.front());
  node.as<Node::Table>()->push_back({"solutions", {}, {std::move(list), {}}});
  return node;
}

}  // namespace

std::string inverse_problem(const Arm& arm, std::string_view line) {
  try {
    (void)read_inverse_request(arm, line);
    return {};
  } catch (const InputError& error) {
    return joined(error.problems());
  }
}

std::string answer_inverse(const ArmModel& arm, std::string_view line) {
  try {
    return write_json(answer(arm, read_inverse_request(arm.driven(), line)));
  } catch (const InputError& error) {
    return write_json({Node::Table{{"error", {}, {joined(error.problems()), {}}}}, {}});
  }
}

}  // namespace flexura
