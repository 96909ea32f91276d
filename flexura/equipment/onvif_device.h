#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/equipment/onvif_http.h"
#include "flexura/equipment/onvif_soap.h"

namespace flexura {

/// A simulated ONVIF camera with a head.
struct OnvifModel {
  std::string user = "operator",
              password = "secret";  ///< Login of the camera; empty user: no login is needed.
  OnvifRange pan = {-1, 1}, tilt = {-1, 1}, zoom = {0, 1};  ///< Ranges in the generic position space.
  /// Angles at the ends of the ranges of pan and tilt, degrees.
  OnvifRange pan_degrees = {-180, 180}, tilt_degrees = {-90, 90};
  std::array<double, 3> rates = {0.5, 0.5,
                                 0.5};  ///< Highest speeds of pan, tilt and zoom, generic positions/s.
  bool reports_degrees = false;         ///< Whether GetStatus reports degrees.
  bool has_degrees = true, has_zoom = true, has_services = true, reports_motion = true;
  bool obeys = true;              ///< Whether the camera executes the moves that it accepts.
  bool refuses = false;           ///< Whether the camera refuses moves with a fault.
  bool wants_http_login = false;  ///< Whether the camera answers all requests with HTTP status 401.
  bool refuses_replays = true;    ///< Whether each signature is valid only once.
  double epoch = 1.7e9;           ///< Time of the camera's clock at the time 0, s since 1970.
  double most_age = 5;  ///< Largest difference between the time of a signature and the camera's clock, s.
  double reply_delay = 0.01;            ///< Time from a request to the answer, s.
  std::string host = "127.0.0.1:8080";  ///< Host in the addresses of the services.
};

/// Faults of a camera's answers.
enum class OnvifFault {
  none,
  silent,             ///< The camera does not answer.
  truncated,          ///< The second half of the answer is missing, and the connection stays open.
  closes,             ///< The camera closes the connection in the middle of an answer.
  hangs_up,           ///< The camera closes the connection without an answer.
  garbage,            ///< The answer is not HTTP.
  not_soap,           ///< The answer is a web page.
  huge,               ///< The answer is larger than a client accepts.
  duplicate_headers,  ///< The answer has two headers with different lengths.
  chunked,            ///< The answer has a chunked encoding, which is valid.
  in_pieces,          ///< The answer arrives byte by byte, which is valid.
  unmarked,           ///< The camera marks the end of the answer by closing the connection, which is valid.
};

/// Bytes that a camera sends on one connection at one time.
struct OnvifChunk {
  double at = 0;  ///< Time of sending, s.
  std::string bytes;
  bool closes = false;  ///< Whether the camera closes the connection after these bytes.
};

/// A simulated ONVIF camera. An OnvifDevice answers requests of the device, media and PTZ services, checks
/// logins, and simulates the motion of its head. The device has neither a thread nor a clock: the caller
/// passes the time.
class OnvifDevice {
 public:
  /// Makes a camera whose head is at pan 0 and tilt 0, with the smallest zoom.
  explicit OnvifDevice(OnvifModel model = {});

  /// Returns the properties, which the caller may change.
  [[nodiscard]] OnvifModel& model() { return model_; }
  /// Makes the next `count` answers faulty.
  void fail(OnvifFault fault, std::size_t count = 1000000);
  /// Returns the chunks that the camera sends for a request at time `now`, s, which must not be before the
  /// time of the previous call.
  [[nodiscard]] std::vector<OnvifChunk> answer(const HttpMessage& request, double now);

  /// Puts the head at a position of the generic position space, at rest.
  void put(const OnvifPlace& place);
  /// Returns the position at time `now`, s, in the generic position space.
  [[nodiscard]] OnvifPlace place(double now) const;
  /// Returns whether the head moves at time `now`, s.
  [[nodiscard]] bool is_moving(double now) const;
  /// Blocks the axes at their present positions, as an obstacle would, or releases them.
  void block(bool is_blocked, double now);
  /// Returns the number of executed requests with a name, such as "Stop".
  [[nodiscard]] std::size_t executed(std::string_view name) const;

 private:
  struct Axis {
    double from = 0, to = 0, since = 0, rate = 0;
    [[nodiscard]] double at(double now) const;
  };
  struct Reply {
    int status = 200;
    std::string soap;
  };
  [[nodiscard]] Reply reply_to(const OnvifRequest& request, double now);
  [[nodiscard]] std::optional<Reply> login_fault(const OnvifRequest& request, double now);
  [[nodiscard]] Reply move(const OnvifRequest& request, double now);
  [[nodiscard]] Reply drive(const OnvifRequest& request, double now);
  [[nodiscard]] std::string status(double now) const;
  [[nodiscard]] std::string clock(double now) const;
  [[nodiscard]] std::string nodes() const;
  [[nodiscard]] std::string services() const;
  [[nodiscard]] std::string capabilities() const;
  void go(std::size_t axis, double to, double rate, double now);
  void halt(const OnvifRequest& request, double now);

  OnvifModel model_;
  std::array<Axis, 3> axes_{};
  bool is_blocked_ = false;
  OnvifFault fault_ = OnvifFault::none;
  std::size_t faults_left_ = 0;
  std::map<std::string, double> nonces_;  // Used, with their times.
  std::map<std::string, std::size_t, std::less<>> executed_;
};

/// One connection to a simulated camera.
class OnvifStream {
 public:
  /// A connection to `device`, which must outlive it.
  explicit OnvifStream(OnvifDevice& device) : device_(device), reader_(HttpReader::Side::requests) {}
  /// Processes bytes that arrive at time `now`, s. Returns the chunks that the camera sends as an answer.
  std::vector<OnvifChunk> receive(std::string_view bytes, double now);

 private:
  OnvifDevice& device_;
  HttpReader reader_;
};

}  // namespace flexura
