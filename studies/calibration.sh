#!/usr/bin/env bash
# calibrations from rough guesses by each method: ./dev study calibration [SAMPLES]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
samples=${1:-} # For each row of the tables; default: as in the campaign files.
page=docs/studies/calibration.md
build=${FLEXURA_STUDY_BUILD:-build/release}

if [ -z "${FLEXURA_STUDY_BUILD:-}" ]; then
  cmake --preset release
  cmake --build "$build" --target flexura
fi
mkdir -p docs/studies build/studies
{
  cat <<'END'
# Accuracy of camera calibration

In this study, each method calibrates complete simulated rigs with rendered pictures. Each table is a [campaign](../campaigns.md) of `examples/21_calibration_study`. [Earlier measurements](calibration-earlier.md) have up to 1000 starts per method, and results that these campaigns do not measure: the required accuracy of the initial guess, errors of focal lengths, and the accuracy without image processing.

- **Pictures:** 640 x 480 px, f = 800 px at ratio 1, noise 2 to 3 of 255.
- **Cameras:** 1.5 m from the cylinder (radius 0.1 m), or 2.5 m from the arm of 1 m. The heads have steps of 0.075 degrees, unless a table says otherwise.
- **Starting errors** are uniformly distributed: 0.2 m per axis in the position of the mount, 1 degree in roll. The point at which the camera looks is shifted too, by as much as a rotation of up to 10 degrees in pan and tilt. Zoom ratios are 1 to 2.5. Each table lists the further errors of the models.
- All deviations are true values, which the simulation knows.

END
  echo '```console'
  echo "\$ ./dev study calibration${samples:+ $samples}"
  echo '```'
  echo
  echo "The results are from commit $(git rev-parse --short HEAD)."
  echo
  FLEXURA_STUDY_BUILD=$build tools/study_page.sh 21_calibration_study "$samples" bundle bundle_etalon etalon arcs arcs_paper
} >build/studies/calibration.md
mv build/studies/calibration.md "$page"
echo "wrote $page"
