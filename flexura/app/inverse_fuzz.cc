// Fuzzes a line of `flexura ik` with any bytes, on a planar and a spatial arm. Each must give an error or no
// error. One input in fifty, chosen by its bytes, is also solved, as solving takes a thousand times as long
// as reading. It must give one line of JSON without NaN, and a solution within the limits.
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <string>
#include <string_view>

#include "flexura/app/inverse.h"
#include "flexura/store/json.h"

namespace {

flexura::Arm arm_of(flexura::ArmKind kind) {
  flexura::Arm arm;
  arm.kind = kind;
  arm.sections.resize(2);
  for (flexura::Section& section : arm.sections) section.max_bend = 2.0;
  if (kind == flexura::ArmKind::spatial) arm.sections[1].stretch_limits = {0.8, 1.2};
  return arm;
}

void check_answer(const std::string& answer) {
  if (answer.find('\n') != std::string::npos) std::abort();
  const flexura::Node node = flexura::parse_json(answer, "answer");
  const flexura::Node* converged = node.find("converged");
  if ((converged == nullptr) == (node.find("error") == nullptr)) std::abort();
  if (converged == nullptr) return;
  if (answer.find("null") != std::string::npos) std::abort();
  if (*converged->as<bool>() == (node.find("distance") != nullptr)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const flexura::Arm planar = arm_of(flexura::ArmKind::planar);
  static const flexura::Arm spatial = arm_of(flexura::ArmKind::spatial);
  const std::string_view line(reinterpret_cast<const char*>(data), size);
  const bool can_answer =
      flexura::inverse_problem(planar, line).empty() && flexura::inverse_problem(spatial, line).empty();
  if (std::hash<std::string_view>{}(line) % 50 != 0 && can_answer) return 0;
  check_answer(flexura::answer_inverse(planar, line));
  check_answer(flexura::answer_inverse(spatial, line));
  return 0;
}
