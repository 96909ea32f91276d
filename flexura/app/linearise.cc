#include "flexura/app/linearise.h"

#include <fmt/format.h>

#include <array>
#include <complex>
#include <stdexcept>
#include <utility>
#include <vector>

#include "flexura/app/rod_request.h"
#include "flexura/base/problems.h"
#include "flexura/log/messages.h"
#include "flexura/mechanics/arm_rod.h"
#include "flexura/mechanics/rod_modes.h"
#include "flexura/store/json.h"

namespace flexura {
namespace {

const Table<RodRequest>& fields_of(const RodRequest*) {
  static const auto table = [] {
    Table<RodRequest> made("linearise request",
                           "Forces on the arm at the equilibrium about which the motion is linearised.");
    add_rod_fields(made);
    return made;
  }();
  return table;
}

RodRequest read_linearise_request(const Rod& rod, std::string_view line) {
  const Node document = parse_json(line, "");
  Reader reader;
  RodRequest request;
  if (fields_of(static_cast<const RodRequest*>(nullptr)).read(document, reader, request))
    check_rod_request(rod, request, reader);
  reader.throw_if_any();
  return request;
}

Node matrix_node(const Eigen::MatrixXd& matrix) {
  Node::Array rows;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    Node::Array row;
    for (const double value : matrix.row(i)) row.push_back(number_node(value + 0.0));  // No -0.
    rows.push_back({std::move(row), {}});
  }
  return {std::move(rows), {}};
}

Node list_node(const std::vector<double>& values) {
  Node::Array entries;
  for (const double value : values) entries.push_back(number_node(value));
  return {std::move(entries), {}};
}

Node eigenvalues_node(const Eigen::VectorXcd& values) {
  Node::Array entries;
  for (const std::complex<double>& value : values)
    entries.push_back({Node::Array{number_node(value.real() + 0.0), number_node(value.imag() + 0.0)}, {}});
  return {std::move(entries), {}};
}

// Returns the names of the states. "q.1.curvature_x.0" is the constant part of the first section's curvature
// about x, "q.1.2.curvature_x.0" that of its second piece between guide disks; "v..." is its rate.
Node state_names(const RodChain& chain) {
  constexpr std::array strains = {"shear_x", "shear_y", "stretch", "curvature_x", "curvature_y", "twist"};
  std::vector<std::string> modes(static_cast<std::size_t>(chain.size()));
  int piece = 0;
  for (std::size_t i = 0; i < chain.elements().size(); ++i) {
    const RodPart& part = chain.elements()[i].part();
    std::string where = std::to_string(part.section + 1);
    if (part.begin == 0) piece = 0;
    if (part.begin > 0 || !part.is_last) where += fmt::format(".{}", ++piece);
    int order = 0, before = -1;
    chain.elements()[i].grid().for_modes([&](int strain, int mode) {
      order = strain == before ? order + 1 : 0;
      before = strain;
      modes[static_cast<std::size_t>(chain.first(i) + mode)] =
          fmt::format("{}.{}.{}", where, strains[static_cast<std::size_t>(strain)], order);
    });
  }
  std::vector<std::string> names;
  for (const char* kind : {"q", "v"})
    for (const std::string& mode : modes) names.push_back(fmt::format("{}.{}", kind, mode));
  return texts_node(names);
}

Node input_names(std::size_t tendons, bool by_displacement) {
  std::vector<std::string> names;
  names.reserve(tendons);
  for (std::size_t i = 0; i < tendons; ++i)
    names.push_back(fmt::format("{}.{}", by_displacement ? "displacement" : "tension", i + 1));
  return texts_node(names);
}

// Returns the names of the columns of `by_parameters` (dynamics_parameters for each section).
Node section_parameter_names(std::size_t sections) {
  constexpr std::array kinds = {"shear", "stretch", "bends", "twist", "mass", "damping"};
  static_assert(kinds.size() == static_cast<std::size_t>(dynamics_parameters));
  std::vector<std::string> names;
  names.reserve(sections * kinds.size());
  for (std::size_t i = 0; i < sections; ++i)
    for (const char* kind : kinds) names.push_back(fmt::format("{}.{}", kind, i + 1));
  return texts_node(names);
}

Node output_names() {
  return texts_node({"tip.x", "tip.y", "tip.z", "tip.rotation_x", "tip.rotation_y", "tip.rotation_z"});
}

Node::Table not_linearised(const char* reason) {
  return {{"converged", {}, {false, {}}}, {"reason", {}, text_node(reason)}};
}

Node linearise_refusal(std::string problem) {
  return {Node::Table{{"error", {}, text_node(std::move(problem))}}, {}};
}

}  // namespace

