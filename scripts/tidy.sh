#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# clang-tidy over our sources: scripts/tidy.sh [--tests] [PATTERN]; see tidy.py.
set -eu
cd "$(dirname "$0")/.."
# Every time: sources that are new since the last run must be known.
cmake --preset clang --log-level=WARNING -Wno-dev >/dev/null
exec python3 scripts/tidy.py "$@"
