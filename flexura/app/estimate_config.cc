#include "flexura/app/estimate_config.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <system_error>
#include <utility>

#include "flexura/app/estimate_guess.h"
#include "flexura/base/source.h"
#include "flexura/base/table.h"
#include "flexura/experiment/experiment.h"

namespace flexura {
namespace {

// Largest coordinate: pictures of anything beyond are useless.
constexpr double farthest_place = 1e6;  // m

// Returns the value of `key` in a camera's table, in any unit; nullptr if it is omitted.
const Node* written_at(const Node& camera, std::string_view key) {
  const auto& members = *camera.as<Node::Table>();
  const auto found = std::ranges::find_if(
      members, [&](const Node::Member& member) { return without_unit(member.key) == key; });
  return found == members.end() ? nullptr : &found->node;
}

bool stand_at_one_place(const std::vector<MeasuredCamera>& cameras) {
  constexpr double near = 1e-6;  // m
  return std::ranges::all_of(cameras, [&](const MeasuredCamera& camera) {
    return (camera.pose().position - cameras[0].pose().position).norm() < near;
  });
}

// Requires a position and rotation for each camera. Measuring one picture needs only the lens, but
// triangulation needs the poses.
void check_poses(const Node& file, const std::vector<MeasuredCamera>& cameras) {
  std::vector<Problem> problems;
  const auto& tables = *file.find("camera")->as<Node::Array>();
  for (std::size_t i = 0; i < tables.size(); ++i) {
    for (const std::string_view key : {"position", "rotation"})
      if (written_at(tables[i], key) == nullptr)
        problems.push_back({tables[i].where,
                            fmt::format("camera[{}].{}: missing: expected the pose of each camera", i, key)});
    const Node* position = written_at(tables[i], "position");
    if (position == nullptr) continue;
    const Eigen::Vector3d p_WC = cameras[i].pose().position;
    if (!(p_WC.cwiseAbs().maxCoeff() <= farthest_place))
      problems.push_back(
          {position->where, fmt::format("camera[{}].position: expected within {:g} m", i, farthest_place)});
    else if (i + 1 == tables.size() && i > 0 && stand_at_one_place(cameras))
      problems.push_back(
          {position->where,
           fmt::format(
               "camera[{}].position: equals that of camera[0]: expected cameras at different positions", i)});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

std::optional<Eigen::Vector3d> base_of(const EstimateArguments& arguments) {
  if (arguments.base.empty()) return std::nullopt;
  return Eigen::Vector3d(arguments.base.data());
}

// Fixes the length of an arm that may stretch. All sections get the same stretch, within the limits of each.
void hold_length(double length, ShapePrior& prior) {
  if (prior.is_length_known) throw input_error("--length", "--arm already gives the arm's length");
  double shortest = 0, longest = std::numeric_limits<double>::infinity();
  for (const Section& section : prior.arm.sections) {
    shortest = std::max(shortest, section.stretch_limits[0] * prior.arm.length());
    longest = std::min(longest, section.stretch_limits[1] * prior.arm.length());
  }
  constexpr double grace = 1e-9;  // Rounding of sums taken in another order.
  if (length < (1 - grace) * shortest || length > (1 + grace) * longest)
    throw input_error("--length", fmt::format("{} m: expected {:.6g} to {:.6g} m, the range if all sections "
                                              "of --arm stretch by the same factor",
                                              length, shortest, longest));
  const double stretch = length / prior.arm.length();
  for (Section& section : prior.arm.sections) section.length *= stretch;
  prior.is_length_known = true;
}

ShapePrior arm_of(const EstimateArguments& arguments) {
  const auto base = base_of(arguments);
  if (arguments.arm.empty()) return unknown_arm(base, arguments.length);
  ShapePrior prior = described_arm(load_experiment(arguments.arm).arm_model().shaped());
  if (arguments.length) hold_length(*arguments.length, prior);
  if (base) prior.arm.X_WB.position = *base;
  return prior;
}

// Returns the arc length, m, along the unstretched arm, for "0.25" (m) or "25%" (of the arm's length).
double marker_place(const std::string& word, const ShapePrior& prior, bool is_described) {
  const bool is_share = word.ends_with('%');
  const std::string digits = word.substr(0, word.size() - (is_share ? 1 : 0));
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value))
    throw input_error(
        "--markers",
        fmt::format("\"{}\": expected arc lengths in m, or shares of the length such as \"25%\"", word));
  if (!is_share && !is_described && !prior.is_length_known)
    throw input_error("--markers", fmt::format("{} m, but the arm's length is unknown: expected --length, "
                                               "--arm, or shares of the length such as \"25%\"",
                                               word));
  constexpr double percent = 0.01;
  const double s = is_share ? percent * value * prior.arm.length() : value;
  const bool is_on_arm = s >= 0 && s <= prior.arm.length();
  if (!is_on_arm) throw input_error("--markers", fmt::format("\"{}\" is not on the arm", word));
  return s;
}

}  // namespace

void check_arguments(const EstimateArguments& arguments) {
  if (arguments.images.size() < 2)
    throw input_error("IMAGE", "expected at least two pictures, one of each camera");
  for (const double x : arguments.base)
    if (!(std::abs(x) <= farthest_place))
      throw input_error("--base", fmt::format("expected three numbers x,y,z within {:g} m", farthest_place));
  const auto is_size = [](double x) { return x > 0 && x <= farthest_place; };
  if (arguments.length && !is_size(*arguments.length))
    throw input_error("--length", fmt::format("{} m: expected a number above 0, at most {:g}",
                                              *arguments.length, farthest_place));
  if (arguments.guess.empty() && arguments.guess_std)
    throw input_error("--guess-std", "expected --guess, too");
  if (!arguments.guess.empty()) {
    if (arguments.arm.empty())
      throw input_error("--guess", "expected also --arm: the guess has one bend per section of the arm");
    if (!arguments.markers.empty())
      throw input_error("--guess", "--markers is not used with a guess: expected only one of them");
    if (arguments.threshold.method || arguments.threshold.level || !arguments.threshold.figure.empty())
      throw input_error("--guess", "no threshold is used with a guess: expected no option of the threshold");
    constexpr double widest = 1;
    const auto is_possible = [](double std) { return std > 0 && std <= widest; };
    if (arguments.guess_std && !is_possible(*arguments.guess_std))
      throw input_error("--guess-std", fmt::format("{} rad: expected a number above 0, at most {:g}",
                                                   *arguments.guess_std, widest));
  }
  constexpr std::int64_t most = 100000;
  if (arguments.points < 2 || arguments.points > most)
    throw input_error("--points", fmt::format("{}: expected 2 to {}", arguments.points, most));
}

EstimateConfig estimate_config(const EstimateArguments& arguments) {
  EstimateConfig config;
  config.prior = arm_of(arguments);
  auto& markers = config.prior.markers;
  const bool is_described = !arguments.arm.empty();
  for (const std::string& word : arguments.markers)
    markers.push_back(marker_place(word, config.prior, is_described));
  std::ranges::sort(markers);
  // Tolerance for one place given both in metres and in percent: rounding only.
  const double alike = 1e-9 * config.prior.arm.length();
  const auto is_alike = [&](double one, double next) { return next - one <= alike; };
  if (const auto twice = std::ranges::adjacent_find(markers, is_alike); twice != markers.end())
    throw input_error(
        "--markers",
        fmt::format("two markers are at {:.9g} times the arm's length: expected different positions",
                    *twice / config.prior.arm.length()));
  config.threshold = threshold_config(arguments.threshold);
  config.points = static_cast<std::size_t>(arguments.points);
  config.has_bends = is_described;
  if (!arguments.guess.empty()) config.guess = read_guess(arguments.guess, config.prior.arm);
  if (arguments.guess_std) config.guess_std = *arguments.guess_std;
  return config;
}

std::vector<MeasuredCamera> standing_cameras(const Node& file, std::size_t count) {
  auto cameras = read_as<MeasuredCameras>(file).camera;
  check_poses(file, cameras);
  if (cameras.size() != count)
    throw InputError({{file.find("camera")->where,
                       fmt::format("camera: {} cameras for {} pictures: expected one camera per picture",
                                   cameras.size(), count)}});
  return cameras;
}

}  // namespace flexura
