#!/usr/bin/env bash
# servos of an arm to random shapes by each law: ./dev study servo [SAMPLES] [CALIBRATED]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
samples=${1:-}             # For each row of the tables; default: as in the campaign files.
calibrated=${2:-$samples} # For each row of the tables whose runs begin with a calibration; 0: omit these tables.
page=docs/studies/servo.md
build=${FLEXURA_STUDY_BUILD:-build/release}

if [ -z "${FLEXURA_STUDY_BUILD:-}" ]; then
  cmake --preset release
  cmake --build "$build" --target flexura
fi
mkdir -p docs/studies build/studies
{
  cat <<'END'
# Accuracy of servos for random shapes

In this study, servos move a simulated arm in view of two cameras to random shapes. Each table is a [campaign](../campaigns.md) of `examples/20_servo_study`. [Earlier measurements](servo-earlier.md) have 200 targets per row, and results that these campaigns do not measure: targets given by pictures, the smallest errors that wrong cameras permit, and control laws without pictures.

- **Arm:** three sections, length 1 m. Each section bends by at most 120 degrees, at a rate of at most 90 degrees per second.
- **Cameras:** 640 x 480 px, f = 800 px, distance 2.5 m, gray, 30 Hz, delay 60 ms, exposure 2 ms, noise 2 to 3 of 255.
- **Targets:** random shapes with bends uniformly distributed within +-1.2 rad in each direction. All rows of a table have equal targets. The arm starts straight.
- **Converged:** the observed error is below 0.2 % of the length for 1 s. A servo that has not converged after 8 s fails.
- **Final errors** are true errors at the end, in % of the length. All values are for runs that are done only.

END
  echo '```console'
  echo "\$ ./dev study servo${samples:+ $samples}${2:+ $2}"
  echo '```'
  echo
  echo "The results are from commit $(git rev-parse --short HEAD)."
  echo
  export FLEXURA_STUDY_BUILD=$build
  tools/study_page.sh 20_servo_study "$samples" wrong learned near turned sagging
  if [ "$calibrated" = 0 ]; then
    echo "The tables of servos after a calibration (\`arcs\`, \`rods\`, \`calibrated\`) are omitted."
  else
    tools/study_page.sh 20_servo_study "$calibrated" arcs rods calibrated
  fi
} >build/studies/servo.md
mv build/studies/servo.md "$page"
echo "wrote $page"
