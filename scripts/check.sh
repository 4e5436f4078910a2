#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# All checks, the cheap and likely failures first; the release tests close it.
#   scripts/check.sh fast   format, house, the tests labelled `fast`
#   scripts/check.sh all    also: page, clang-tidy, both sanitizers, every test
set -eu
cd "$(dirname "$0")/.."
jobs=${JOBS:-$(nproc)}
started=$(date +%s)
unrandomised=

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
  $unrandomised ctest --preset "$preset" -j "$jobs" --no-label-summary --no-tests=error --progress "$@"
}

step 'format'
sh scripts/format.sh --check
step 'build: release (g++); the house check is part of it'
build release
if [ "$1" = fast ]; then
  step 'tests: release, the fast ones'
  run_tests release -L fast
  exit 0
fi
step 'clang-tidy: what differs from the last full run (make tidy is the full run)'
sh scripts/tidy.sh --changed
# The sanitizers keep their shadow memory at fixed addresses; a kernel that randomises more bits of the
# layout than they expect occasionally puts a library there.
setarch "$(uname -m)" -R true 2>/dev/null && unrandomised="setarch $(uname -m) -R" || unrandomised=
step 'build and tests: clang, AddressSanitizer, UndefinedBehaviorSanitizer'
build asan-ubsan
run_tests asan-ubsan
step 'build and tests: ThreadSanitizer (label threads)'
build tsan threads_tests
run_tests tsan -L threads
unrandomised=
step 'tests: release, all'
run_tests release
