#include "flexura/view/experiment_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "flexura/store/text_file.h"
#include "flexura/view/session.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/view_fakes.h"

namespace flexura {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

const std::string commented = "# A comment.\n" + viewed_text;

TEST(ExperimentText, IsThatOfTheFileIfItAloneGivesTheExperiment) {
  const Experiment experiment = parse_experiment(commented, "x");
  EXPECT_EQ(editable_text(commented, experiment), commented);
  Experiment other = experiment;
  other.seed = 7;
  for (const std::string& text : {editable_text(commented, other), editable_text("", other),
                                  editable_text("include = [\"arm.toml\"]\n", other)}) {
    EXPECT_THAT(text, StartsWith("# Every value"));
    EXPECT_EQ(parse_experiment(text, "x").seed, 7);
  }
}

TEST(ExperimentText, GetsATaskToAPoseAtItsEnd) {
  const auto rig = viewed_rig(commented);
  ArmState pose = ArmState::straight(2);
  pose.bends = {{0.1234567891234, -0.5}, {1, 0}};
  const std::string text = with_move(commented, *rig, pose);
  EXPECT_THAT(text, StartsWith(commented));
  EXPECT_THAT(text, EndsWith(R"(
[[task]]
kind = "move"
name = "pose 1"
duration = 2
to = { bends = [[0.123456789, -0.5], [1, 0]] }
)"));
  const Experiment read = parse_experiment(text, "x");
  ASSERT_EQ(read.task.size(), 2U);
  EXPECT_NEAR((*std::get<MoveTask>(read.task[1]).to.bends)[0][0], 0.123456789, 1e-12);
  EXPECT_THAT(with_move(text, *viewed_rig(text), pose), HasSubstr("name = \"pose 2\""));
  // A list of tasks on one line has no place for it.
  const std::string inline_tasks =
      "task = [{ kind = \"hold\", duration = 1 }]\n" + commented.substr(0, commented.find("[[task]]"));
  const std::string whole = with_move(inline_tasks, *viewed_rig(inline_tasks), pose);
  EXPECT_THAT(whole, StartsWith("# Every value"));
  EXPECT_EQ(parse_experiment(whole, "x").task.size(), 2U);
}

TEST(ExperimentText, GetsTheStartOfACamera) {
  const auto rig = viewed_rig(commented);
  const CameraReading reading{{0.1, -0.2, 1}, {}};
  const std::string text = with_camera_start(commented, *rig, 1, reading);
  EXPECT_THAT(text, HasSubstr("name = \"side\"\ninitial = { pan = 0.1, tilt = -0.2, zoom = 1 }\nmount"));
  EXPECT_THAT(text, StartsWith("# A comment."));
  const std::string again = with_camera_start(text, *viewed_rig(text), 1, {{0.3, 0, 1}, {}});
  EXPECT_THAT(again, HasSubstr("initial = { pan = 0.3, tilt = 0, zoom = 1 }"));
  EXPECT_THAT(again, Not(HasSubstr("pan = 0.1")));
  EXPECT_EQ(parse_experiment(again, "x").camera[1].initial.pan, 0.3);
  EXPECT_EQ(parse_experiment(again, "x").camera[0].initial.pan, 0);
}

TEST(ExperimentText, KeepsTheTrueCameraAsFarOffAsBefore) {
  const std::string off = viewed_text + R"(
[[truth.camera]]
name = "front"
initial = { pan = 0.02 }
)";
  const std::string text = with_camera_start(off, *viewed_rig(off), 0, {{0.1, 0, 1}, {}});
  const Experiment read = parse_experiment(text, "x");
  EXPECT_NEAR(read.camera[0].initial.pan, 0.1, 1e-12);
  EXPECT_NEAR(read.truth->camera[0].initial.pan, 0.12, 1e-12);
}

TEST(ExperimentText, WritesOutDefaultCamerasThatLookElsewhere) {
  const std::string without = "[arm]\n[[arm.section]]\nlength = 1\n";
  const auto rig = viewed_rig(without);
  CameraReading reading = rig->first_reading(0);
  reading.head.pan = 0.05;
  const Experiment read = parse_experiment(with_camera_start(without, *rig, 0, reading), "x");
  ASSERT_EQ(read.camera.size(), 2U);
  EXPECT_EQ(read.camera[0].initial.pan, 0.05);
}

TEST(ExperimentText, HasItsProblemsWithLinesAndColumns) {
  EXPECT_TRUE(experiment_problems(commented).empty());
  const auto problems = experiment_problems("[arm]\nkind = 3\n[[arm.section]]\nlength = -1\n");
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_EQ(problems[0].where.line, 2);
  EXPECT_EQ(problems[0].where.column, 8);
  EXPECT_EQ(problems[1].where.line, 4);
  EXPECT_EQ(experiment_problems("[arm\n").at(0).where.line, 1);
  // No other file is read for a client.
  for (const char* text :
       {"include = [\"/etc/passwd\"]\n", "[[task]]\nkind = \"keyframes\"\nfile = \"/etc/passwd\"\n"}) {
    const auto found = experiment_problems(viewed_text.substr(0, 1) + text + viewed_text.substr(1));
    ASSERT_FALSE(found.empty()) << text;
    for (const Problem& problem : found) EXPECT_THAT(problem.what, Not(HasSubstr("root"))) << text;
  }
}

TEST(SavedExperiment, IsANewFileInTheFolder) {
  const TemporaryFolder folder;
  EXPECT_EQ(free_name(folder.path(), "arm"), "arm-2.toml");
  EXPECT_EQ(save_new_experiment(folder.path(), "arm-2.toml", "seed = 1\n"), folder.path() / "arm-2.toml");
  EXPECT_EQ(read_text_file(folder.path() / "arm-2.toml", 100), "seed = 1\n");
  EXPECT_EQ(free_name(folder.path(), "arm"), "arm-3.toml");
  EXPECT_THROW((void)save_new_experiment(folder.path(), "arm-2.toml", "other"), ViewRefusal);
  EXPECT_EQ(read_text_file(folder.path() / "arm-2.toml", 100), "seed = 1\n");
  for (const char* name :
       {"", ".toml", "../arm.toml", "a/b.toml", "/tmp/x.toml", "..\\x.toml", ".hidden.toml", "arm.txt",
        "arm.toml\n", "a\"b.toml", "caf\xc3\xa9.toml", "-x.toml"})
    EXPECT_THROW((void)save_new_experiment(folder.path(), name, ""), ViewRefusal) << name;
  std::filesystem::create_symlink("/nowhere/at/all", folder.path() / "link.toml");
  EXPECT_THROW((void)save_new_experiment(folder.path(), "link.toml", ""), ViewRefusal);
}

}  // namespace
}  // namespace flexura
