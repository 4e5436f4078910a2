#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The layer at work, with its page: `make demo`. Ctrl-C ends all of it.
#   MACHINE, PROGRAM   what is cut where; by default the rib pocket on the 840D
#   LISTEN             [ADDRESS:]PORT of the page; by default 8080 of this computer
set -eu
cd "$(dirname "$0")/.."
[ "${PORT:-sim}" != linuxcnc ] || exec sh scripts/linuxcnc/demo.sh
machine=${MACHINE:-examples/machines/vmc-840d.toml}
program=${PROGRAM:-examples/programs/rib-pocket.mpf}
folder=$(mktemp -d)
# A copy, so that changes on the page leave the example as it is.
cp "$machine" "$folder/machine.toml"
trap 'rm -rf "$folder"' EXIT
trap : INT TERM
echo "The page shows the layer cutting $program again and again. Ctrl-C ends it."
build/release/bin/steadyrest run --machine "$folder/machine.toml" --program "$program" --repeat \
  --mode act --record "$folder/runs" --socket "$folder/steadyrest.sock" --listen "${LISTEN:-8080}"
