// Tests flexura compare on the results of small runs.
#include "flexura/app/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "flexura/app/commands.h"
#include "flexura/base/source.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/run.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Compare : public ::testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string run(const std::string& name, double bend) {
    NoProgress progress;
    std::filesystem::create_directory(path(name));
    const std::string file =
        "[arm]\nkind='spatial'\n[[arm.section]]\nlength = 1\n[[task]]\nkind='move'\n"
        "duration=0.2\nto.bends=[[" +
        std::to_string(bend) + ", 0]]\n[record]\nreport=false\n";
    (void)run_experiment(parse_experiment(file, "x.toml"), path(name), progress);
    return path(name);
  }
  std::string answer() {
    std::ostringstream out, err;
    EXPECT_EQ(compare_command(arguments_, out, err), exit_done);
    return out.str();
  }
  std::string refusal() {
    std::ostringstream out, err;
    try {
      (void)compare_command(arguments_, out, err);
    } catch (const InputError& error) {
      EXPECT_EQ(out.str(), "");
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return error.what();
    }
    ADD_FAILURE() << "not refused: " << out.str();
    return "";
  }

  TemporaryFolder folder_;
  CompareArguments arguments_;
};

TEST_F(Compare, ListsTheValuesThatDiffer) {
  arguments_.a = run("a", 0.5), arguments_.b = run("b", 0.6);
  const std::string table = answer();
  EXPECT_THAT(table, HasSubstr("A: " + arguments_.a + ": move: at the target shape after 0.2 s\n"));
  EXPECT_THAT(table, HasSubstr("\ntip.position.0"));
  EXPECT_THAT(table, HasSubstr("\ntasks.move.tip.position.0"));
  EXPECT_THAT(table, Not(HasSubstr("\nduration")));
  EXPECT_THAT(table, HasSubstr(" values are equal\n"));
  arguments_.all = true;
  EXPECT_THAT(answer(), HasSubstr("\nduration"));
}

TEST_F(Compare, OfARunWithItselfFindsNothing) {
  arguments_.a = arguments_.b = run("a", 0.5);
  arguments_.json = true;
  const Node found = parse_json(answer(), "answer");
  EXPECT_TRUE(found.find("values")->as<Node::Array>()->empty());
  EXPECT_GT(*found.find("equal")->as<std::int64_t>(), 10);
}

TEST_F(Compare, HasDifferencesInJson) {
  const auto number = [](double value) { return Node{value, {}}; };
  const Node a{Node::Table{{"x", {}, number(2)}, {"zero", {}, number(0)}, {"gone", {}, {true, {}}}}, {}},
      b{Node::Table{{"x", {}, number(1)}, {"zero", {}, number(1)}, {"new", {}, {std::string("text"), {}}}},
        {}};
  const auto values = compared_values(a, b);
  ASSERT_EQ(values.size(), 4U);
  EXPECT_EQ(values[0].difference, -1);
  EXPECT_EQ(values[0].relative, -0.5);
  EXPECT_FALSE(values[1].relative);
  EXPECT_FALSE(values[2].b);
  EXPECT_EQ(values[3].measure, "new");
  EXPECT_FALSE(values[3].is_equal());
}

TEST_F(Compare, WritesAPageWithBothRuns) {
  arguments_.a = run("a", 0.5), arguments_.b = run("b", 0.6);
  arguments_.out = path("page.html");
  EXPECT_THAT(answer(), HasSubstr("page: " + arguments_.out));
  const std::string page = read_text_file(arguments_.out, 1 << 24);
  for (const char* part : {"picture-tip-x", "picture-tip-distance", "picture-bend-1-x", "tip.position.0"})
    EXPECT_THAT(page, HasSubstr(part));
  EXPECT_THAT(page, Not(HasSubstr("picture-bend-1-y"))) << "never changes";
  std::ostringstream out, err;
  EXPECT_THROW((void)compare_command(arguments_, out, err), std::runtime_error) << "never overwrites";
}

TEST_F(Compare, RefusesWhatIsNoResult) {
  arguments_.a = run("a", 0.5), arguments_.b = path("missing");
  EXPECT_THAT(refusal(), HasSubstr("missing: no such folder"));
  arguments_.b = path("a/log.mcap");
  EXPECT_THAT(refusal(), HasSubstr("expected a folder made by flexura run"));
  std::filesystem::create_directory(path("empty"));
  arguments_.b = path("empty");
  EXPECT_THAT(refusal(), HasSubstr("summary.json"));
  std::ofstream(path("empty/summary.json")) << "{\"outcome\": ";
  EXPECT_THAT(refusal(), HasSubstr("summary.json:1:"));
  std::filesystem::remove(path("empty/summary.json"));
  std::ofstream(path("empty/summary.json")) << "[1]";
  EXPECT_THAT(refusal(), HasSubstr("no outcome"));
  std::filesystem::remove(path("empty/summary.json"));
  std::filesystem::copy_file(path("a/summary.json"), path("empty/summary.json"));
  arguments_.out = path("page.html");
  EXPECT_THAT(refusal(), HasSubstr("log.mcap"));
}

}  // namespace
}  // namespace flexura
