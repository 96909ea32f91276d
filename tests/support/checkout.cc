#include "tests/support/checkout.h"

#include <string>

namespace flexura {

// Only this source depends on the location of the checkout, so ccache can share all others between checkouts.
std::string checkout_file(const std::string& path) { return FLEXURA_SOURCE_DIR "/" + path; }
std::string built_file(const std::string& path) { return FLEXURA_BINARY_DIR "/" + path; }

}  // namespace flexura
