#include "flexura/store/schema.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "flexura/base/table.h"
#include "flexura/store/json.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

struct Lamp {
  double height = 1.0;
  std::array<double, 2> reach = {1, 2};
};
struct Room {
  std::vector<std::variant<Lamp>> thing;
};

const Table<Lamp>& fields_of(const Lamp*) {
  static const auto table =
      Table<Lamp>("lamp", "Gives light.")
          .field("height", &Lamp::height,
                 {.meaning = "How high it is.", .unit = Unit::metre, .range = above(0), .required = true})
          .field("reach", &Lamp::reach, {.meaning = "How far.", .range = at_least(0), .one_for_all = true});
  return table;
}
const Table<Room>& fields_of(const Room*) {
  static const auto table = Table<Room>("room", "A room.")
                                .field("thing", &Room::thing, {.meaning = "What is in it.", .count = {1, 5}});
  return table;
}

TEST(JsonSchema, DescribesKindsUnitsRangesAndCounts) {
  const Node schema = json_schema(fields_of(static_cast<const Room*>(nullptr)).info());
  const std::string expected =
      R"({"$schema":"http://json-schema.org/draft-07/schema#","title":"room","type":"object","description":"A room.",)"
      R"("properties":{"thing":{"type":"array","items":{"anyOf":[{"type":"object","description":"Gives light.",)"
      R"("properties":{"kind":{"const":"lamp"},)"
      R"("height":{"type":"number","exclusiveMinimum":0,"description":"How high it is. [m]"},)"
      R"("height_mm":{"type":"number","exclusiveMinimum":0,"description":"How high it is. [mm]"},)"
      R"("reach":{"anyOf":[{"type":"number","minimum":0},)"
      R"({"type":"array","items":{"type":"number","minimum":0},"minItems":2,"maxItems":2}],)"
      R"("description":"How far. Default: [1, 2]."}},)"
      R"("additionalProperties":false,"required":["kind"],)"
      R"("allOf":[{"anyOf":[{"required":["height"]},{"required":["height_mm"]}]}]}]},)"
      R"("minItems":1,"maxItems":5,"description":"What is in it. Default: []."}},"additionalProperties":false})";
  EXPECT_EQ(write_json(schema), expected);
}

TEST(MarkdownReference, HasASectionATableAndARowAField) {
  const std::string page = markdown_reference(fields_of(static_cast<const Room*>(nullptr)).info());
  EXPECT_THAT(page, HasSubstr("# room\n\nA room.\n"));
  EXPECT_THAT(page, HasSubstr("## `[[thing]]`, `kind = \"lamp\"`\n\nGives light.\n"));
  EXPECT_THAT(
      page,
      HasSubstr("| `height`, `height_mm` | number | m, mm | above 0 m | required | How high it is. |\n"));
  EXPECT_THAT(page,
              HasSubstr("| `reach` | number, or array of 2 numbers |  | at least 0 | [1, 2] | How far. |\n"));
}

}  // namespace
}  // namespace flexura
