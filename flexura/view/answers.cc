#include "flexura/view/answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "flexura/base/node.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/log/messages.h"
#include "flexura/model/backbone.h"
#include "flexura/store/json.h"
#include "flexura/view/describe.h"
#include "flexura/view/session.h"
#include "flexura/view/state_message.h"

namespace flexura {
namespace {

// A report is a separate page, possibly from another source. It may run its script, but without access to
// this server.
constexpr const char* report_policy =
    "sandbox allow-scripts; default-src 'none'; img-src data:; script-src 'unsafe-inline'; style-src "
    "'unsafe-inline'; base-uri 'none'; form-action 'none'";

}  // namespace

Node nothing() { return {Node::Table{}, {}}; }

Node bends_answer(const ArmState& state) {
  Node::Array bends;
  for (const Eigen::Vector2d& bend : state.bends)
    bends.push_back({Node::Array{{bend.x() + 0.0, {}}, {bend.y() + 0.0, {}}}, {}});
  return {std::move(bends), {}};
}

Node point_answer(const Backbone& backbone, double s) {
  const double length = backbone.rest_length();
  // Tolerance for a page that knows the arm in single precision and requests its end.
  const bool is_on_arm = s >= -1e-6 * length && s <= (1 + 1e-6) * length;
  if (!is_on_arm) throw ViewRefusal(fmt::format("s = {}: expected 0 to {:.6g} m", s, length));
  s = std::clamp(s, 0.0, length);
  const auto holds = [s](const Arc& candidate) { return s <= candidate.s_rest + candidate.rest_length; };
  const auto found = std::ranges::find_if(backbone.arcs(), holds);
  const Arc& arc = found != backbone.arcs().end() ? *found : backbone.arcs().back();
  const Pose X_WS = arc.pose(std::min(1.0, (s - arc.s_rest) / arc.rest_length) * arc.length);
  return {Node::Table{{"s", {}, {s, {}}},
                      {"position", {}, point_node(X_WS.position)},
                      {"tangent", {}, point_node(X_WS.rotation.col(2))},
                      {"curvature", {}, {arc.bend.norm() / arc.length, {}}},
                      {"bending_plane", {}, {std::atan2(arc.bend.y(), arc.bend.x()), {}}},
                      {"section", {}, {static_cast<std::int64_t>(arc.section), {}}}},
          {}};
}

Node backbone_answer(const Backbone& backbone) {
  Node::Array poses;
  for (const ArmSample& sample : arm_samples(backbone)) poses.push_back(flat_pose_node(sample.X_WS));
  return {Node::Table{{"poses", {}, {std::move(poses), {}}}}, {}};
}

Node tip_answer(const InverseResult& found, const std::string& danger) {
  return {Node::Table{{"converged", {}, {found.converged(), {}}},
                      {"reason", {}, {std::string(name_of(found.outcome)), {}}},
                      {"bends", {}, bends_answer(found.state)},
                      {"position_error", {}, {found.position_error, {}}},
                      {"moved", {}, {danger.empty(), {}}},
                      {"danger", {}, {danger, {}}}},
          {}};
}

HttpAnswer failure_answer(int status, const std::string& why) {
  return {status, "application/json", write_json({Node::Table{{"error", {}, text_node(why)}}, {}}), ""};
}

HttpAnswer report_answer(std::string page) {
  return {200, "text/html; charset=utf-8", std::move(page), report_policy};
}

}  // namespace flexura
