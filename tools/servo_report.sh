#!/usr/bin/env bash
# The report of examples/06_shape_servo and the pictures of it that the documents show, made anew: docs/shape-servo.
# usage: tools/servo_report.sh [PROGRAM]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

program=${1:-build/release/bin/flexura}
out=docs/shape-servo
results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT
"$program" run examples/06_shape_servo/experiment.toml --out "$results/run" >/dev/null
cp "$results/run/report.html" "$out/report.html"
for when in first last; do cp "$results/run/figures/servo-2-front-$when.svg" "$out/swan-front-$when.svg"; done
for when in before after; do
  cp "$results/run/figures/calibration-1-side-$when.svg" "$out/calibration-side-$when.svg"
done
