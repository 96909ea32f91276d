#pragma once

// CLI11 takes long to compile, so only the sources that define the command line include this header.
#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "flexura/app/program_help.h"

namespace flexura {

/// Runs a command with the parsed arguments and returns its exit status.
using Command = std::function<int()>;

/// The headings of `flexura --help`, in order of appearance.
namespace command_group {
inline constexpr const char* experiments = "Set up and run an experiment";
inline constexpr const char* equipment = "Set up equipment";
inline constexpr const char* answers = "Ask about an arm (JSON lines in, JSON lines out)";
inline constexpr const char* pictures = "Make and measure pictures";
inline constexpr const char* program = "Help for files and shells";
}  // namespace command_group

/// Adds a command under the heading `group`, with an example that can be pasted into a shell.
CLI::App* add_command(CLI::App& app, const std::string& name, const char* group, const std::string& meaning,
                      const std::string& example);

/// Adds `--set PATH=VALUE`, which changes a value of the experiment file.
void add_set_option(CLI::App& command, std::vector<std::string>& sets);

/// Adds the commands campaign and report.
void add_campaign_commands(CLI::App& app, Command& chosen);

/// Adds the commands render, measure, estimate, intrinsics and board.
void add_picture_commands(CLI::App& app, Command& chosen);

/// Returns the description of the command line for the shells' completion and the manual page.
[[nodiscard]] ProgramHelp program_help(const CLI::App& app);

}  // namespace flexura
