#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Builds the OPC UA bridge, one file that needs Node alone:
#   scripts/opcua-bridge.sh OUTPUT    e.g. build/release/libexec/steadyrest/opcua-bridge.cjs
# Without OUTPUT it only brings the packages up to the lock file.
set -eu
[ $# -eq 0 ] || set -- "$(realpath -m "$1")"
cd "$(dirname "$0")/../steadyrest/adapters/opcua/bridge"

mark=node_modules/.package-lock.json # npm writes it last
current() { [ -e "$mark" ] && [ ! package-lock.json -nt "$mark" ]; }
if ! current; then
  # Two builds at once must not both do it.
  exec 9>.npm.lock
  flock 9
  if ! current; then
    echo "Installing the OPC UA bridge's packages (npm ci)"
    npm ci --no-audit --no-fund --loglevel=error
    touch "$mark"
  fi
fi
[ $# -gt 0 ] || exit 0
mkdir -p "$(dirname "$1")"
node build.mjs "$1.new"
mv "$1.new" "$1"
