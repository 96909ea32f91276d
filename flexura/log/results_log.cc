#include "flexura/log/results_log.h"

#include <fmt/format.h>

#include "flexura/log/results.h"
#include "flexura/store/text_file.h"

namespace flexura {

std::filesystem::path file_of_results(const std::filesystem::path& results, const char* name) {
  if (is_missing(results / name)) {
    throw input_error(results.string(),
                      fmt::format("has no {}: expected a folder made by `flexura run`", name));
  }
  try {
    return file_inside(results, name);
  } catch (const InputError& refusal) {
    throw input_error(results.string(), refusal.what());
  }
}

McapReader open_log_file(const std::filesystem::path& file) {
  McapReader log = from_log([&] { return McapReader(file, McapCheck::skip); });
  if (log.truncated() && log.messages().empty() && log.damage().empty())
    throw input_error(file.string(), "has no messages: its run was interrupted at the start");
  return log;
}

McapReader open_log(const std::filesystem::path& results) {
  return open_log_file(file_of_results(results, log_file_name));
}

std::vector<std::string> log_notes(const McapReader& log) {
  std::vector<std::string> notes;
  for (const McapDamage& damage : log.damage())
    notes.push_back(fmt::format("the log is damaged: its messages from {:.3f} to {:.3f} s are missing ({})",
                                1e-9 * static_cast<double>(damage.from),
                                1e-9 * static_cast<double>(damage.to), damage.what));
  if (log.truncated())
    notes.emplace_back("the run was interrupted: its log ends with the last complete chunk");
  return notes;
}

}  // namespace flexura
