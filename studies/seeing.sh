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
  echo "The study measures pictures of random arms in front of a white background. Each arm has one to four sections of equal radius and is 1.2 to 3 m from the camera, which views it from any side. The cameras have no distortion. The [renderer](../renderer.md) makes pictures of 640 x 480 px with noise (standard deviation of 8-bit values) and blur (standard deviation of the point spread function PSF, px). They are measured as in [vision](../vision.md). An error is the distance of a measured centerline sample from the backbone's exact image. Samples count where both borders of the arm are visible; they are corrected from the middle between the borders to the image of the backbone (perspective)."
  echo
  echo "- *Median* and *90 %* are quantiles of the pictures' rms errors. *rms* and *99 %* are of the errors of all samples. *Middle* is without the correction."
  echo "- *Not observed* samples are interpolated where the arm covers itself, hides an end, or points at the camera. *Bridged ones too* includes these samples."
  echo "- *Cross themselves* counts arms whose backbone crosses itself in the picture."
  echo "- *Ends* is the median distance of the measured free end from the image of the backbone's end."
  echo
  echo "The required rms error of 0.02 px applies to noise 2 and PSF 0.7 px. With these values a maximum-likelihood estimate for each line of pixels reaches 0.013 px, and the border of a binary mask 0.18 px."
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
  echo "Two cameras view arms of the same kind from 1.5 to 3 m. The cameras' axes are perpendicular to within nine degrees; noise is 0 to 4, PSF 0.5 to 1.2 px. Errors are rms position errors along the arm, % of its length."
  echo
  echo "- *Trusted* estimates have no note ([estimating](../estimation.md)); *marked* estimates have at least one. In the other cases no shape was found."
  echo "- For trusted estimates, *over sigma* is the error divided by its standard deviation. *Within 50 %, 95 %* is the share of true bends inside the estimate's confidence regions of 50 % and 95 %."
  echo "- Quantiles are nearest ranks. The second table compares the results with the requirements (*aim*)."
  echo "- Two chi^2 tests check the covariance, with bounds that a correct covariance exceeds once in a thousand studies. One tests the mean squared error divided by the covariance, the other whether confidence regions in steps of 10 % hold equally many true bends. The last table has both tests by noise, for known arms."
  echo
  echo "For comparison, on real pictures: a network trained on one two-segment robot reaches 0.36 % of the length on average from one picture, at 70 Hz (C. Shentu et al., MoSS, 2023)."
  echo
  cat "$parts/shapes"
} >build/studies/seeing.md
mv build/studies/seeing.md "$page"
echo "wrote $page"
