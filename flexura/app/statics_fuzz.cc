// Any bytes as the input of `flexura statics`, on a stiff arm under its own tendons and a soft one under a
// drive's: for each line, one line of JSON without NaN. Of inputs with a line that can be answered one in ten
// is, for an equilibrium takes a hundred times as long as all else, and one in 500 with a target, which takes
// some hundred equilibria.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

#include "flexura/app/json_lines.h"
#include "flexura/app/statics.h"
#include "flexura/store/json.h"

namespace {

using namespace flexura;

// Short enough that inputs can exceed it.
constexpr std::size_t longest = 1000;
// Number of lines of an input to answer.
constexpr std::size_t most_lines = 8;

ArmConfig arm_of(ModesConfig modes, double youngs_modulus) {
  ArmConfig arm;
  arm.kind = ArmKind::spatial;
  arm.section.resize(2);
  for (Section& section : arm.section) {
    section.length = 0.2;
    section.material = MaterialConfig{.youngs_modulus = youngs_modulus,
                                      .density = 6000,
                                      .radius = std::array{0.7e-3, 0.5e-3},
                                      .modes = modes,
                                      .nodes = 5};
  }
  return arm;
}

StaticsAnswers stiff_arm() {
  ArmConfig arm = arm_of({.shear = 1, .stretch = 1, .bend = 2, .twist = 1}, 54e9);
  arm.tendon = {{.section = 1, .radius = 0.01}, {.section = 2, .radius = 0.01, .angle = 2, .turns = 0.5}};
  arm.section[1].material->rest_bend = {0.3, 0.1};
  return {arm, std::nullopt};
}

StaticsAnswers soft_arm() {
  ArmConfig arm = arm_of({.shear = 0, .stretch = 1, .bend = 2, .twist = 0}, 1e7);
  arm.gravity = {0, -9.81, 0};
  DriveConfig drive;
  drive.disks = 2;
  for (const int section : {1, 2}) {
    TendonConfig& tendon = drive.tendon.emplace_back();
    tendon.section = section;
    tendon.angle = 1.0 * section;
  }
  return {arm, drive};
}

void check_statics(std::string_view text, std::string_view line) {
  const Node node = parse_json(text, "answer");
  const Node* error = node.find("error");
  const Node* converged = node.find("converged");
  if ((converged == nullptr) == (error == nullptr)) std::abort();
  if (error != nullptr) return;
  if (text.find("null") != std::string_view::npos || line.size() > longest) std::abort();
  if ((node.find("tip") != nullptr) != *converged->as<bool>()) std::abort();
  const Node* residual = node.find("residual");
  if ((residual != nullptr) != (node.find("reached") != nullptr)) std::abort();
  if (residual != nullptr && !(*residual->as<double>() >= 0)) std::abort();
}

// Returns the text before the next line end and removes both from `text`.
std::string_view take_text_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

bool has_answer(const StaticsAnswers& answers, std::string_view input) {
  while (!input.empty())
    if (answers.problem(take_text_line(input)).empty()) return true;
  return false;
}

void check_statics_input(StaticsAnswers& answers, std::string_view input) {
  const std::size_t of = input.find("target") == std::string_view::npos ? 10 : 500;
  if (std::hash<std::string_view>{}(input) % of != 0 && has_answer(answers, input)) return;
  std::istringstream in{std::string(input)};
  std::ostringstream out;
  answer_lines([&](std::string_view line) { return answers.answer(line); }, in, out, longest);
  const std::string all = out.str();
  std::string_view given = all;
  while (!input.empty()) {
    const std::string_view line = take_text_line(input);
    if (given.empty()) std::abort();
    check_statics(take_text_line(given), line);
  }
  if (!given.empty()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static StaticsAnswers stiff = stiff_arm();
  static StaticsAnswers soft = soft_arm();
  std::string_view input(reinterpret_cast<const char*>(data), size);
  std::string_view rest = input;
  for (std::size_t i = 0; i < most_lines; ++i) (void)take_text_line(rest);
  input.remove_suffix(rest.size());
  check_statics_input(stiff, input);
  check_statics_input(soft, input);
  return 0;
}
