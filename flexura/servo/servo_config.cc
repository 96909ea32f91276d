#include "flexura/servo/servo_config.h"

namespace flexura {

const std::vector<std::string>& names_of(const ServoLawKind*) {
  static const std::vector<std::string> names = {"shape",   "points",    "chords",
                                                 "moments", "potential", "silhouettes"};
  return names;
}

const std::vector<std::string>& names_of(const ServoMeasure*) {
  static const std::vector<std::string> names = {"picture", "flow"};
  return names;
}

const std::vector<std::string>& names_of(const ServoJacobian*) {
  static const std::vector<std::string> names = {"model", "broyden", "recursive"};
  return names;
}

}  // namespace flexura
