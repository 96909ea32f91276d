#include "flexura/serve/own_address.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flexura {
namespace {

TEST(OwnAddress, LeadsOutOfTheMachine) {
  const std::vector<std::string> addresses{"127.0.0.1", "169.254.3.4", "192.168.7.5", "10.0.0.2",
                                           "::1",       "fe80::1",     "2001:db8::7"};
  EXPECT_EQ(outward_address(addresses, false), "192.168.7.5");
  EXPECT_EQ(outward_address(addresses, true), "2001:db8::7");
  EXPECT_EQ(outward_address({"127.0.0.1", "::1", "fe80::1"}, true), "127.0.0.1");
  EXPECT_EQ(outward_address({"127.0.0.1", "2001:db8::7"}, false), "127.0.0.1");
}

TEST(OwnAddress, IsFoundAtTheInterfaces) { EXPECT_THAT(own_addresses(), ::testing::Contains("127.0.0.1")); }

}  // namespace
}  // namespace flexura
