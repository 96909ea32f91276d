#include "flexura/view/condition.h"

#include "flexura/base/node.h"
#include "flexura/store/json.h"

namespace flexura {

const char* name_of(Condition condition) {
  switch (condition) {
    case Condition::idle:
      return "idle";
    case Condition::moving:
      return "moving";
    case Condition::running:
      return "running";
    case Condition::done:
      return "done";
    case Condition::halted:
      return "halted";
    case Condition::failed:
      return "failed";
    case Condition::unsafe:
      break;
  }
  return "unsafe";
}

Condition condition_after(const std::string& outcome) {
  if (outcome == "done") return Condition::done;
  if (outcome == "unsafe") return Condition::unsafe;
  if (outcome == "failed") return Condition::failed;
  return outcome == "cancelled" ? Condition::halted : Condition::idle;
}

std::string condition_message(const Conditioned& conditioned) {
  return write_json({Node::Table{{"type", {}, text_node("condition")},
                                 {"condition", {}, text_node(name_of(conditioned.condition))},
                                 {"text", {}, text_node(conditioned.text)}},
                     {}});
}

}  // namespace flexura
