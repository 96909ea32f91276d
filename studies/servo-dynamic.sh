#!/usr/bin/env bash
# an arm that swings, with a wrong model, servoed by each law: ./dev study servo-dynamic [TARGETS] [TRAJECTORIES] [SEED]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
targets=${1:-200}
trajectories=${2:-50}
seed=${3:-1}
page=docs/studies/servo-dynamic.md
build=${FLEXURA_STUDY_BUILD:-build/release}

if [ -z "${FLEXURA_STUDY_BUILD:-}" ]; then cmake --preset release; fi
cmake --build "$build" --target servo_dynamic_study
mkdir -p docs/studies build/studies
{
  echo "# Steering an arm that swings"
  echo
  cat <<'END'
The true arm is three [elastic rods](../mechanics.md) of 1 m in all, upright before two cameras. Nine tendons with stepper motors pull it. The model of the arm is wrong.

| condition | truth | model |
| --- | --- | --- |
| rods | nickel-titanium wires of 1.7 mm radius with 0.15 kg/m, damping time 10 ms; 20 % stiffer or softer | 54 GPa |
| payload at the tip | up to 40 g | none |
| tendons | 15 mm from the backbone, 0.03 mm/N, friction coefficient 0.02 | 0.025 mm/N, no friction |
| drives | 3200 microsteps a turn, spools of 10 mm, backlash 0.2 degrees, pretension 10 N | backlash 0.15 degrees |
| cameras | 640 x 480 px, f = 800 px, 2.5 m away, gray, 30 Hz, 60 ms late, noise 2 of 255 | see the tables |

Each servo has a rig of its own, starts from rest in the straight shape, and knows neither the truth nor the other servos. Targets and trajectories are dealt out to ten true arms.

- **Shapes** are those at rest of the true arm under bends drawn evenly from +-1.2 rad in each direction. On the way, 0.5 N push the tip for 0.1 s. A servo has converged when the observed error is below 0.2 % of the length for 1 s; it gives up after 5 s. "Left" is the true error, root mean square over arm and last second, % of the length, of all targets.
- **Moving shapes** last 6 s: two sine waves in each direction of each section, up to 0.5 rad and 2 rad/s each. "Lag" is the shift of time with which the arm follows best. "Off" is the true distance from the moving target. Where a servo ends early, the arm counts as it was then.
- **Energy** is the work of the pulling motors. **Violations** are steps with a section beyond its bend limit, commands faster than the bend rate, steps with a part of the arm outside a picture, and steps with a contact.
- "Without swing in the model": `model = "static"` instead of `"dynamic"` under `[arm]`.

END
  echo '```console'
  echo "\$ ./dev study servo-dynamic $targets $trajectories $seed"
  echo '```'
  echo
  # Runs are kept, so that a study that was stopped goes on; with a new program they begin anew.
  runs=build/studies/servo-dynamic.csv
  if [ "$build/bin/servo_dynamic_study" -nt "$runs" ]; then rm -f "$runs"; fi
  for part in calibrated wrong; do
    "$build/bin/servo_dynamic_study" "$targets" "$trajectories" "$seed" "$(nproc)" "$part" "" "$runs"
  done
} >build/studies/servo-dynamic.md
mv build/studies/servo-dynamic.md "$page"
echo "wrote $page"
