#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "flexura/port/camera_port.h"
#include "flexura/port/clock_port.h"

namespace flexura {

/// Numbers of frames and connections of a camera since its start.
struct CameraCounts {
  std::int64_t frames = 0;  ///< Number of frames that arrived complete.
  /// Number of frames that the camera took but that did not arrive, or arrived damaged. During an outage the
  /// number is estimated from the frame rate and the length of the outage.
  std::int64_t lost = 0;
  std::int64_t connections =
      0;  ///< Number of connections that delivered frames; above 1 after a reconnection.
};

/// A camera that counts lost frames. All functions may be called from several threads.
class CountedCamera : public CameraPort {
 public:
  [[nodiscard]] virtual CameraCounts counts() const = 0;
};

/// A picture that a camera has sent.
struct TakenPicture {
  Picture picture;
  double time = 0;        ///< Middle of the exposure on the camera's clock, s.
  double exposure = 0;    ///< Exposure time, s; 0 if unknown.
  std::int64_t lost = 0;  ///< Frames lost since the previous picture of this connection.
};

/// Why a connection to a camera ended.
struct ConnectionEnd {
  PortFault fault;        ///< Fault, whose text names the camera and says what to do.
  bool is_final = false;  ///< Whether a reconnection is useless, for example after the end of a video file.
};

/// Pauses between the attempts to reconnect to a camera.
struct CameraPatience {
  double first_pause =
      0.25;  ///< Pause before the first attempt, s, >= 0. The pause doubles after each attempt.
  double longest_pause = 5;  ///< Longest pause, s.
};

/// A camera whose pictures are received by a separate thread. This thread also reconnects after a connection
/// was lost.
class CameraFeed : public CountedCamera {
 public:
  /// Connects to the camera and puts pictures into the feed until the connection fails or is_over().
  using Connection = std::function<ConnectionEnd(CameraFeed&)>;

  /// Starts the thread. `name` is for messages. `frame_rate`, Hz, > 0. `clock` is read when frames are
  /// received, in any thread, and must outlive this object.
  CameraFeed(std::string name, double frame_rate, const ClockPort& clock, Connection connection,
             const CameraPatience& patience = {});
  /// Ends the connection and the thread.
  ~CameraFeed() override;

  Outcome<std::optional<Frame>> newest() override;
  Outcome<std::optional<Frame>> wait(double timeout) override;
  [[nodiscard]] CameraCounts counts() const override;

  /// For connections: adds a picture. May be called from any thread.
  void put(TakenPicture taken);
  /// For connections: returns whether the connection must end.
  [[nodiscard]] bool is_over() const;
  /// For connections: sleeps for `duration`, s, or until is_over(). Returns is_over().
  bool sleep(double duration);
  /// For connections: returns the number of pictures of this connection.
  [[nodiscard]] std::int64_t put_count() const;

 private:
  void run();
  [[nodiscard]] Outcome<std::optional<Frame>> taken();

  const std::string name_;
  const double frame_rate_;
  const ClockPort& clock_;
  const Connection connection_;
  const CameraPatience patience_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool is_over_ = false, is_new_ = false, is_final_ = false;
  std::optional<PortFault> fault_;
  std::optional<Frame> frame_;  // The last one.
  std::int64_t next_number_ = 0, put_count_ = 0;
  CameraCounts counts_;
  std::thread thread_;
};

/// Returns "camera NAME: ", the beginning of messages.
[[nodiscard]] std::string camera_prefix(const std::string& name);

}  // namespace flexura
