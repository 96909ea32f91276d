#pragma once

#include <string>
#include <vector>

namespace flexura {

/// The addresses of this machine's interfaces that are up, as texts, in the system's order; none where it
/// does not tell.
[[nodiscard]] std::vector<std::string> own_addresses();

/// By which of a machine's addresses another one may call it that listens on all of them: the first of the
/// same kind (IPv6 or not) that leads out of it and needs no name of an interface. "127.0.0.1" where there is
/// none.
[[nodiscard]] std::string outward_address(const std::vector<std::string>& addresses, bool v6);

}  // namespace flexura
