// A simulated ONVIF camera for clients that others wrote (tests/peers/README.md).
//
//   onvif_peer [SECONDS [PORT]]
//
// Prints the port, serves until its input ends or SECONDS (default 60) have passed, then prints one line with
// the numbers of executed requests and one with the position. With a PORT other than 0 it is for
// libonvif, which finds cameras by WS-Discovery only and uses a signature more than once.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <string_view>

#include "flexura/equipment/onvif_server.h"
#include "flexura/equipment/wall_clock.h"

namespace {

using namespace flexura;

// A socket that hears probes, or none.
Descriptor discovery() {
  Descriptor made(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in place{};
  constexpr std::uint16_t port = 3702;
  place.sin_family = AF_INET, place.sin_addr.s_addr = htonl(INADDR_ANY), place.sin_port = htons(port);
  ip_mreqn group{};
  ::inet_pton(AF_INET, "239.255.255.250", &group.imr_multiaddr);
  const int yes = 1;
  (void)::setsockopt(made.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (::bind(made.get(), reinterpret_cast<const sockaddr*>(&place), sizeof place) != 0 ||
      ::setsockopt(made.get(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group) != 0)
    fmt::print(stderr, "no discovery\n");
  return made;
}

// Answers a probe with the camera's address.
void answer_probe(int socket, const std::string& host) {
  std::string probe(8192, '\0');
  sockaddr_in sender{};
  socklen_t size = sizeof sender;
  const ssize_t got = ::recvfrom(socket, probe.data(), probe.size(), MSG_DONTWAIT,
                                 reinterpret_cast<sockaddr*>(&sender), &size);
  if (got <= 0) return;
  probe.resize(static_cast<std::size_t>(got));
  const std::size_t name = probe.find("MessageID"), begin = probe.find('>', name) + 1,
                    end = probe.find('<', begin);
  if (name == std::string::npos || end == std::string::npos) return;
  const std::string answer = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>"
      "<s:Envelope xmlns:s=\"http://www.w3.org/2003/05/soap-envelope\" "
      "xmlns:a=\"http://schemas.xmlsoap.org/ws/2004/08/addressing\" "
      "xmlns:d=\"http://schemas.xmlsoap.org/ws/2005/04/discovery\"><s:Header>"
      "<a:MessageID>urn:uuid:00000000-0000-4000-8000-000000000001</a:MessageID><a:RelatesTo>{}</a:RelatesTo>"
      "<a:To>http://schemas.xmlsoap.org/ws/2004/08/addressing/role/anonymous</a:To>"
      "<a:Action>http://schemas.xmlsoap.org/ws/2005/04/discovery/ProbeMatches</a:Action></s:Header>"
      "<s:Body><d:ProbeMatches><d:ProbeMatch><a:EndpointReference>"
      "<a:Address>urn:uuid:00000000-0000-4000-8000-000000000002</a:Address></a:EndpointReference>"
      "<d:Types>dn:NetworkVideoTransmitter</d:Types>"
      "<d:Scopes>onvif://www.onvif.org/name/Simulated onvif://www.onvif.org/hardware/camera</d:Scopes>"
      "<d:XAddrs>http://{}/onvif/device_service</d:XAddrs><d:MetadataVersion>1</d:MetadataVersion>"
      "</d:ProbeMatch></d:ProbeMatches></s:Body></s:Envelope>",
      probe.substr(begin, end - begin), host);
  (void)::sendto(socket, answer.data(), answer.size(), 0, reinterpret_cast<const sockaddr*>(&sender), size);
}

}  // namespace

int main(int argc, char** argv) try {
  const double duration = argc > 1 ? std::strtod(argv[1], nullptr) : 60;
  const auto port = static_cast<std::uint16_t>(argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 0);
  OnvifModel model;
  const double utc =
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  model.epoch = utc - steady_seconds();
  model.most_age = 60;
  model.refuses_replays = port == 0;
  OnvifDevice device(model);
  OnvifServer server(device, port);
  const Descriptor probes = port != 0 ? discovery() : Descriptor();
  fmt::print("{}\n", server.port());
  std::fflush(stdout);
  std::array<pollfd, 2> events{{{STDIN_FILENO, POLLIN, 0}, {probes.get(), POLLIN, 0}}};
  for (const double end = steady_seconds() + duration; steady_seconds() < end;) {
    constexpr int tick = 100;  // ms
    if (::poll(events.data(), events.size(), tick) <= 0) continue;
    if (events[1].revents != 0) answer_probe(probes.get(), device.model().host);
    std::array<char, 100> heard{};
    if (events[0].revents != 0 && ::read(STDIN_FILENO, heard.data(), heard.size()) <= 0) break;
  }
  const auto lock = server.lock();
  std::string line = "executed";
  for (const char* name :
       {"AbsoluteMove", "ContinuousMove", "Stop", "GetStatus", "GetProfiles", "GetDeviceInformation"})
    line += fmt::format(" {} {}", name, device.executed(name));
  const OnvifPlace at = device.place(steady_seconds());
  fmt::print("{}\nposition {:.3f} {:.3f} {:.3f}\n", line, at.pan, at.tilt, at.zoom.value_or(0));
  return 0;
} catch (const std::exception& problem) {
  fmt::print(stderr, "onvif_peer: {}\n", problem.what());
  return 1;
}
