#!/usr/bin/env bash
# an arm servoed for a simulated day, what drifts and grows: ./dev study endurance [HOURS] [SEED]
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
  echo "A simulated arm of three sections and 1 m before two cameras of 320 x 240 px, f = 400 px, 2.5 m away: pictures in"
  echo "gray, 60 ms late, 2 ms exposure, noise of the light and of 1 of 255. Wanted are two shapes in turn, each for 3 s, with 2 s"
  echo "on the way from one to the other, again and again; \`law = \"shape\"\`, all else as it is when nothing is said. It is one"
  echo "servo at the ports, from its first step to its last (\`ServoConfig::keeps_steps\` is false: a list of all steps grows"
  echo "by its nature). A day at 30 pictures a second would be 5 million of them and hours of a processor, so a step is a second in the first"
  echo "part, with pictures as full as ever, which lets everything that goes by time go on for a day: clocks, the tracker's belief, the cameras'"
  echo "doubted errors, histories; the second part has what goes by the number of steps at the usual 30 a second for a"
  echo "24th of that time."
  echo
  echo "Errors are the simulated truth's at the time of the pictures, root mean square along the arm in % of its length: at"
  echo "rest in the last second of each rest, where the phase is the same each time, and on the way. The first row of the"
  echo "first part has the one picture of the very first rest, too, in which the arm, straight at the start, is still on its way"
  echo "to the first shape: its large error is of that picture alone. *Held back*: steps of which the limiter sent"
  echo "something else than the law asked for; *told*: lines that the servo had to say, faults among them. *Level*: the errors of"
  echo "the last quarter are no more than a tenth above those of the first one (less its first row); in the last quarter the"
  echo "heap grows by less than 4 bytes a step, where a number kept of each would be 8, and the resident memory by"
  echo "no more than that and 256 kB. What grows at first are the borders' filters, which each camera's finder makes as they are first"
  echo "asked for (\`BlurredSteps\`, 4 MB a camera with all of them, fewer and fewer new ones an hour: a run of less than some ten hours is not level yet), and in"
  echo "the first minute the servo's histories."
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
