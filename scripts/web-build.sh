#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# scripts/web-build.sh SCRIPT FOLDER: what npm's SCRIPT builds, into FOLDER. Built once for all presets: again only where
# a source differs.
set -eu
cd "$(dirname "$0")/../web"
sh ../scripts/web-packages.sh
kept=../build/web/$1
mkdir -p "$kept" "$2"
exec 9>"$kept/lock"
flock 9
now=$(find src ./*.html ./vite.*.ts tsconfig.json package.json package-lock.json -type f -print0 | sort -z | xargs -0 sha256sum)
if [ "$now" != "$(cat "$kept/sources" 2>/dev/null)" ]; then
  npm run --silent "$1" -- --outDir "$kept/made" --emptyOutDir --logLevel warn
  printf '%s\n' "$now" >"$kept/sources"
fi
cp "$kept"/made/* "$2"
