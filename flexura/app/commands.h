#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "flexura/app/view.h"

namespace flexura {

/// Exit statuses of the program (docs/command-line.md).
enum ExitStatus : int { exit_done = 0, exit_missed = 1, exit_bad_input = 2, exit_system_failure = 3 };
/// Returns the exit status that a shell reports for a program that a signal ended.
[[nodiscard]] constexpr int exit_of_signal(int signal) { return 128 + signal; }

/// Arguments of `flexura run`.
struct RunArguments {
  std::string experiment;           ///< "": a run of a campaign.
  std::string from;                 ///< Results of the campaign whose run is replayed; "": none.
  std::optional<std::int64_t> row;  ///< Number of this run.
  std::string out;                  ///< Results folder; "": default.
  std::vector<std::string> sets;
  std::optional<std::int64_t> seed;
  bool json = false;
  bool dry_run =
      false;  ///< Whether to print what the run would send to the equipment, instead of running (dry_run.h).
  bool queries = false;  ///< With `dry_run`: whether to print also the queries of device states.
  std::optional<ViewerArguments> viewer;  ///< If set, a viewer shows the run and stays open afterwards.
  double speed = 1;  ///< Speed of a run with a viewer, relative to real time; 0: as fast as possible.
};

/// Arguments of `flexura check`.
struct CheckArguments {
  std::string experiment;
  std::vector<std::string> sets;
  bool json = false;
};

/// Arguments of `flexura export`.
struct ExportArguments {
  std::string results;  ///< Folder of a run, or file of a campaign.
  std::string format = "csv";
  std::string out;  ///< New file, for glTF and campaigns only; "": default.
};

// Each command writes its result to `out` and messages for the user to `err`, and returns an exit status.
// Commands throw InputError for bad input and other exceptions for system failures.

int run_command(const RunArguments& arguments, std::ostream& out, std::ostream& err);
int check_command(const CheckArguments& arguments, std::ostream& out, std::ostream& err);
int forward_command(const std::string& arm_file, std::istream& in, std::ostream& out);
int inverse_command(const std::string& arm_file, std::istream& in, std::ostream& out);
int statics_command(const std::string& arm_file, std::istream& in, std::ostream& out);
int linearise_command(const std::string& arm_file, std::istream& in, std::ostream& out);
int export_command(const ExportArguments& arguments, std::ostream& out, std::ostream& err);
int schema_command(const std::string& format, const std::string& subject, std::ostream& out);

}  // namespace flexura
