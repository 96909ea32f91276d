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
  echo "Random arms of three spatial sections of 0.15 to 0.4 m with one bend limit per arm, 60 to 180 degrees. Targets are tips of random states, uniform over the disks of bends. Solved from nothing with default tolerances (1e-9 of the length; 1e-9 rad) and starts."
  echo
  echo "- *Wrong*: forward kinematics does not confirm the answer within twice the tolerance."
  echo "- Out-of-reach targets are so by construction, without the tested code ([how](../../tests/support/inverse_targets.h))."
  echo "- *Beaten*: a derivative-free search comes closer than the nearest pose by over 1e-6 of its distance. With direction: position over length and angle combined, over 1e-4, as the solver stops early in long valleys. That search uses 1,000 random poses and 400-step random descents from the answer and the five best."
  echo "- The study fails if an answer is beaten or wrong, or under 99.9 % of reachable targets are found (bends up to 360 degrees: 99 %)."
  echo
  echo '```console'
  echo "\$ ./dev study ik $targets $unreachable $seed"
  echo '```'
  echo
  "$build/bin/ik_study" "$targets" "$unreachable" "$seed"
} >build/studies/ik.md
mv build/studies/ik.md "$page"
echo "wrote $page"
