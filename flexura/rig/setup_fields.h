#pragma once

#include <concepts>
#include <utility>

#include "flexura/base/table.h"
#include "flexura/rig/setup.h"

namespace flexura {

inline constexpr std::size_t max_obstacles = 1000;
inline constexpr std::size_t max_cameras = 100;

/// Adds the fields of a setup to the table of a struct derived from Setup.
template <std::derived_from<Setup> S>
[[nodiscard]] Table<S> with_setup_fields(Table<S> table) {
  return std::move(
      table
          .field("flexura", &Setup::flexura,
                 {.meaning = "Version that ran the file; written into results.", .default_text = "not set"})
          .field("title", &Setup::title,
                 {.meaning = "A title for the report.", .default_text = "the file's name"})
          .field("seed", &Setup::seed,
                 {.meaning = "Seed of every random number of the run.", .range = between(0, 1e15)})
          .field("include", &Setup::include,
                 {.meaning = "Files in this file's folder or below upon whose values this file's are laid.",
                  .count = {0, 100},
                  .default_text = "none"})
          .field("clock", &Setup::clock, {.meaning = "How time runs."})
          .field("record", &Setup::record, {.meaning = "What is kept of a run."})
          .field("arm", &Setup::arm, {.meaning = "The arm.", .required = true})
          .field(
              "drive", &Setup::drive,
              {.meaning = "What moves the arm; with it a run writes command lists.", .default_text = "none"})
          .field("obstacle", &Setup::obstacle,
                 {.meaning = "What the arm must not touch.",
                  .count = {0, max_obstacles},
                  .default_text = "none"})
          .field("stand", &Setup::stand, {.meaning = "What stands around the arm for the cameras to see."})
          .field("camera", &Setup::camera,
                 {.meaning = "The cameras.",
                  .count = {0, max_cameras},
                  .default_text =
                      "two, \"front\" on +Z and \"side\" on -X, with all of the arm's reach in view"})
          .field("truth", &Setup::truth,
                 {.meaning = "Where the simulated world differs from what the tasks believe.",
                  .default_text = "nowhere"}));
}

}  // namespace flexura
