#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Line and branch coverage of steadyrest/ by all tests; needs Debian's package gcovr.
set -eu
cd "$(dirname "$0")/.."
command -v gcovr >/dev/null || { echo 'scripts/coverage.sh: gcovr is missing; apt-get install gcovr' >&2; exit 1; }
[ -e build/coverage/build.ninja ] || cmake --preset coverage --log-level=WARNING -Wno-dev
cmake --build --preset coverage
find build/coverage -name '*.gcda' -delete
ctest --preset coverage -j "$(nproc)"
mkdir -p out/coverage
gcovr --root . --filter steadyrest/ --exclude '.*/test/.*' --exclude-throw-branches \
  --html-details out/coverage/index.html --print-summary build/coverage
echo 'Details: out/coverage/index.html'
