#pragma once

#include <string>

namespace flexura {

/// The path of a file of the checkout under test, by its path there.
std::string checkout_file(const std::string& path);
/// And of one that was built.
std::string built_file(const std::string& path);

}  // namespace flexura
