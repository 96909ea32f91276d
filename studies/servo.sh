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
  echo "# Steering to random shapes"
  echo
  cat <<'END'
A simulated arm of three sections and 1 m (at most 120 degrees and 90 degrees a second a section) before two cameras.

| condition | value |
| --- | --- |
| cameras | 640 x 480 px, f = 800 px, 2.5 m away, gray, 30 Hz, 60 ms late, 2 ms exposure, noise 2 to 3 of 255 |
| "with bands" | colour pictures, twelve bands, which also calibrate the rig |
| targets | from straight to bends drawn evenly from +-1.2 rad in each direction, the same for each law; `moments` begins within 0.15 rad of each bend; four targets a rig |
| done | observed error below 0.2 % of the length for 1 s; given up after 8 s |
| left | true error at the end, % of the length; all figures are of converged targets |
| floor | true error at the end if the target images are exact ones of the true cameras and the servo uses the nominal cameras; without and with the servo's camera prior |
| rigs before `bundle` | off by up to 3 degrees in pan and tilt, 0.3 in roll, 6 cm along each axis; zoom 1 to 1.45 |

Required: all targets, within 2 % after 2 s, 0.1 % left (rms). Other systems (other arms and cameras) report 1 mm at rest, 1.6 % of the picture's size, 2 to 2.6 % of the length at the tip.

END
  echo '```console'
  echo "\$ ./dev study servo $targets $seed $turned $sagging"
  echo '```'
  echo
  for part in calibrated wrong recorded; do "$build/bin/servo_study" "$targets" "$seed" "$(nproc)" "$part"; done
  "$build/bin/servo_study" "$turned" "$seed" "$(nproc)" turned
  echo "In the next tables the true arm is three [elastic rods](../mechanics.md): steel wires of 2 mm radius that"
  echo "carry 0.2 kg a metre, pulled by nine tendons."
  echo
  "$build/bin/servo_study" "$sagging" "$seed" "$(nproc)" sagging
  echo "## The same targets without pictures"
  echo
  echo "Here laws get the exact shape of an ideal arm, two frames late. Derivatives are those of the whole way"
  echo "([eq. 20a](../control.md#laws-of-images)) or at the current shape. \"With noise\": axes 0.1 px aside (standard"
  echo "deviation, at each of 120 places, constant along the way)."
  echo
  "$build/bin/servo_study" 200 "$seed" 1 exact
} >build/studies/servo.md
mv build/studies/servo.md "$page"
echo "wrote $page"
