#!/usr/bin/env bash
# checks of random motions held against dense samples: ./dev study safety [MOTIONS] [SAMPLES]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
motions=${1:-1000}
samples=${2:-100000}
page=docs/studies/safety.md

./dev build release
log=build/studies/safety.log
mkdir -p build/studies docs/studies
FLEXURA_SAFETY_CASES=$((motions / 5)) FLEXURA_SAFETY_SAMPLES=$samples \
  build/release/bin/safety_full_test --gtest_filter='MotionCheckFull.*' >"$log"
value() { awk -v name="$1" '$1 == name { print $2 }' "$log"; }
{
  echo "# Checks of motions against dense samples"
  echo
  echo "Random motions (holds, point to point, sines, linear and smooth keyframes) of random spatial arms with random"
  echo "limits, checked as [docs/safety.md](../safety.md) tells, and sampled at $samples even steps each."
  echo
  echo '```console'
  echo "\$ ./dev study safety $motions $samples"
  echo '```'
  echo
  echo "| | |"
  echo "| --- | ---: |"
  echo "| motions | $(value motions) |"
  echo "| samples | $(value samples) |"
  echo "| spans that the check reported | $(value spans) |"
  echo "| values in samples above their limit | $(value above) |"
  echo "| of these outside every reported span (missed) | $(value missed) |"
  echo "| reported spans that no sample confirms (refuted) | $(value refuted) |"
} >"$page.new"
mv "$page.new" "$page"
echo "wrote $page"
