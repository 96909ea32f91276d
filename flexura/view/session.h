#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/serve/server.h"
#include "flexura/view/describe.h"
#include "flexura/view/request.h"

namespace flexura {

/// Why a request is not done, in one line. Sessions throw it.
class ViewRefusal : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What comes of a request: a result, or where `error` is not "" the reason why there is none.
struct ViewAnswer {
  Node result = {Node::Table{}, {}};
  std::string error;
};
using Reply = std::function<void(ViewAnswer)>;

/// What `hello` says of a session.
struct Hello {
  std::string mode;  ///< "live" or "recording"
  std::string title;
  Node scene;
  Node controls;
  double duration = 0;  ///< s
  double interval = 0;  ///< Between two states of a recording, mostly, s.
  std::vector<Mark> marks;
  std::vector<Quantity> quantities;
  bool report = false;
  bool readonly = false;
};

/// A picture that was asked for by its address.
struct ImageAsk {
  std::string camera;
  std::optional<double> time;  ///< s
};
struct SeriesAsk {
  std::vector<std::string> names;
  std::int64_t points = 0;
};
struct ReportAsk {};
using Document = std::variant<ImageAsk, SeriesAsk, ReportAsk>;

/// What is looked at: a rig or a recording. One thread uses it.
class Session {
 public:
  virtual ~Session() = default;
  Session() = default;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  [[nodiscard]] virtual Hello hello() const = 0;
  virtual void opened(ClientId client) = 0;
  virtual void closed(ClientId client) = 0;
  /// Does what a client asks and calls `reply` once, now or later on this thread; or throws a ViewRefusal.
  virtual void take(ClientId client, const Ask& ask, Reply reply) = 0;
  /// Answers once, now or later on any thread; or throws a ViewRefusal.
  virtual void take(const Document& document, std::function<void(HttpAnswer)> answer) = 0;
  /// Goes on to `now`, s by a clock that never falls, and sends what is due to the clients.
  virtual void advance(double now) = 0;
};

}  // namespace flexura
