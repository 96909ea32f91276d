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
  echo "# A day of servoing"
  echo
  echo "Two cameras, 2.5 m away, observe a simulated arm of three sections and 1 m. They have 320 x 240 px, f = 400 px, gray, 60 ms delay, 2 ms exposure, photon noise and 1 of 255. Two target shapes alternate: 3 s each, 2 s between; \`law = \"shape\"\`, otherwise defaults. One servo runs at the ports with \`ServoConfig::keeps_steps\` false, because a list of steps would grow. The first part has one step per second for a day and tests what depends on time: clocks, the tracker's model, camera errors, histories. The second tests what depends on steps: 30 per second for 1/24 of that time."
  echo
  echo "- Errors are true rms errors along the arm at picture time, % of its length: *at rest* in each rest's last second, and *on the way*. The large first error is one picture, when the straight arm still moves to the first shape."
  echo "- *Held back*: steps changed by the limiter. *Messages*: of the servo, errors included."
  echo "- *Level*: three conditions hold. Last-quarter errors are at most 10 % above the first quarter (without its first row). The heap grows by under 4 bytes a step (a stored number takes 8). Resident memory grows by at most 256 kB more than that."
  echo "- Early growth: border filters, created on demand (\`BlurredSteps\`, 4 MB a camera in all; runs under ten hours are not level), and the servo's histories in the first minute."
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
