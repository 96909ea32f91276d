#include "flexura/serve/request_target.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace flexura {
namespace {

using Texts = std::vector<std::string>;

TEST(RequestTarget, IsDecodedInItsParts) {
  const auto target = parse_request_target("/image/front%20left.png?time=1.5&a&b=%26%3d&time=2&&c=d=e");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->path, "/image/front left.png");
  ASSERT_EQ(target->query.size(), 5U);
  EXPECT_EQ(*target->find("time"), "1.5");
  EXPECT_EQ(*target->find("a"), "");
  EXPECT_EQ(*target->find("b"), "&=");
  EXPECT_EQ(*target->find("c"), "d=e");
  EXPECT_EQ(target->find("d"), nullptr);
}

TEST(RequestTarget, StaysBelowItsRoot) {
  for (const std::string& target :
       Texts{"/..", "/../etc/passwd", "/assets/../x", "/assets/%2e%2E/x", "/assets/.%2e", "/a/./b",
             "/a%2f..%2fb", "/a\\..\\b", "/a%5cb", "/a%00b", "/a%0d%0ab", "/."}) {
    EXPECT_FALSE(parse_request_target(target)) << target;
  }
  EXPECT_TRUE(parse_request_target("/..a/b../...?x=/../"));
}

TEST(RequestTarget, IsRefusedWhenItIsNoPath) {
  for (const std::string& target :
       Texts{"", "*", "image", "http://a/b", "//..", "/%", "/%4", "/%g0", "/%+1", "/a?b=%", "/a?%zz"}) {
    EXPECT_FALSE(parse_request_target(target)) << target;
  }
  EXPECT_EQ(parse_request_target("//a")->path, "//a");
  EXPECT_EQ(parse_request_target("/?")->path, "/");
}

}  // namespace
}  // namespace flexura
