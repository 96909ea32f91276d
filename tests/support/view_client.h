#pragma once

#include <gtest/gtest.h>

#include <string>

#include "flexura/view/view_server.h"
#include "tests/support/raw_client.h"

namespace flexura {

/// Returns a client whose WebSocket the server has accepted.
inline RawClient connected(const ViewServer& server, int receive_buffer = 0) {
  RawClient client(server.port(), receive_buffer);
  client.send("GET /socket HTTP/1.1\r\nHost: localhost:" + std::to_string(server.port()) +
              "\r\nAuthorization: Bearer " + server.token() +
              "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
              "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
  EXPECT_EQ(client.read_answer().status, 101);
  return client;
}

}  // namespace flexura
