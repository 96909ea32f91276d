#pragma once

#include <string>

namespace flexura {

/// Returns the absolute path of a file of the checkout under test, given its path in the checkout.
std::string checkout_file(const std::string& path);
/// Returns the absolute path of a built file.
std::string built_file(const std::string& path);

}  // namespace flexura
