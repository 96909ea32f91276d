#include "flexura/base/bytes.h"

#include <gtest/gtest.h>

#include "tests/support/random_cases.h"

namespace flexura {
namespace {

TEST(Base64, GivesTheStandardsOwnExamples) {
  // RFC 4648, section 10.
  const std::pair<const char*, const char*> examples[] = {{"", ""},
                                                          {"f", "Zg=="},
                                                          {"fo", "Zm8="},
                                                          {"foo", "Zm9v"},
                                                          {"foob", "Zm9vYg=="},
                                                          {"fooba", "Zm9vYmE="},
                                                          {"foobar", "Zm9vYmFy"}};
  for (const auto& [data, text] : examples) {
    EXPECT_EQ(base64(data), text);
    EXPECT_EQ(from_base64(text), data);
  }
}

TEST(Base64, KeepsEveryByte) {
  for_random_cases(100, [](TestRandom& random) {
    std::string data(static_cast<std::size_t>(random.uniform(0, 100)), '\0');
    for (char& c : data) c = static_cast<char>(random.uniform(-128, 128));
    EXPECT_EQ(from_base64(base64(data)), data);
  });
}

TEST(Base64, RefusesOtherText) {
  for (const char* text : {"Z", "Zg", "Zg=", "Zh==", "Zm9=", "Z===", "Zm9v\n", "Zm9*", "=g==", "Zg==Zg=="})
    EXPECT_FALSE(from_base64(text)) << text;
}

}  // namespace
}  // namespace flexura
