#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Brings web/node_modules up to web/package-lock.json; does nothing when it is.
set -eu
cd "$(dirname "$0")/../web"

mark=node_modules/.package-lock.json # npm writes it last
current() { [ -e "$mark" ] && [ ! package-lock.json -nt "$mark" ]; }

current && exit 0
# Two builds at once must not both do it.
exec 9>.npm.lock
flock 9
current && exit 0
echo "Installing the page's packages (npm ci)"
npm ci --no-audit --no-fund --loglevel=error
touch "$mark"
