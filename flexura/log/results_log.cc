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

McapReader open_log(const std::filesystem::path& results) {
  const auto file = file_of_results(results, log_file_name);
  return from_log([&] { return McapReader(file); });
}

}  // namespace flexura
