#!/usr/bin/env bash
# an arm servoed to random shapes by each law: ./dev study servo [TARGETS] [SEED] [TURNED] [SAGGING]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
targets=${1:-200}
seed=${2:-1}
turned=${3:-40}  # Number of targets of the arm mounted with a quarter turn.
sagging=${4:-20} # Number of targets of the sagging arm.
page=docs/studies/servo.md
build=${FLEXURA_STUDY_BUILD:-build/release}

if [ -z "${FLEXURA_STUDY_BUILD:-}" ]; then cmake --preset release; fi
cmake --build "$build" --target servo_study
mkdir -p docs/studies build/studies
{
  echo "# Accuracy of servos for random shapes"
  echo
  cat <<'END'
In this study, servos move a simulated arm in view of two cameras to random shapes. The arm has three sections and a length of 1 m. Each section bends by at most 120 degrees, at a rate of at most 90 degrees per second.

- **Cameras:** 640 x 480 px, f = 800 px, distance 2.5 m, gray, 30 Hz, delay 60 ms, exposure 2 ms, noise 2 to 3 of 255. For "with bands" the pictures are in colour, and the arm has twelve bands, which are also used by the calibration.
- **Targets:** random shapes with bends uniformly distributed within +-1.2 rad in each direction, with four targets per rig. All laws have equal targets. The arm starts straight; for `moments` it starts within 0.15 rad of each target bend.
- **Converged:** the observed error is below 0.2 % of the length for 1 s. A servo that has not converged after 8 s fails.
- **Final errors** are true errors at the end, in % of the length. They and all other values are for converged targets only.
- **Distance to a limit** is the smallest distance of a bend from its limit during the motion, as a fraction of the limit.
- **Error with exact target pictures** is the final true error if the target pictures are exact pictures of the true cameras and the servo uses the nominal cameras. One column is without the servo's camera prior, the other column with this prior.
- **Starting errors of the calibration `bundle`:** up to 3 degrees in pan and tilt, 0.3 degrees in roll, and 6 cm along each axis. The zoom ratios are 1 to 1.45.

All targets must be reached, with an error below 2 % of the length after 2 s and a final RMS error of 0.1 %. For comparison, publications on other arms and cameras report errors of 1 mm at rest, or 1.6 % of the picture's size. Other publications report 2 to 2.6 % of the length at the tip.

END
  echo '```console'
  echo "\$ ./dev study servo $targets $seed $turned $sagging"
  echo '```'
  echo
  for part in calibrated wrong recorded; do "$build/bin/servo_study" "$targets" "$seed" "$(nproc)" "$part"; done
  "$build/bin/servo_study" "$turned" "$seed" "$(nproc)" turned
  echo "In the next tables the true arm consists of three [elastic rods](../mechanics.md): steel wires of 2 mm radius with a load"
  echo "of 0.2 kg per metre, pulled by nine tendons."
  echo
  "$build/bin/servo_study" "$sagging" "$seed" "$(nproc)" sagging
  echo "## Control laws without pictures"
  echo
  echo "In this table the laws receive the exact shape of an ideal arm, with a delay of two frames. The targets are those"
  echo "of the first table. Derivatives are half-way to the target ([eq. 20a](../control.md#laws-of-images)) or at the"
  echo "current shape. \"With noise\" adds errors to the centerline at 120 points, with a standard deviation of 0.1 px and"
  echo "constant during the motion."
  echo
  "$build/bin/servo_study" 200 "$seed" 1 exact
} >build/studies/servo.md
mv build/studies/servo.md "$page"
echo "wrote $page"
