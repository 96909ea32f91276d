// Fuzzes the input of `flexura fk` with any bytes, on a planar and a spatial arm. Each line must give one
// line of JSON without NaN.
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>
#include <string_view>

#include "flexura/app/forward.h"
#include "flexura/app/json_lines.h"
#include "flexura/store/json.h"

namespace {

// Short enough that inputs can exceed it.
constexpr std::size_t longest = 1000;

flexura::Arm arm_of(flexura::ArmKind kind) {
  flexura::Arm arm;
  arm.kind = kind;
  arm.sections.resize(3);
  return arm;
}

void check_answer(std::string_view answer, std::string_view line) {
  const flexura::Node node = flexura::parse_json(answer, "answer");
  const flexura::Node* error = node.find("error");
  if ((node.find("tip") == nullptr) == (error == nullptr)) std::abort();
  if (answer.find("null") != std::string_view::npos && error == nullptr) std::abort();
  if (line.size() > longest && error == nullptr) std::abort();
}

// Returns the text before the next line end and removes both from `text`.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

void check_input(const flexura::Arm& arm, std::string_view input) {
  std::istringstream in{std::string(input)};
  std::ostringstream out;
  flexura::answer_lines([&](std::string_view line) { return flexura::answer_forward(arm, line); }, in, out,
                        longest);
  const std::string all = out.str();
  std::string_view answers = all;
  while (!input.empty()) {
    const std::string_view line = take_line(input);
    if (answers.empty()) std::abort();
    check_answer(take_line(answers), line);
  }
  if (!answers.empty()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const flexura::Arm planar = arm_of(flexura::ArmKind::planar);
  static const flexura::Arm spatial = arm_of(flexura::ArmKind::spatial);
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  check_input(planar, input);
  check_input(spatial, input);
  return 0;
}
