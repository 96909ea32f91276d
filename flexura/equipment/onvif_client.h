#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "flexura/equipment/link.h"
#include "flexura/equipment/onvif_config.h"
#include "flexura/port/outcome.h"

namespace flexura {

/// Functions of the environment that a client calls. Tests replace them.
struct OnvifPorts {
  std::function<Outcome<std::unique_ptr<Link>>()> connect;  ///< Opens a connection to the camera.
  std::function<double()> now;                              ///< Steady time, s.
};

/// Login to a camera, with the time of the camera's clock. An OnvifLogin makes the signatures of requests.
/// All functions may be called from several threads.
class OnvifLogin {
 public:
  OnvifLogin(std::string user, std::string password);

  /// Stores that the camera's clock shows a time, s since 1970, at the steady time `now`, s.
  void set_clock(double camera_time, double now);
  /// Returns the signature (token) for one request; std::nullopt without a login. The token contains the time
  /// of the camera's clock.
  [[nodiscard]] std::optional<OnvifToken> token(double now) const;

 private:
  std::string user_, password_;
  mutable std::mutex mutex_;
  std::optional<double> offset_;  // Camera's time minus steady time.
};

/// Sends requests to an ONVIF camera over one permanent connection, and receives the answers. If the camera
/// closes the connection, the client opens it again. All waits have a timeout. Only one thread at a time may
/// use a client.
class OnvifClient {
 public:
  /// An answer.
  struct Answer {
    std::string soap;
    double time = 0;  ///< Steady time at which the answer arrived, s.
  };
  /// A request. `name`: name for messages, such as "GetStatus".
  struct Request {
    std::string_view name, path, body;
    bool is_signed = true;
  };

  /// `login` is shared with other clients of the camera.
  OnvifClient(OnvifPorts ports, const OnvifConfig& config, std::shared_ptr<OnvifLogin> login);

  /// Sends a request. Returns the answer, or a fault with one line. `is_wanted`: returns whether the request
  /// may still be sent; if not, the fault is `refused`.
  [[nodiscard]] Outcome<Answer> call(const Request& request, const std::function<bool()>& is_wanted = {});
  /// Asks the camera for the time of its clock, which the login needs.
  [[nodiscard]] CommandOutcome ask_clock();

 private:
  struct Trial;
  [[nodiscard]] Trial try_once(const Request& request);
  [[nodiscard]] Trial exchange(const std::string& message);
  [[nodiscard]] Trial judged(const Request& request, Trial trial) const;
  [[nodiscard]] std::string problem(const Request& request, std::string_view what) const;

  OnvifPorts ports_;
  OnvifConfig config_;
  std::string name_, host_;
  std::shared_ptr<OnvifLogin> login_;
  std::unique_ptr<Link> link_;
};

/// Returns the camera's name for messages.
[[nodiscard]] std::string onvif_name(const OnvifConfig& config);
/// Returns the host and port, as in headers of requests.
[[nodiscard]] std::string onvif_host(const OnvifConfig& config);

}  // namespace flexura