LineariseAnswers::LineariseAnswers(const ArmConfig& arm, const std::optional<DriveConfig>& drive)
    : rod_(rod_of(arm, drive)), loads_(loads_of(arm)), statics_(rod_), dynamics_(rod_) {
  for (std::size_t i = 0; i < rod_.tendons.size(); ++i)
    if (rod_.tendons[i].friction > 0)
      throw std::invalid_argument(fmt::format("tendon {}: friction has no linear model", i + 1));
  if (arm.drag) throw std::invalid_argument("arm.drag: expected none, because it is not linearised");
  if (!arm.payload.empty())
    throw std::invalid_argument("arm.payload: expected none, because payloads are not linearised");
}

std::string LineariseAnswers::answer(std::string_view line) {
  try {
    const RodRequest request = read_linearise_request(rod_, line);
    const RodLoads loads = request.loads(rod_, loads_);
    const TendonInput tendons = request.tendons();
    const Equilibrium found = statics_.solve(tendons, loads);
    if (found.end == StaticsEnd::bad_input) return write_json(linearise_refusal(found.problem));
    if (found.end == StaticsEnd::no_equilibrium) return write_json({not_linearised("no_equilibrium"), {}});
    if (found.end == StaticsEnd::disks_meet) return write_json({not_linearised("disks_meet"), {}});
    if (!found.converged() || !found.q.allFinite()) return write_json({not_linearised("out_of_steps"), {}});
    const RodState state = dynamics_.rest(found);
    const RodLinear linear = dynamics_.linearize(state, tendons, loads);
    const RodModes modes = rod_modes(linear.slopes);
    // Values that overflow double count as not converged.
    if (!linear.A_rest.allFinite() || !linear.B_rest.allFinite() || !linear.by_parameters_rest.allFinite() ||
        !modes.eigenvalues.allFinite())
      return write_json({not_linearised("out_of_steps"), {}});
    Eigen::MatrixXd C = Eigen::MatrixXd::Zero(6, linear.A_rest.rows());
    C.leftCols(linear.tip_by_q.cols()) = linear.tip_by_q;
    return write_json(
        {Node::Table{{"converged", {}, {true, {}}},
                     {"reason", {}, text_node("converged")},
                     {"stable", {}, {found.stable, {}}},
                     {"tip", {}, pose_node(found.tip)},
                     {"frequencies_hz", {}, list_node(modes.frequencies)},
                     {"damping_ratios", {}, list_node(modes.damping_ratios)},
                     {"eigenvalues", {}, eigenvalues_node(modes.eigenvalues)},
                     {"states", {}, state_names(dynamics_.chain())},
                     {"inputs", {}, input_names(rod_.tendons.size(), request.displacements.has_value())},
                     {"outputs", {}, output_names()},
                     {"A", {}, matrix_node(linear.A_rest)},
                     {"B", {}, matrix_node(linear.B_rest)},
                     {"C", {}, matrix_node(C)},
                     {"parameters", {}, section_parameter_names(rod_.sections.size())},
                     {"by_parameters", {}, matrix_node(linear.by_parameters_rest)},
                     {"mass", {}, matrix_node(linear.slopes.mass)},
                     {"stiffness", {}, matrix_node(-linear.slopes.force_by_q)},
                     {"damping", {}, matrix_node(-linear.slopes.force_by_v)},
                     {"force_by_inputs", {}, matrix_node(linear.slopes.force_by_input)},
                     {"force_by_parameters", {}, matrix_node(linear.slopes.force_by_parameters)}},
         {}});
  } catch (const InputError& error) {
    return write_json(linearise_refusal(joined(error.problems())));
  } catch (const std::invalid_argument&) {
    // RodDynamics rejects the equilibrium.
    return write_json({not_linearised("out_of_steps"), {}});
  }
}

}  // namespace flexura
