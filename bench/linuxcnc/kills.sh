#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# kills.sh [KILLS [SEED]]: kills the layer 200 times in the cut on LinuxCNC, in about ten minutes, and prints how the feed came back
# (tests/linuxcnc/kills_test.cpp). Needs the release build, LinuxCNC and root.
set -eu
cd "$(dirname "$0")/../.."
STEADYREST_KILLS=${1:-200} STEADYREST_SEED=${2:-1} exec build/release/bin/steadyrest_linuxcnc_kills_test
