#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# All checks, the cheap and likely failures first; the release tests close it.
#   scripts/check.sh fast   format, house, the tests labelled `fast`
#   scripts/check.sh all    also: page, clang-tidy, clang, both sanitizers, every test
set -eu
cd "$(dirname "$0")/.."
jobs=${JOBS:-$(nproc)}
started=$(date +%s)

step() {
  now=$(date +%s)
  printf '\n== %3d:%02d  %s\n' $(((now - started) / 60)) $(((now - started) % 60)) "$1"
}

build() { # preset [targets…]
  preset=$1
  shift
  [ -e "build/$preset/build.ninja" ] || cmake --preset "$preset" --log-level=WARNING -Wno-dev
  cmake --build --preset "$preset" -j "$jobs" --target "${@:-all}"
}

run_tests() { # preset [ctest options…]
  preset=$1
  shift
  ctest --preset "$preset" -j "$jobs" --no-label-summary --no-tests=error --progress "$@"
}

step 'format'
sh scripts/format.sh --check
step 'build: release (g++); the house check is part of it'
build release
step 'tests: release, the fast ones'
if [ "$1" = fast ]; then
  run_tests release -L fast
  exit 0
fi
run_tests release -L fast

step 'clang-tidy'
sh scripts/tidy.sh
# What ships, by the second compiler: its tests would take the time that the whole run may take, and
# the sanitizers run them all.
step 'build: clang'
build clang steadyrest steadyrest_first_cut steadyrest_motion_estimate
step 'build and tests: AddressSanitizer, UndefinedBehaviorSanitizer'
build asan-ubsan
run_tests asan-ubsan
step 'build and tests: ThreadSanitizer (label threads)'
build tsan threads_tests
# ThreadSanitizer of g++ 12 needs the address layout of an older kernel.
setarch "$(uname -m)" -R true 2>/dev/null && unrandomised="setarch $(uname -m) -R" || unrandomised=
$unrandomised ctest --preset tsan -j "$jobs" -L threads --no-label-summary --no-tests=error --progress
step 'tests: release, all'
run_tests release
