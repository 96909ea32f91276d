#pragma once

#include <string>
#include <vector>

namespace flexura {

/// Returns the addresses of this machine's active interfaces as texts, in the system's order; empty if the
/// system does not provide them.
[[nodiscard]] std::vector<std::string> own_addresses();

/// Returns an address by which other machines reach this machine, for a server that listens on all addresses.
/// The result is the first address in `addresses` of the required kind (IPv6 if `v6`, otherwise IPv4) that is
/// reachable from outside and needs no interface name. Returns "127.0.0.1" if there is no such address.
[[nodiscard]] std::string outward_address(const std::vector<std::string>& addresses, bool v6);

}  // namespace flexura
