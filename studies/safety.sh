#!/usr/bin/env bash
# checks of random motions compared with dense samples: ./dev study safety [MOTIONS] [SAMPLES] [SEED]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
motions=${1:-1000}
samples=${2:-100000}
seed=${3:-1}
page=docs/studies/safety.md
build=${FLEXURA_STUDY_BUILD:-build/release}

if [ -z "${FLEXURA_STUDY_BUILD:-}" ]; then cmake --preset release; fi
cmake --build "$build" --target safety_study
mkdir -p docs/studies build/studies
{
  echo "# Safety checks compared with dense samples"
  echo
  echo "The arms are random and have one to six sections (every fourth arm is planar), with random limits and radii. Around each arm are a random plane, ball, rod and box. Each arm performs eight motions. Four motions are a hold, a move with the law \`linear\` (\`minimum_jerk\` in the last section), a trapezoid and a sine. The other motions are linear keyframes, smooth keyframes, a trapezoid with rates and accelerations per section, and a move of the tip. Planar arms also perform two motions in cord angles: a move with a law per section, and a sine. Each motion is checked ([safety](../safety.md)) and sampled at $samples evenly spaced times by independent code ([limits](../../tests/support/sampled_check.h), [clearances](../../tests/support/sampled_clearance.h)). Only the motions, section frames and distances of points from obstacles are computed by the code of the simulator."
  echo
  echo "- Bends, mean bend rates, stretches and folding are computed at every sample."
  echo "- Clearances of the arm from itself and from obstacles are computed by points and descents at every hundredth sample. They are also computed at every sample between, if a contact that the check does not report is possible there."
  echo "- For every section and obstacle, and every pair of sections, the samples are compared with the time spans that the check reports. Each reported worst value is compared with the samples, and with the state at the reported time. For pairs of sections this comparison is accurate to 1 % of the length, because points closer than this may be neighbours."
  echo "- The tolerances are 1e-4 s for the times of contacts and 2e-6 m for their depth. For worst values without a stated uncertainty the tolerance is 1e-4 (relative; m for depths)."
  echo
  echo '```console'
  echo "\$ ./dev study safety $motions $samples $seed"
  echo '```'
  echo
  "$build/bin/safety_study" "$motions" "$samples" "$seed"
} >build/studies/safety.md
mv build/studies/safety.md "$page"
echo "wrote $page"
