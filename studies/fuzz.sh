#!/usr/bin/env bash
# a million seeded cases of every fuzz target, or of those named, under ASan + UBSan: ./dev study fuzz [CASES] [SEED] [TARGET...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
cases=${1:-1000000}
seed=${2:-1}
page=docs/studies/fuzz.md
mapfile -t all < <(find flexura -name '*_fuzz.cc' -exec basename {} .cc \; | sort)
targets=("${@:3}")
[ "${#targets[@]}" -gt 0 ] || targets=("${all[@]}")

# Targets that draw or read pictures take milliseconds a case. They use an optimised build (ASan alone) and run in ten
# parts, as many at a time as there are cores. Parts already done with the same program are skipped, so a stopped run
# can be continued.
is_of_scenes() { [[ " render_fuzz estimate_fuzz measure_fuzz " == *" $1 "* ]]; }
parts_of() { if is_of_scenes "$1"; then echo 10; else echo 1; fi; }
scenes=() others=()
for target in "${targets[@]}"; do
  if is_of_scenes "$target"; then scenes+=("$target"); else others+=("$target"); fi
done
if [ "${#others[@]}" -gt 0 ]; then ./dev build asan; fi
if [ "${#scenes[@]}" -gt 0 ]; then
  cmake --preset scenes
  cmake --build build/scenes --target "${scenes[@]}"
fi
export ASAN_OPTIONS=detect_leaks=1:detect_stack_use_after_return=1 UBSAN_OPTIONS=print_stacktrace=1

# Runs one part of a target. Each part has its own folder for the input that a failure leaves behind.
run_part() {
  local target=$1 part=$2 folder=$PWD/build/studies/fuzz/$1/$2 root=$PWD
  local build=asan parts
  parts=$(parts_of "$target")
  if is_of_scenes "$target"; then build=scenes; fi
  # For render_fuzz any bytes are a scene, so most inputs are drawn at random rather than mutated from the corpus. Text
  # formats reject random bytes at once.
  local fresh=0
  [ "$target" != render_fuzz ] || fresh=0.9
  mkdir -p "$folder"
  cd "$folder"
  if [ log -nt "$root/build/$build/bin/$target" ] && grep -q ", seed $((seed + part))\$" log &&
    grep -q "^$((cases / parts)) cases, no failure" log; then
    return
  fi
  "$root/build/$build/bin/$target" --corpus "$root/tests/corpus/$target" --cases "$((cases / parts))" \
    --seed "$((seed + part))" --fresh "$fresh" >log 2>&1 || {
    echo "FAILED: $folder/log" >&2
    return 1
  }
}
export -f run_part parts_of is_of_scenes
export cases seed
parts=()
for target in "${targets[@]}"; do
  for ((part = 0; part < $(parts_of "$target"); ++part)); do parts+=("$target $part"); done
done
# shellcheck disable=SC2016 # The inner shell expands the variables.
printf '%s\n' "${parts[@]}" | xargs -P "$(nproc)" -L1 bash -euo pipefail -c 'run_part "$@"' run_part

# Prints a target's table row: from this run's log, or the row already in the page.
row_of() {
  if [[ " ${targets[*]} " == *" $1 "* ]]; then
    awk -v target="$1" -v seed="$seed" -v commit="$(git rev-parse --short HEAD)" '
      / files, seed / { files = $1 }
      / cases\/s$/ { speed += $1; ++parts }
      / random throughout$/ { fresh += $1 }
      / cases, no failure$/ { cases += $1 }
      END {
        if (cases == "") exit 1
        printf "| `%s` | %d | %d | %d | %d | 0 | %d | %s |\n", target, files, cases, fresh, seed, speed / parts, commit
      }
    ' "build/studies/fuzz/$1"/*/log
  else
    grep -F "| \`$1\` |" "$page" 2>/dev/null || true
  fi
}

# Prints a target's statistics on its cases. For targets that did not run, prints the page's paragraph, including manual
# additions.
words_of() {
  if [[ " ${targets[*]} " == *" $1 "* ]]; then
    awk -v target="$1" '
      / scenes drawn, in / { drawn += $1; arm += $5; more += $12; refused += $(NF - 1) }
      END {
        if (drawn > 0)
          printf "`%s`: %d scenes drawn, with the arm in %d and something else in %d; %d scenes refused.\n",
            target, drawn, arm, more, refused
      }
    ' "build/studies/fuzz/$1"/*/log
  else
    awk -v begin="\`$1\`: " '
      index($0, begin) == 1 { is_its = 1 }
      /^$/ { is_its = 0 }
      is_its
    ' "$page"
  fi
}

mkdir -p docs/studies build/studies
{
  echo "# Fuzzing"
  echo
  echo "Each fuzz target tests one reader of external text, pictures or protocols. A fuzz target runs its corpus (\`tests/corpus/TARGET\`) and mutations of this corpus with a given seed. Targets for which any bytes are valid input also run random bytes. AddressSanitizer and LeakSanitizer are on. UndefinedBehaviorSanitizer is on too, except for targets that draw or measure pictures (GCC $(g++ -dumpfullversion)). A crash, an exception that is not caught, or a duration of over half a minute is a failure."
  echo
  echo '```console'
  echo "\$ ./dev study fuzz 1000000 1"
  echo '```'
  echo
  echo "| target | corpus files | cases | cases with only random bytes | seed | failures | cases per second | commit |"
  echo "| --- | ---: | ---: | ---: | ---: | ---: | ---: | --- |"
  for target in "${all[@]}"; do row_of "$target"; done
  echo
  for target in "${all[@]}"; do
    words=$(words_of "$target")
    [ -z "$words" ] || printf '%s\n\n' "$words"
  done
  echo "Speeds were measured with the sanitized build on a shared machine. If targets are named after the command, only these run, and the other rows of the table are kept."
} >build/studies/fuzz.md
mv build/studies/fuzz.md "$page"
echo "wrote $page"
