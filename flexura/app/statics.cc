#include "flexura/app/statics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "flexura/app/rod_request.h"
#include "flexura/app/statics_target.h"
#include "flexura/base/problems.h"
#include "flexura/log/messages.h"
#include "flexura/mechanics/arm_rod.h"
#include "flexura/mechanics/inverse_statics.h"
#include "flexura/store/json.h"

namespace flexura {
namespace {

/// A line of input.
struct StaticsRequest : RodRequest {
  std::optional<StaticsTarget> target;    ///< Where the arm shall be: the tensions are to be found.
  std::optional<std::vector<double>> at;  ///< Arc lengths at rest, m.
};

const Table<StaticsRequest>& fields_of(const StaticsRequest*) {
  static const auto table = [] {
    Table<StaticsRequest> made(
        "statics request", "Forces on the arm, and positions along the arm whose poses the answer gives.");
    add_rod_fields(made)
        .field("target", &StaticsRequest::target,
               {.meaning = "target of the arm, instead of tensions or displacements"})
        .field("at", &StaticsRequest::at,
               {.meaning = "arc lengths at rest",
                .unit = Unit::metre,
                .range = at_least(0),
                .count = {0, max_statics_places}});
    return made;
  }();
  return table;
}

StaticsRequest read_request(const Rod& rod, std::string_view line) {
  const Node document = parse_json(line, "");
  Reader reader;
  StaticsRequest request;
  if (fields_of(static_cast<const StaticsRequest*>(nullptr)).read(document, reader, request)) {
    check_rod_request(rod, request, reader);
    if (request.target) {
      check_statics_target(rod, *request.target, reader);
      if (request.tensions || request.displacements)
        reader.problem_at(
            "target",
            "is given together with tensions or displacements: expected only one of the three keys");
    }
    const double length = rod.length();
    for (std::size_t i = 0; request.at && i < request.at->size(); ++i) {
      if ((*request.at)[i] <= length * (1 + 1e-12)) continue;
      reader.problem_at(fmt::format("at[{}]", i),
                        fmt::format("{} is beyond the tip: expected at most {} m", (*request.at)[i], length));
    }
  }
  reader.throw_if_any();
  return request;
}

Node numbers(const std::vector<double>& values) {
  Node::Array entries;
  for (const double value : values) entries.push_back({value, {}});
  return {std::move(entries), {}};
}

Node place_nodes(const RodChain& chain, const std::vector<RodPlace>& places) {
  Node::Array poses;
  for (const RodPlace& place : places) {
    poses.push_back(pose_node(chain.pose(chain.node_of(place))));
  }
  return {std::move(poses), {}};
}

Node::Table unknown(const char* reason) {
  return {{"converged", {}, {false, {}}}, {"reason", {}, {std::string(reason), {}}}};
}

bool is_finite(const Equilibrium& found) {
  const auto all = [](const std::vector<double>& values) {
    return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
  };
  return found.tip.position.allFinite() && found.tip.rotation.allFinite() && all(found.tensions) &&
         all(found.displacements) && std::isfinite(found.strain_energy);
}

Node::Table answer_of(const Equilibrium& found) {
  if (found.end == StaticsEnd::no_equilibrium) return unknown("no_equilibrium");
  if (found.end == StaticsEnd::disks_meet) return unknown("disks_meet");
  // Values that overflow double count as not converged.
  if (!found.converged() || !is_finite(found)) return unknown("out_of_steps");
  return {{"converged", {}, {true, {}}},
          {"reason", {}, {std::string("converged"), {}}},
          {"tip", {}, pose_node(found.tip)},
          {"tensions", {}, numbers(found.tensions)},
          {"displacements", {}, numbers(found.displacements)},
          {"strain_energy", {}, {found.strain_energy, {}}},
          {"stable", {}, {found.stable, {}}},
          {"snapped", {}, {found.snapped, {}}},
          {"ambiguous", {}, {found.ambiguous, {}}}};
}

// What is left between the target and what was found.
void add_residual(const InverseStaticsResult& result, const StaticsTarget& target, Node::Table& members) {
  members.push_back({"reached", {}, {result.reached(), {}}});
  if (!result.reached()) members.push_back({"why_not", {}, {result.problem, {}}});
  members.push_back({"residual", {}, {result.position_error, {}}});
  if (target.direction || target.rotation)
    members.push_back({"residual_angle", {}, {result.angle_error, {}}});
}

Node error_node(std::string problem) { return {Node::Table{{"error", {}, {std::move(problem), {}}}}, {}}; }

}  // namespace

StaticsAnswers::StaticsAnswers(const ArmConfig& arm, const std::optional<DriveConfig>& drive)
    : rod_(rod_of(arm, drive)), loads_(loads_of(arm)), statics_(rod_) {}

std::string StaticsAnswers::problem(std::string_view line) const {
  try {
    (void)read_request(rod_, line);
    return {};
  } catch (const InputError& error) {
    return joined(error.problems());
  }
}

InverseStaticsResult StaticsAnswers::aimed(const StaticsTarget& target, const RodLoads& loads) {
  const std::vector<double> most(rod_.tendons.size(), target.most_tension);
  if (!target.shape) return solve_inverse_statics(statics_, target.target(rod_), loads, most);
  RodStatics statics(rod_, target.places(rod_));
  return solve_inverse_statics(statics, target.target(rod_), loads, most);
}

std::string StaticsAnswers::answer(std::string_view line) {
  try {
    const StaticsRequest request = read_request(rod_, line);
    std::vector<RodPlace> places;
    for (const double s : request.at.value_or(std::vector<double>{})) places.push_back(place_along(rod_, s));
    std::optional<InverseStaticsResult> inverse;
    if (request.target) inverse = aimed(*request.target, request.loads(rod_, loads_));
    const Equilibrium found =
        inverse ? inverse->equilibrium : statics_.solve(request.tendons(), request.loads(rod_, loads_));
    if (found.end == StaticsEnd::bad_input) return write_json(error_node(found.problem));
    Node::Table members = answer_of(found);
    const bool has_answer = members.size() > 2;
    if (inverse && has_answer) add_residual(*inverse, *request.target, members);
    if (has_answer && request.at) {
      RodChain chain(rod_, places);
      chain.place(found.q);
      members.push_back({"at", {}, place_nodes(chain, places)});
    }
    if (has_answer && found.coarse_section)
      members.push_back(
          {"note",
           {},
           {fmt::format("section {}: strongly bent between its guide disks; for an error below 1e-3 of the "
                        "length, increase material.modes.bend or the number of disks",
                        *found.coarse_section + 1),
            {}}});
    return write_json({std::move(members), {}});
  } catch (const InputError& error) {
    return write_json(error_node(joined(error.problems())));
  }
}

}  // namespace flexura
