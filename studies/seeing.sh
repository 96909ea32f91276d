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
  echo "# Accuracy of vision for random arms"
  echo
  echo "The study measures pictures of random arms in front of a white background. Each arm has one to four sections of equal radius. The camera is 1.2 to 3 m away, in a random direction. The cameras have no distortion. The [renderer](../renderer.md) makes pictures of 640 x 480 px with noise and blur. Noise is the standard deviation of 8-bit values. Blur is the standard deviation of the point spread function (PSF), px. The page [Vision](../vision.md) explains the measurement. An error is the distance of a measured centerline sample from the backbone's exact image. Errors are computed for samples at which both borders of the arm are visible. These samples are corrected for perspective, from the middle between the borders to the image of the backbone."
  echo
  echo "- *Median* and *90 %* are quantiles of the RMS errors of single pictures. The columns *RMS* and *99 %* are for the errors of all samples. The column *not corrected* is without the correction for perspective."
  echo "- *Interpolated* samples are not observed, because the arm covers itself, hides an end, or points at the camera there. The column *RMS with interpolated samples* includes these samples."
  echo "- *Crossing* arms are those whose backbone crosses itself in the picture."
  echo "- *Ends* is the median distance of the measured free end from the image of the backbone's end."
  echo "- *68 % / sigma* is the 68 % quantile of the errors divided by their estimated standard deviations; it should be 1."
  echo
  echo "The required RMS error of 0.02 px applies to noise 2 and PSF 0.7 px. For comparison, with these values a maximum-likelihood estimate for each line of pixels has an error of 0.013 px. The border of a binary mask has an error of 0.18 px."
  echo
  echo '```console'
  echo "\$ ./dev study seeing $cases $seed"
  echo '```'
  echo
  echo "The results are from commit $commit."
  echo
  cat "$parts/axes"
  echo
  echo "## Two views to a shape"
  echo
  echo "Two cameras view such arms from 1.5 to 3 m. The optical axes are perpendicular to within nine degrees. The noise is 0 to 4, and the PSF 0.5 to 1.2 px. Errors are RMS position errors along the arm, in % of its length."
  echo
  echo "- *Trusted* estimates have no note ([estimation](../estimation.md)), and *noted* estimates have at least one. In all other cases no shape was found."
  echo "- *Error / sigma* is the error of trusted estimates divided by its standard deviation. The columns *in 50 % region* and *in 95 % region* are the percentages of true bends inside these confidence regions of the estimate."
  echo "- Quantiles are nearest ranks. The second table compares the results with the aims."
  echo "- Two chi^2 tests check the covariance. With a correct covariance, a test statistic exceeds its bound once in a thousand studies. One test is for the mean squared error divided by its expectation. The other tests whether confidence regions in steps of 10 % contain equally many true bends. The last table has the results of both tests for different noise, for known arms."
  echo
  echo "For comparison, a neural network estimates the shape from one real picture with a mean error of 0.36 % of the length, at 70 Hz. The network was trained for one robot with two segments (Shentu et al., MoSS, 2023)."
  echo
  cat "$parts/shapes"
} >build/studies/seeing.md
mv build/studies/seeing.md "$page"
echo "wrote $page"
