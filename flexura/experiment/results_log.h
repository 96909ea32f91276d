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

/// The log of a results folder. InputError when there is none or it is damaged.
[[nodiscard]] McapReader open_log(const std::filesystem::path& results);

}  // namespace flexura
