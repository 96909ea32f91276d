// Any bytes as a line of `flexura fk`, on a planar and a spatial arm: always one line of JSON without NaN.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "flexura/app/forward.h"
#include "flexura/store/json.h"

namespace {

flexura::Arm arm_of(flexura::ArmKind kind) {
  flexura::Arm arm;
  arm.kind = kind;
  arm.sections.resize(3);
  return arm;
}

void check_answer(const std::string& answer) {
  if (answer.find('\n') != std::string::npos) std::abort();
  const flexura::Node node = flexura::parse_json(answer, "answer");
  if ((node.find("tip") == nullptr) == (node.find("error") == nullptr)) std::abort();
  if (answer.find("null") != std::string::npos && node.find("error") == nullptr) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const flexura::Arm planar = arm_of(flexura::ArmKind::planar);
  static const flexura::Arm spatial = arm_of(flexura::ArmKind::spatial);
  const std::string_view line(reinterpret_cast<const char*>(data), size);
  check_answer(flexura::answer_forward(planar, line));
  check_answer(flexura::answer_forward(spatial, line));
  return 0;
}
