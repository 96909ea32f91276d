#include "flexura/experiment/results_log.h"

#include <fmt/format.h>

#include "flexura/experiment/results.h"

namespace flexura {

McapReader open_log(const std::filesystem::path& results) {
  const auto file = results / log_file_name;
  if (!std::filesystem::exists(file)) {
    throw input_error(results.string(),
                      fmt::format("holds no {}: expected a folder made by `flexura run`", log_file_name));
  }
  return from_log([&] { return McapReader(file); });
}

}  // namespace flexura
