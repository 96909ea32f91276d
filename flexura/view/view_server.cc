#include "flexura/view/view_server.h"

#include <chrono>

namespace flexura {
namespace {

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

ViewServer::ViewServer(ViewStart start, ServerConfig config, std::span<const Asset> assets)
    : door_({.clock = steady_seconds}), server_(std::move(config), assets, door_), messenger_(server_) {
  door_.start(std::move(start), messenger_);
}

ViewServer::~ViewServer() { door_.stop(); }

}  // namespace flexura
