#!/usr/bin/env bash
# an arm servoed for a simulated day, to see which errors and memory grow: ./dev study endurance [HOURS] [SEED]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
hours=${1:-24}
seed=${2:-1}
page=docs/studies/endurance.md
build=${FLEXURA_STUDY_BUILD:-build/release}

if [ -z "${FLEXURA_STUDY_BUILD:-}" ]; then cmake --preset release; fi
cmake --build "$build" --target endurance_study
mkdir -p docs/studies build/studies
status=0
{
  echo "# Endurance of the servo"
  echo
  echo "In this study, one servo controls a simulated arm for a simulated day. The arm has three sections and a length of 1 m. Two cameras are at a distance of 2.5 m. They have 320 x 240 px, f = 400 px, gray pictures, 60 ms delay and 2 ms exposure. The noise is photon noise and 1 of 255. The target alternates between two shapes, with 3 s at each and 2 s between. The servo has \`law = \"shape\"\`, \`ServoConfig::keeps_steps\` false (because a list of steps would grow), and otherwise defaults."
  echo
  echo "The first part has one step per second for a day. It tests dependence on time: clocks, the tracker's model, camera errors, histories. The second part has 30 steps per second for 1/24 of a day, and tests dependence on the number of steps."
  echo
  echo "- Errors are true RMS errors along the arm at the time of the pictures, in % of its length. The column *at rest* is for the last second at each shape. The column *moving* is for the time between the shapes. The first error is large because of one picture, in which the straight arm still moves to the first shape."
  echo "- *Limited* is the number of steps that the limiter changed. *Messages* is the number of messages of the servo, including errors."
  echo "- *Steady* means that a quantity does not grow. Errors in the last quarter may exceed those in the first quarter (without its first row) by at most 10 %. The heap may grow by under 4 bytes per step (a stored number has 8 bytes). Resident memory may grow by at most 256 kB more than the heap."
  echo "- Memory grows at the beginning for two reasons. Border filters are computed on demand (\`BlurredSteps\`, 4 MB per camera in all), so runs under ten hours are not steady. The servo's history buffers become full within the first minute."
  echo
  echo '```console'
  echo "\$ ./dev study endurance $hours $seed"
  echo '```'
  echo
  "$build/bin/endurance_study" "$hours" "$seed" || status=$?
} >build/studies/endurance.md
mv build/studies/endurance.md "$page"
echo "wrote $page"
exit "$status"
