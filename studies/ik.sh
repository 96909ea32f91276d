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
  echo "The study solves inverse kinematics for random arms of three spatial sections of 0.15 to 0.4 m. Each arm has one bend limit between 60 and 180 degrees. Targets are tip poses of random states, whose bends are uniformly distributed over their disks. The solver has no initial shape, the default tolerances (1e-9 of the length; 1e-9 rad), and the default starting states."
  echo
  echo "- *Wrong*: by forward kinematics, the error of the answer is over twice the tolerance."
  echo "- Unreachable targets are constructed without the tested code ([method](../../tests/support/inverse_targets.h))."
  echo "- *Beaten*: a derivative-free search finds a state whose distance from the target is smaller than that of the answer by over 1e-6 of the distance. For targets with a direction, the distance combines the position error divided by the length and the angle error. The limit is then 1e-4 instead of 1e-6, because the solver stops early in long, narrow valleys of the error. The search uses 1,000 random poses, and random descents of 400 steps from the answer and the five best poses."
  echo "- The study fails if an answer is beaten or wrong, or if under 99.9 % of the reachable targets are solved (for bends up to 360 degrees: 99 %)."
  echo
  echo '```console'
  echo "\$ ./dev study ik $targets $unreachable $seed"
  echo '```'
  echo
  "$build/bin/ik_study" "$targets" "$unreachable" "$seed"
} >build/studies/ik.md
mv build/studies/ik.md "$page"
echo "wrote $page"
