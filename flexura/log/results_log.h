#pragma once

#include <filesystem>
#include <stdexcept>
#include <vector>

#include "flexura/base/source.h"
#include "flexura/store/mcap_reader.h"

namespace flexura {

/// What `read` gives; a damaged log is bad input like any other.
template <class Read>
auto from_log(Read&& read) {
  try {
    return read();
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw InputError(std::vector<Problem>{{{}, error.what()}});
  }
}

/// The file `name` of a results folder. InputError when there is none, or where it is a link that leads out
/// of the folder: such a file is none of the results.
[[nodiscard]] std::filesystem::path file_of_results(const std::filesystem::path& results, const char* name);

/// The log of a results folder. InputError when there is none or it is damaged.
[[nodiscard]] McapReader open_log(const std::filesystem::path& results);

}  // namespace flexura
