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
                 {.meaning = "Version of Flexura that ran the file, written into results.",
                  .default_text = "not set"})
          .field("title", &Setup::title,
                 {.meaning = "Title of the report.", .default_text = "the file's name"})
          .field("seed", &Setup::seed,
                 {.meaning = "Seed of all random numbers in the run.", .range = between(0, 1e15)})
          .field("include", &Setup::include,
                 {.meaning = "Files with default values, in this file's folder or below. Values in this file "
                             "override those of included files.",
                  .count = {0, 100},
                  .default_text = "none"})
          .field("clock", &Setup::clock, {.meaning = "Time of the experiment."})
          .field("record", &Setup::record, {.meaning = "Contents of the log and the report."})
          .field("arm", &Setup::arm, {.meaning = "Arm.", .required = true})
          .field("drive", &Setup::drive,
                 {.meaning = "Drive of the arm. With a drive, a run writes command lists.",
                  .default_text = "none"})
          .field("obstacle", &Setup::obstacle,
                 {.meaning = "Obstacles that the arm must not touch.",
                  .count = {0, max_obstacles},
                  .default_text = "none"})
          .field("stand", &Setup::stand, {.meaning = "Surroundings of the arm in the cameras' pictures."})
          .field("camera", &Setup::camera,
                 {.meaning = "Cameras.",
                  .count = {0, max_cameras},
                  .default_text = "two: \"front\" on +Z and \"side\" on -X; both show the arm's whole reach"})
          .field("seeing", &Setup::seeing,
                 {.meaning = "What separates the arm from its surroundings in the cameras' pictures.",
                  .count = {0, max_cameras},
                  .default_text = "brightness alone"})
          .field("backdrop", &Setup::backdrop,
                 {.meaning = "Pictures that simulated cameras see behind everything else.",
                  .count = {0, max_cameras},
                  .default_text = "none"})
          .field(
              "truth", &Setup::truth,
              {.meaning = "True values of the simulated world that differ from the models which tasks use.",
               .default_text = "as modelled"})
          .field("rig", &Setup::equipment,
                 {.meaning = "Real equipment that executes the experiment.", .default_text = "simulated"}));
}

}  // namespace flexura
