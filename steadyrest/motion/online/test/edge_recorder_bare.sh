#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# edge_recorder_bare.sh SOURCE COMPILER…: the recorder compiles without a system under it, includes nothing but
# <cstddef> and <cstdint>, and needs nothing at link time but memcpy, memset and memmove.
set -eu
source=$1
here=$(dirname "$source")/..
headers=
for name in edge_event quadrature_decoder latched_decoder edge_inputs edge_ring; do
  headers="$headers $here/edges/$name.hpp"
done
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

allowed='<cstddef>|<cstdint>|<steadyrest/motion/online/edges/(edge_event|latched_decoder)\.hpp>'
# shellcheck disable=SC2086
ls $headers >/dev/null  # in the pipes below a file that is not there would go unnoticed
# shellcheck disable=SC2086
if grep -hE '^#include' $headers | grep -vE "$allowed"; then
  echo 'the recorder includes more than <cstddef> and <cstdint>' >&2
  exit 1
fi
# shellcheck disable=SC2086
if grep -nE '\b(float|double|new|delete|std::(vector|array|string))\b' $headers | grep -vE '[0-9]+: *///'; then
  echo 'the recorder is integers without allocation' >&2
  exit 1
fi
tried=0
for compiler; do
  command -v "$compiler" >/dev/null || { echo "no $compiler here: left out"; continue; }
  for level in -O0 -O2 -Os; do
    "$compiler" -std=c++20 -ffreestanding -fno-exceptions -fno-rtti -Wall -Wextra -Wconversion -Wsign-conversion -Wshadow \
      -Werror "$level" -I"$here/../../.." -c "$source" -o "$work/bare.o"
    nm -u "$work/bare.o" | awk '{print $NF}' | grep -vxE 'memcpy|memset|memmove' >"$work/undefined" || true
    if [ -s "$work/undefined" ]; then
      echo "$compiler $level leaves undefined:" >&2
      cat "$work/undefined" >&2
      exit 1
    fi
    tried=$((tried + 1))
  done
done
echo "built bare $tried times"
[ "$tried" -ge 3 ]
