#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# clang-format over all of our sources; --check only reports what it would change, and fails.
set -eu
cd "$(dirname "$0")/.."
mode=-i
[ "${1:-}" = --check ] && mode='--dry-run -Werror'
folders=
for folder in steadyrest tests bench examples; do
  [ -d "$folder" ] && folders="$folders $folder"
done
# shellcheck disable=SC2086
find $folders -type f \( -name '*.hpp' -o -name '*.cpp' \) -print0 |
  xargs -0 -P "$(nproc)" -n 40 clang-format-19 $mode
