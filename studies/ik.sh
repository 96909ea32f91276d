#!/usr/bin/env bash
# inverse kinematics of random targets in and out of reach: ./dev study ik [TARGETS] [UNREACHABLE] [SEED]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
targets=${1:-100000}
unreachable=${2:-10000}
seed=${3:-1}
page=docs/studies/ik.md
build=${FLEXURA_STUDY_BUILD:-build/release}

if [ -z "${FLEXURA_STUDY_BUILD:-}" ]; then cmake --preset release; fi
cmake --build "$build" --target ik_study
mkdir -p docs/studies build/studies
{
  echo "# Inverse kinematics"
  echo
  echo "Random arms of three spatial sections of 0.15 to 0.4 m, their bends limited to an angle between 60 and 180"
  echo "degrees, one for each arm; targets where a random state within the limits, evenly over the disks of bends,"
  echo "has its tip. Solved from nothing, with the default tolerances (1e-9 of the arm's length; 1e-9 rad) and"
  echo "starts. \"Wrong\" would be an answer that the model's own forward kinematics does not confirm to twice that."
  echo "The targets out of reach are so by construction, without the code under test ([how](../../tests/support/inverse_targets.h))."
  echo "The pose answered as the nearest to one is \"beaten\" when something that knows neither derivatives nor the search"
  echo "comes nearer by more than 1e-6 of its distance (with a direction, of the position over the arm's length and the"
  echo "angle together, and by more than 1e-4, for the search ends a little before the bottom of long valleys): 1,000 random poses, and descents of 400 random steps each from the pose itself and"
  echo "from the five best of these. The study fails when one is beaten, an answer is wrong, or fewer than 99.9 % of the"
  echo "targets in reach are found (bends up to 360 degrees: 99 %)."
  echo
  echo '```console'
  echo "\$ ./dev study ik $targets $unreachable $seed"
  echo '```'
  echo
  "$build/bin/ik_study" "$targets" "$unreachable" "$seed"
} >build/studies/ik.md
mv build/studies/ik.md "$page"
echo "wrote $page"
