#include "flexura/store/json.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "flexura/base/source.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

std::string json_error_of(std::string_view text) {
  try {
    (void)parse_json(text, "line");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ParseJson, KeepsValuesAndTheOrderOfKeys) {
  const char* text = R"({"b":[1,2.5,true,null,"x\u00e9"],"a":{"c":-3}})";
  EXPECT_EQ(write_json(parse_json(text, "line")), "{\"b\":[1,2.5,true,null,\"x\u00e9\"],\"a\":{\"c\":-3}}");
}

TEST(ParseJson, SaysWhereAndWhyTextIsNoJson) {
  EXPECT_THAT(json_error_of("{\"a\": 1,\n \"b\" 2}"), HasSubstr("line:2:6: not JSON: "));
  EXPECT_THAT(json_error_of(""), HasSubstr("line:1:1: not JSON: "));
  EXPECT_THAT(json_error_of("[1] 2"), HasSubstr("not JSON"));
  EXPECT_THAT(json_error_of("[NaN]"), HasSubstr("not JSON"));
  EXPECT_THAT(json_error_of("[1e999]"), HasSubstr("not JSON"));
  EXPECT_THAT(json_error_of("\"\xff\""), HasSubstr("not JSON"));
}

TEST(ParseJson, RefusesAKeyGivenTwice) {
  EXPECT_THAT(json_error_of(R"({"a":1,"b":2,"a":3})"), HasSubstr("key \"a\" occurs twice"));
  EXPECT_EQ(json_error_of(R"({"a":{"a":1}})"), "");
  const std::string long_key = std::string(1000, 'k');
  EXPECT_LT(json_error_of(fmt::format(R"({{"{}":1,"{}":2}})", long_key, long_key)).size(), 100U);
}

// Comparing each key with all others would be slower than all other tests together.
TEST(ParseJson, TakesATextThatIsAllKeys) {
  std::string text = "{";
  for (int i = 0; i < 100000; ++i) text += fmt::format("\"{}\":0,", i);
  EXPECT_EQ(json_error_of(text + "\"x\":0}"), "");
  EXPECT_THAT(json_error_of(text + "\"77\":0}"), HasSubstr("key \"77\" occurs twice"));
}

TEST(ParseJson, RefusesDeepNesting) {
  EXPECT_THAT(json_error_of(std::string(1000000, '[')), HasSubstr("nested more than 64 deep"));
  EXPECT_EQ(json_error_of(std::string(64, '[') + std::string(64, ']')), "");
}

TEST(WriteJson, PrintsDoublesThatReadBackExactly) {
  for (const double value :
       {0.1, 1.0 / 3, 1e-310, -0.0, 1e22, 123456789.123456789, std::numeric_limits<double>::max()}) {
    const Node again = parse_json(write_json({value, {}}), "line");
    ASSERT_NE(again.as<double>(), nullptr) << value;
    EXPECT_EQ(*again.as<double>(), value);
    EXPECT_EQ(std::signbit(*again.as<double>()), std::signbit(value));
  }
}

TEST(WriteJson, IndentsTablesAndKeepsShortThingsOnALine) {
  EXPECT_EQ(write_json(parse_json(R"({"a":1,"b":[1,2],"c":{"d":[3]},"e":[],"f":[{"g":1}]})", "line"), 2),
            "{\n  \"a\": 1,\n  \"b\": [1,2],\n  \"c\": {\n    \"d\": [3]\n  },\n  \"e\": [],\n  \"f\": [\n   "
            " {\"g\":1}\n  ]\n}");
}

TEST(WriteJson, ReplacesBytesThatAreNotUtf8) { EXPECT_EQ(write_json({"a\xff", {}}), "\"a\xEF\xBF\xBD\""); }

}  // namespace
}  // namespace flexura
