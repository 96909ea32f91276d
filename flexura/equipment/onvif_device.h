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
  std::string user = "operator", password = "secret";       ///< Empty user: no login is needed.
  OnvifRange pan = {-1, 1}, tilt = {-1, 1}, zoom = {0, 1};  ///< Range of the generic space.
  /// Degrees at the ends of the ranges of pan and tilt.
  OnvifRange pan_degrees = {-180, 180}, tilt_degrees = {-90, 90};
  std::array<double, 3> rates = {0.5, 0.5,
                                 0.5};  ///< Highest speeds of pan, tilt and zoom, generic positions/s.
  bool reports_degrees = false;         ///< Whether GetStatus reports degrees.
  bool has_degrees = true, has_zoom = true, has_services = true, reports_motion = true;
  bool obeys = true;                    ///< Otherwise, it accepts moves and does nothing.
  bool refuses = false;                 ///< Whether it refuses moves with a fault.
  bool wants_http_login = false;        ///< Whether it answers everything with HTTP status 401.
  bool refuses_replays = true;          ///< Otherwise, a signature counts as often as it comes.
  double epoch = 1.7e9;                 ///< Its clock at the time 0, s since 1970.
  double most_age = 5;                  ///< Largest difference of a signature's time to its clock, s.
  double reply_delay = 0.01;            ///< Time until it answers, s.
  std::string host = "127.0.0.1:8080";  ///< In the addresses of its services.
};

/// Faults of a camera's answers.
enum class OnvifFault {
  none,
  silent,             ///< It does not answer.
  truncated,          ///< The second half is missing, and the connection stays open.
  closes,             ///< It closes the connection in the middle of an answer.
  hangs_up,           ///< It closes the connection without an answer.
  garbage,            ///< The answer is not HTTP.
  not_soap,           ///< The answer is a web page.
  huge,               ///< The answer is larger than a client takes.
  duplicate_headers,  ///< Two different lengths.
  chunked,            ///< A chunked encoding, which is valid.
  in_pieces,          ///< One byte after the other, which is valid.
  unmarked,           ///< The end of the connection is the end of the answer, which is valid.
};

/// What a camera sends on one connection.
struct OnvifChunk {
  double at = 0;  ///< When, s.
  std::string bytes;
  bool closes = false;  ///< Whether it closes the connection after that.
};

/// A simulated ONVIF camera: it answers requests of the device, media and PTZ services, checks logins, and
/// moves its head in time. It needs no thread and no clock of its own.
class OnvifDevice {
 public:
  /// A camera whose head is at pan 0 and tilt 0, with the smallest zoom.
  explicit OnvifDevice(OnvifModel model = {});

  /// Returns the properties; they may be changed.
  [[nodiscard]] OnvifModel& model() { return model_; }
  /// Answers `count` requests with a fault, from now on.
  void fail(OnvifFault fault, std::size_t count = 1000000);
  /// Returns what the camera sends for a request at time `now`, s, >= that of the previous call.
  [[nodiscard]] std::vector<OnvifChunk> answer(const HttpMessage& request, double now);

  /// Puts the head at a generic position, at rest.
  void put(const OnvifPlace& place);
  /// Returns the position at time `now`, generic.
  [[nodiscard]] OnvifPlace place(double now) const;
  /// Returns whether the head moves at time `now`, s.
  [[nodiscard]] bool is_moving(double now) const;
  /// Blocks the axes where they are, as an obstacle does, or releases them.
  void block(bool is_blocked, double now);
  /// Returns the number of requests with a name, such as "Stop", that were executed.
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
  /// Takes bytes that arrive at time `now`. Returns what the camera sends for them.
  std::vector<OnvifChunk> receive(std::string_view bytes, double now);

 private:
  OnvifDevice& device_;
  HttpReader reader_;
};

}  // namespace flexura
