#include "flexura/base/version.h"

namespace flexura {

std::string_view version() { return FLEXURA_VERSION; }

}  // namespace flexura
