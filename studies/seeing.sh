#!/usr/bin/env bash
# centerlines, markers and two-view shapes of random arms against true values: ./dev study seeing [CASES] [SEED]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
cases=${1:-10000}
seed=${2:-1}
page=docs/studies/seeing.md
build=${FLEXURA_STUDY_BUILD:-build/release}

if [ -z "${FLEXURA_STUDY_BUILD:-}" ]; then cmake --preset release; fi
cmake --build "$build" --target seeing_study shape_study
# The commit that the programs were built from, and whether it has changes.
sources=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$build/CMakeCache.txt")
commit=$(git -C "$sources" describe --always --exclude '*' --abbrev=7 --dirty=', changed')
mkdir -p docs/studies build/studies
parts=$(mktemp -d)
trap 'rm -r "$parts"' EXIT
"$build/bin/seeing_study" "$cases" "$seed" >"$parts/axes" &
"$build/bin/shape_study" "$cases" "$seed" >"$parts/shapes"
wait $!
{
  echo "# Seeing random arms"
  echo
  echo "Random arms of one to four sections and one radius, before white, 1.2 to 3 m away, from any side. Cameras without distortion; pictures of 640 x 480 px by the [renderer](../renderer.md) with noise (standard deviation of 8-bit values) and blur (PSF, px), measured as in [vision](../vision.md). Errors are distances of samples with both borders visible, after correction for the camera, from the backbone's exact image."
  echo
  echo "- *Median*, *90 %*: of each picture's rms. *rms*, *99 %*: all samples. *Middle*: without correction."
  echo "- *Not observed*: samples bridged where the arm covers itself, hides an end, or points at the camera. *Bridged ones too* includes them."
  echo "- *Cross themselves*: arms with a crossing in the backbone's image."
  echo "- *Ends*: median distance of free ends from the backbone's."
  echo
  echo "The aim of 0.02 px is for noise 2, PSF 0.7 px. There, a maximum-likelihood estimate per pixel line reaches 0.013 px, a mask's border 0.18 px."
  echo
  echo '```console'
  echo "\$ ./dev study seeing $cases $seed"
  echo '```'
  echo
  echo "Of commit $commit."
  echo
  cat "$parts/axes"
  echo
  echo "## Two views to a shape"
  echo
  echo "Such arms before two cameras, 1.5 to 3 m away, perpendicular within nine degrees; noise 0 to 4, PSF 0.5 to 1.2 px. Errors are rms position errors along the arm, % of its length."
  echo
  echo "- *Trusted* answers have no note ([estimating](../estimation.md)), *marked* ones have; the rest was not found."
  echo "- For trusted answers: *over sigma*, error over standard deviation; *within 50 %, 95 %*, share of true bends inside these covariance regions."
  echo "- Quantiles are nearest ranks. The second table has aims and verdicts."
  echo "- Two chi^2 tests, with bounds exceeded once in a thousand: mean squared error over covariance, and uniformity of the regions (ten parts). The last table has both by noise, for known arms."
  echo
  echo "For comparison, on real pictures: a network trained on one two-segment robot reaches 0.36 % of the length on average from one picture, at 70 Hz (C. Shentu et al., MoSS, 2023)."
  echo
  cat "$parts/shapes"
} >build/studies/seeing.md
mv build/studies/seeing.md "$page"
echo "wrote $page"
