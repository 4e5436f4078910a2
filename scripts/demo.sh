#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The layer at work, with its page: `make demo`. Ctrl-C ends all of it; the records stay in out/demo.
#   MACHINE, PROGRAM    what is cut where; by default the rib pocket on the 840D with a spindle that warms up
#   PROCESS, DEPTH_MM   the cut, for the vibration; by default a slot of 0.4 mm that chatters at 6000 rpm; PROCESS= none
#   LISTEN              [ADDRESS:]PORT of the page; by default 8080 of this computer
#   FOR_S               ends after so many seconds
#   LAYER               the program; by default the one of build/release
set -eu
cd "$(dirname "$0")/.."
[ "${PORT:-sim}" != linuxcnc ] || exec sh scripts/linuxcnc/demo.sh
program=${PROGRAM:-examples/programs/rib-pocket.mpf}
process=${PROCESS-examples/processes/slot-922hz.toml}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
# A copy, so that changes on the page leave the file as it is.
set -- examples/machines/vmc-840d.toml examples/demo/rooms.toml
[ -z "${MACHINE:-}" ] || set -- "$MACHINE"
cat "$@" >"$folder/machine.toml"
trap : INT TERM
echo "The page shows the layer cutting $program again and again. Ctrl-C ends it."
"${LAYER:-build/release/bin/steadyrest}" run --machine "$folder/machine.toml" --program "$program" --repeat \
  ${process:+--process "$process" --depth-mm "${DEPTH_MM:-0.4}"} \
  --mode act --record out/demo --socket "$folder/steadyrest.sock" --listen "${LISTEN:-8080}" ${FOR_S:+--for-s "$FOR_S"}
