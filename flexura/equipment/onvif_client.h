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

/// What a client needs from its surroundings. Tests replace them.
struct OnvifPorts {
  std::function<Outcome<std::unique_ptr<Link>>()> connect;  ///< Opens a connection to the camera.
  std::function<double()> now;                              ///< Steady time, s.
};

/// A camera's clock and login. It signs requests. All functions may be called from several threads.
class OnvifLogin {
 public:
  OnvifLogin(std::string user, std::string password);

  /// Takes the camera's time, s since 1970, at the steady time `now`.
  void set_clock(double camera_time, double now);
  /// Returns a token for one request; std::nullopt without a login. Its time is that of the camera's clock.
  [[nodiscard]] std::optional<OnvifToken> token(double now) const;

 private:
  std::string user_, password_;
  mutable std::mutex mutex_;
  std::optional<double> offset_;  // Camera's time minus steady time.
};

/// Sends requests to an ONVIF camera over one kept connection and takes the answers. A connection that the
/// camera has closed is opened again. All waiting has a limit. Not for several threads at once.
class OnvifClient {
 public:
  /// An answer.
  struct Answer {
    std::string soap;
    double time = 0;  ///< Steady time of its arrival.
  };
  /// A request. `name`: for messages, such as "GetStatus".
  struct Request {
    std::string_view name, path, body;
    bool is_signed = true;
  };

  /// `login` is shared with other clients of the camera.
  OnvifClient(OnvifPorts ports, const OnvifConfig& config, std::shared_ptr<OnvifLogin> login);

  /// Returns the answer, or a fault with one line. `is_wanted`: whether to send the request (again); else the
  /// fault is `refused`.
  [[nodiscard]] Outcome<Answer> call(const Request& request, const std::function<bool()>& is_wanted = {});
  /// Asks the camera for its time, for the login.
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
/// Returns the host and port for headers of requests.
[[nodiscard]] std::string onvif_host(const OnvifConfig& config);

}  // namespace flexura
