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
  echo "# Accuracy of servos for an arm that swings"
  echo
  cat <<'END'
The true arm consists of three [elastic rods](../mechanics.md) with a total length of 1 m. It is upright in view of two cameras. Nine tendons with stepper motors pull the arm. The model of the arm differs from the true arm:

| part of the rig | true value | model |
| --- | --- | --- |
| rods | nickel-titanium wires of 1.7 mm radius with 0.15 kg/m, damping time 10 ms; 20 % stiffer or softer | 54 GPa |
| payload at the tip | up to 40 g | none |
| tendons | 15 mm from the backbone, compliance 0.03 mm/N, friction coefficient 0.02 | compliance 0.025 mm/N, no friction |
| drives | 3200 microsteps per turn, spools of 10 mm radius, backlash 0.2 degrees, pretension 10 N | backlash 0.15 degrees |
| cameras | 640 x 480 px, f = 800 px, distance 2.5 m, gray, 30 Hz, delay 60 ms, noise 2 of 255 | see the tables |

Each servo uses a new rig and starts at rest in the straight shape. It uses neither true values nor results of other servos. Targets and trajectories are distributed over ten true arms.

- **Target shapes** are equilibrium shapes of the true arm for random bends, uniformly distributed within +-1.2 rad in each direction. During the motion, a force of 0.5 N pushes the tip for 0.1 s. A servo has converged if the observed error is below 0.2 % of the length for 1 s. It fails after 5 s. The final error is the true RMS error over the arm and the last second, in % of the length, for all targets.
- **Moving targets** last 6 s. The bends of each section are sums of two sine waves in each direction, of up to 0.5 rad and 2 rad/s each. The lag is the time shift for which the arm fits the target best. The error is the true RMS distance from the moving target, in % of the length. If a servo ends early, its last shape is used for the remaining time.
- **Energy** is the work of the motors while they pull.
- **Violations** are commands above the largest bend rate, and steps with a section beyond its bend limit, a part of the arm outside a picture, or contact.
- **Without swing in the model** means `model = "static"` instead of `model = "dynamic"` under `[arm]`.

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
