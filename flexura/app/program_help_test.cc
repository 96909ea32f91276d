// Tests what helps at the command line: new experiment files, completion, manual page, remaining time.
#include "flexura/app/program_help.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "flexura/app/new_experiment.h"
#include "flexura/app/terminal_progress.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "tests/support/program.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TEST_F(Program, WritesANewExperimentOfEachKindThatIsSafeToRun) {
  for (const ExperimentTemplate& one : experiment_templates()) {
    const std::string kind(one.kind);
    const Ended written = run("new " + kind);
    EXPECT_EQ(written.status, 0) << written.err;
    EXPECT_THAT(written.out, StartsWith("wrote: " + kind + ".toml ("));
    EXPECT_THAT(written.out, HasSubstr("run it: flexura run " + kind + ".toml\n"));
    const std::string text = read_text_file(path(kind + ".toml"), 1 << 20);
    EXPECT_THAT(text, HasSubstr("flexura run " + kind + ".toml")) << "the comments name the file";
    EXPECT_THAT(text, Not(HasSubstr("FILE")));
    const Ended checked = run("check " + kind + ".toml");
    EXPECT_EQ(checked.status, 0) << checked.err << checked.out;
    EXPECT_THAT(checked.out, HasSubstr("safe\n"));
  }
}

TEST_F(Program, RunsANewExperiment) {
  EXPECT_EQ(run("new --out 'my arm.toml'").status, 0);
  const Ended ended = run("run 'my arm.toml'");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("results: results/my arm\n"));
}

TEST_F(Program, KeepsAFileThatIsThereWhenANewExperimentIsWritten) {
  std::ofstream(path("arm.toml")) << "mine";
  const Ended kept = run("new arm");
  EXPECT_EQ(kept.status, 2);
  EXPECT_EQ(kept.err, "arm.toml: the file exists, and is not overwritten: expected the name of a new file\n");
  EXPECT_EQ(read_text_file(path("arm.toml"), 100), "mine");
  const Ended unknown = run("new spider");
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr(R"(KIND: "spider": expected one of "arm", "cameras", "servo")"));
}

TEST_F(Program, PrintsACompletionThatBashUnderstands) {
  const Ended script = run("completion bash");
  EXPECT_EQ(script.status, 0);
  write_new_file(path("completion.sh"), script.out);
  std::ofstream(path("an arm.toml")) << "";
  std::ofstream(path("notes.txt")) << "";
  write_new_file(
      path("ask.sh"),
      "source ./completion.sh\n"
      "ask() { COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _flexura; printf '%s,' \"${COMPREPLY[@]}\"; "
      "echo; }\n"
      "ask flexura est\nask flexura export --to ''\nask flexura new s\nask flexura measure --what c\n"
      "ask flexura run --se\nask flexura run an\nask flexura check not\n");
  EXPECT_EQ(std::system(("cd '" + path("") + "' && bash ask.sh > answers.txt").c_str()), 0);
  EXPECT_EQ(read_text_file(path("answers.txt"), 1 << 16),
            "estimate,\ncsv,mp4,png,gltf,markdown,\nservo,\ncircle,\n--set,--seed,\nan arm.toml,\n,\n");
}

TEST_F(Program, PrintsTheManualPageAndZshsCompletionOfEveryCommand) {
  const std::string manual = run("man").out;
  const std::string zsh = run("completion zsh").out;
  EXPECT_THAT(manual, StartsWith(".TH flexura 1"));
  EXPECT_THAT(zsh, StartsWith("#compdef flexura\n"));
  for (const char* command :
       {"new", "view", "check", "run", "export", "fk", "ik", "statics", "render", "devices", "jog", "measure",
        "estimate", "intrinsics", "board", "schema", "completion", "man"}) {
    EXPECT_THAT(manual, HasSubstr(std::string(".SS \"flexura ") + command + "\"\n"));
    EXPECT_THAT(zsh, HasSubstr(std::string("    ") + command + ")\n"));
    EXPECT_THAT(run(std::string(command) + " --help").out, HasSubstr("\nExample:\n  "))
        << "an example that can be pasted";
  }
}

TEST_F(Program, AnswersTheExamplesOfItsHelp) {
  EXPECT_EQ(run("new arm").status, 0);
  EXPECT_EQ(run("new tendons").status, 0);
  for (const char* command : {"fk", "ik", "statics", "linearise"}) {
    const std::string help = run(std::string(command) + " --help").out;
    const std::string::size_type begin = help.find("echo '") + 6;
    const std::string question = help.substr(begin, help.find('\'', begin) - begin);
    write_new_file(path(std::string(command) + ".json"), question + "\n");
    std::string asked = help.substr(help.find(" | flexura ") + 11);
    asked = asked.substr(0, asked.find('\n'));
    const std::string shell =
        fmt::format("cd '{}' && '{}' {} < {}.json > answer.json", path(""), program, asked, command);
    EXPECT_EQ(std::system(shell.c_str()), 0) << shell;
    const Node answer = parse_json(read_text_file(path("answer.json"), 1 << 20), "answer");
    EXPECT_EQ(answer.find("error"), nullptr) << command;
    EXPECT_TRUE(answer.find("tip") != nullptr || *answer.find("converged")->as<bool>()) << command;
  }
}

TEST(DurationText, HasUnitsForPeople) {
  EXPECT_EQ(duration_text(11.2), "12 s");
  EXPECT_EQ(duration_text(200), "3 min 20 s");
  EXPECT_EQ(duration_text(7500), "2 h 5 min");
}

TEST(ManualPage, KeepsBackslashesDotsAndLines) {
  const ProgramHelp help{
      "tool",
      "1",
      "does it",
      {{"go", "Work", "Goes", ".hidden \\n", {}, {{{"--now"}, "N", "First\n.Second", Takes::text, {}}}}}};
  const std::string page = manual_page(help);
  EXPECT_THAT(page, HasSubstr("\n\\&.hidden \\en\n"));
  EXPECT_THAT(page, HasSubstr("First\n.br\n\\&.Second\n"));
  EXPECT_THAT(page, HasSubstr("\\fB\\-\\-now\\fR \\fIN\\fR\n"));
}

}  // namespace
}  // namespace flexura
