#!/usr/bin/env bash
# Runs campaigns, or goes on with them, and writes their tables: study_page.sh FOLDER SAMPLES CAMPAIGN...
# FOLDER is in examples/. SAMPLES: samples of each campaign, or "" for those of its file. The rows are in build/studies.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
folder=$1
samples=$2
shift 2
build=${FLEXURA_STUDY_BUILD:-build/release}
flexura=$build/bin/flexura
mkdir -p build/studies
for campaign in "$@"; do
  rows=build/studies/$folder-$campaign${samples:+-$samples}.db
  "$flexura" campaign "examples/$folder/$campaign.toml" --out "$rows" ${samples:+--set "samples=$samples"} >&2
  rm -f "$rows.md"
  "$flexura" export "$rows" --to markdown --out "$rows.md" >&2
  sed 's/^# /## /' "$rows.md"
  echo
done
