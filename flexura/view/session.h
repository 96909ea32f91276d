#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/serve/server.h"
#include "flexura/view/describe.h"
#include "flexura/view/experiment_text.h"
#include "flexura/view/request.h"

namespace flexura {

/// Exception for a request that a session refuses. what() returns the reason in one line.
class ViewRefusal : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Answer to a request: a result, or the reason for the refusal in `error`. `error` is "" for a result.
struct ViewAnswer {
  Node result = {Node::Table{}, {}};
  std::string error;
};
using Reply = std::function<void(ViewAnswer)>;

/// Content of the message `hello` (docs/viewer-protocol.md) for a session.
struct Hello {
  std::string mode;  ///< "live", "recording" or "pictures".
  std::string title;
  Node scene;
  Node controls;
  double duration = 0;  ///< Duration of a recording, s.
  double interval = 0;  ///< Typical interval between two states of a recording, s.
  std::vector<Mark> marks;
  std::vector<Quantity> quantities;
  std::string headline;  ///< Result of a recorded run in one line; may be "".
  bool report = false;
  bool readonly = false;
  /// Speed of a run that was started outside the session, relative to real time.
  std::optional<double> speed;
};

/// A request for a picture by its address (URL).
struct ImageAsk {
  std::string camera;
  std::optional<double> time;  ///< Time in the recording, s.
};
struct SeriesAsk {
  std::vector<std::string> names;
  std::int64_t points = 0;
};
struct ReportAsk {};
using Document = std::variant<ImageAsk, SeriesAsk, ReportAsk>;

/// A live rig or a recording that clients view. Not thread-safe.
class Session {
 public:
  virtual ~Session() = default;
  Session() = default;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  [[nodiscard]] virtual Hello hello() const = 0;
  virtual void opened(ClientId client) = 0;
  virtual void closed(ClientId client) = 0;
  /// Handles a client's request. Calls `reply` exactly once on this thread, immediately or later. To refuse
  /// the request, throws ViewRefusal instead.
  virtual void take(ClientId client, const Ask& ask, Reply reply) = 0;
  /// Calls `answer` exactly once with the document, on any thread, immediately or later. To refuse the
  /// request, throws ViewRefusal instead.
  virtual void take(const Document& document, std::function<void(HttpAnswer)> answer) = 0;
  /// Returns the state that a client sees. Commanded positions are used where they exist.
  [[nodiscard]] virtual RigInstant instant(ClientId client) = 0;
  /// Advances to the time `now` (s), which never decreases, and sends due messages to the clients.
  virtual void advance(double now) = 0;
};

}  // namespace flexura
