#include "flexura/serve/own_address.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <memory>

namespace flexura {
namespace {

// Returns the address of an interface, or "" if it has no Internet address.
std::string text_of(const sockaddr* address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  const void* bytes = nullptr;
  if (address == nullptr) return "";
  if (address->sa_family == AF_INET) bytes = &reinterpret_cast<const sockaddr_in*>(address)->sin_addr;
  if (address->sa_family == AF_INET6) bytes = &reinterpret_cast<const sockaddr_in6*>(address)->sin6_addr;
  if (bytes == nullptr) return "";
  return ::inet_ntop(address->sa_family, bytes, text.data(), text.size()) == nullptr ? "" : text.data();
}

bool leads_out(const std::string& address) {
  // Link-local addresses (fe80::/10, 169.254/16) were not assigned to the machine.
  constexpr std::array inner = {"127.", "::1", "fe8", "fe9", "fea", "feb", "169.254."};
  return std::ranges::none_of(inner, [&](const char* start) { return address.starts_with(start); });
}

}  // namespace

std::vector<std::string> own_addresses() {
  ifaddrs* list = nullptr;
  if (::getifaddrs(&list) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> kept(list, ::freeifaddrs);
  std::vector<std::string> addresses;
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    const std::string text = text_of(entry->ifa_addr);
    if (!text.empty() && (entry->ifa_flags & IFF_UP) != 0) addresses.push_back(text);
  }
  return addresses;
}

std::string outward_address(const std::vector<std::string>& addresses, bool v6) {
  const auto found = std::ranges::find_if(addresses, [&](const std::string& address) {
    return (address.find(':') != std::string::npos) == v6 && leads_out(address);
  });
  return found == addresses.end() ? "127.0.0.1" : *found;
}

}  // namespace flexura
