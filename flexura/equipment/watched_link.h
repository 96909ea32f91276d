#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "flexura/equipment/link.h"

namespace flexura {

/// A link that calls a function before every read. Drivers read in short slices while they wait, so a watched
/// link can send a guard signs of life during a long wait, and can end the wait.
class WatchedLink : public Link {
 public:
  /// Returns a fault that ends the wait; std::nullopt: the wait goes on.
  using Watch = std::function<std::optional<PortFault>()>;

  explicit WatchedLink(std::unique_ptr<Link> link) : link_(std::move(link)) {}

  /// Sets the function; an empty function: none. Must not be called while another thread reads.
  void set_watch(Watch watch) { watch_ = std::move(watch); }

  [[nodiscard]] const std::string& name() const override { return link_->name(); }
  [[nodiscard]] CommandOutcome write(std::string_view bytes) override { return link_->write(bytes); }
  [[nodiscard]] Outcome<std::string> read(double timeout) override {
    if (watch_)
      if (auto fault = watch_()) return *std::move(fault);
    return link_->read(timeout);
  }
  [[nodiscard]] int descriptor() const override { return link_->descriptor(); }

 private:
  std::unique_ptr<Link> link_;
  Watch watch_;
};

}  // namespace flexura
