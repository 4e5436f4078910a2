#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# clang-tidy over our sources: scripts/tidy.sh [--tests] [PATTERN]; see tidy.py.
set -eu
cd "$(dirname "$0")/.."
[ -e build/clang/build.ninja ] || cmake --preset clang --log-level=WARNING -Wno-dev
exec python3 scripts/tidy.py "$@"
