#include "tests/support/checkout.h"

#include <string>

namespace flexura {

// The one source that is compiled otherwise in each checkout: what ccache has of all others serves every one.
std::string checkout_file(const std::string& path) { return FLEXURA_SOURCE_DIR "/" + path; }
std::string built_file(const std::string& path) { return FLEXURA_BINARY_DIR "/" + path; }

}  // namespace flexura
