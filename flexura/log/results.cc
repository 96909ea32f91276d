#include "flexura/log/results.h"

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <system_error>

#include "flexura/base/source.h"

namespace flexura {

std::filesystem::path make_new_folder(const std::filesystem::path& desired) {
  std::filesystem::path base = desired.lexically_normal();
  if (!base.has_filename()) base = base.parent_path();  // "results/" means "results".
  if (base.filename() == "." || base.filename() == ".." || base.filename().empty())
    throw input_error(desired.string(),
                      "does not end with the name of a folder: expected a path that ends with a name");
  const auto fail = [](const std::filesystem::path& folder, const std::error_code& error) {
    throw std::runtime_error(fmt::format("cannot make the folder {}: {}", folder.string(), error.message()));
  };
  std::error_code error;
  if (base.has_parent_path()) std::filesystem::create_directories(base.parent_path(), error);
  if (error) fail(base.parent_path(), error);
  // The name is free if the folder can be made, so two runs at once never share one.
  for (int number = 1;; ++number) {
    std::filesystem::path folder = base;
    if (number > 1) folder += fmt::format("-{}", number);
    if (std::filesystem::create_directory(folder, error)) return folder;
    if (error && error != std::errc::file_exists) fail(folder, error);
  }
}

std::filesystem::path default_results_folder(const std::filesystem::path& experiment_file) {
  std::string name = experiment_file.stem().string();
  if (name == "experiment") {
    const auto folder =
        std::filesystem::absolute(experiment_file).lexically_normal().parent_path().filename();
    if (!folder.empty()) name = folder.string();
  }
  return std::filesystem::path("results") / name;
}

}  // namespace flexura
