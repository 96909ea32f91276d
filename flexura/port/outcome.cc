#include "flexura/port/outcome.h"

namespace flexura {

std::string text(const PortFault& fault) {
  return (fault.kind == FaultKind::link_lost ? "link lost: " : "refused: ") + fault.what;
}

}  // namespace flexura
