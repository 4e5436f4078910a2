#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# measure.sh PROGRAM [LOG]: how many servo periods (1 ms) LinuxCNC's motion takes for PROGRAM.
# DRIVE=live.py PROBE=… HAL="lag.hal layer.hal layer_offsets.hal lag_log.hal" by environment: another driver, the program that it calls, other HAL
# files; DRIVE_ARGS: what the driver gets after PROGRAM and LOG; whatever the driver leaves beside its log is copied to LOG's folder.
# Limits by environment: VX VY VZ (mm/s), AX AY AZ (mm/s²), VPATH_MM_S, APATH, MAX_OVERRIDE; the defaults are those of
# examples/machines/linuxcnc-mill.toml.
# LinuxCNC runs headless in its own namespaces, as an unprivileged user; needs root. Exit status 77: cannot run here.
set -u
here=$(cd "$(dirname "$0")" && pwd)
command -v linuxcnc >/dev/null && command -v halsampler >/dev/null || { echo "linuxcnc is not installed" >&2; exit 77; }
[ "$(id -u)" = 0 ] && unshare --ipc --pid --fork --mount true 2>/dev/null || {
  echo "namespaces are not permitted" >&2; exit 77; }
program=$(readlink -f "$1"); log=${2:-}
D=$(mktemp -d /var/tmp/measure.XXXXXX); export D
mkdir -p "$D/cfg/bin" "$D/home" "$D/tmp" "$D/out"
hal=${HAL:-mill.hal}; drive=${DRIVE:-drive.py}; export drive DRIVE_ARGS="${DRIVE_ARGS:-}"
for f in $hal; do
  case $f in layer*.hal) f=../../steadyrest/adapters/linuxcnc/$f ;; esac
  cp "$here/$f" "$D/cfg/"; done
# The sampler is loaded once: lag_log.hal has its channel added here.
case $hal in *lag_log.hal*) sed -i '/^loadrt sampler/s/4000,4000/4000,4000,60000/;/^loadrt sampler/s/$/,fffbbf/' "$D/cfg/layer.hal" ;; esac
cp "$here/$drive" "$here/../../scripts/linuxcnc/bring_up.py" "$D/cfg/"; [ -n "${PROBE:-}" ] && cp "$PROBE" "$D/cfg/probe"; [ -n "${MACHINE:-}" ] && cp "$MACHINE" "$D/cfg/machine.toml"
cp "$here/../../scripts/linuxcnc/hold" "$D/cfg/bin/"; chmod 755 "$D/cfg/bin/hold"
sed -e "s/@VX@/${VX:-200}/;s/@VY@/${VY:-200}/;s/@VZ@/${VZ:-200}/;s/@AX@/${AX:-2000}/;s/@AY@/${AY:-2000}/" \
  -e "s/@AZ@/${AZ:-2000}/;s/@MAX_OVERRIDE@/${MAX_OVERRIDE:-1.0}/;s/@VPATH@/${VPATH_MM_S:-250}/;s/@APATH@/${APATH:-3000}/" "$here/mill.ini" |
  sed "s/^HALFILE = mill.hal/$(printf 'HALFILE = %s\\n' $hal)/" >"$D/cfg/mill.ini"
case $hal in *layer_offsets.hal*) sed -i '/^.AXIS_/a OFFSET_AV_RATIO = 0.2' "$D/cfg/mill.ini" ;; esac
for t in $(seq 99); do echo "T$t P$t Z0 D0"; done >"$D/cfg/mill.tbl"
: >"$D/cfg/mill.var"; for p in 5161 5162 5163 5164 5165 5166 5167 5168 5169 5181 5182 5183 5184 5185 5186 5187 5188 5189 5210 \
  5211 5212 5213 5214 5215 5216 5217 5218 5219 5220 $(seq 5221 5230) $(seq 5241 5250) $(seq 5261 5270) $(seq 5281 5290) \
  $(seq 5301 5310) $(seq 5321 5330) $(seq 5341 5350) $(seq 5361 5370) $(seq 5381 5390); do
  v=0; [ $p = 5220 ] && v=1; printf '%s\t%s\n' $p $v; done >"$D/cfg/mill.var"
cp "$program" "$D/cfg/program.ngc"
printf "\nM2\n" >>"$D/cfg/program.ngc"  # LinuxCNC needs an end; text after the program's own is not read
chown -R 65534:65534 "$D"; chmod 755 "$D"; chmod 1777 "$D/tmp"
unshare --ipc --pid --fork --kill-child --mount --mount-proc bash -c '
  mount --bind "$D/tmp" /tmp
  # Its task feeds the planner from user space: on a busy computer the queue would run dry.
  renice -n -15 -p $$ >/dev/null 2>&1
  U="setpriv --reuid=65534 --regid=65534 --clear-groups env -i PATH=/usr/bin:/bin HOME=$D/home LANG=C"
  $U linuxcnc -r "$D/cfg/mill.ini" </dev/null >"$D/linuxcnc.log" 2>&1 & L=$!
  ok=; for i in $(seq 500); do
    kill -0 $L 2>/dev/null || break
    [ "$($U halcmd getp joint.2.active 2>/dev/null)" = TRUE ] &&
      [ "$($U halcmd getp halui.mode.is-manual 2>/dev/null)" = TRUE ] && { ok=1; break; }
    sleep .02; done
  [ -n "$ok" ] || { echo "measure: LinuxCNC did not come up" >&2; cat "$D/linuxcnc.log" >&2; exit 99; }
  cd "$D/cfg"; $U /usr/bin/python3 "$drive" "$D/cfg/program.ngc" "$D/out/log" $DRIVE_ARGS; rc=$?
  kill -TERM $(pgrep -P $L -x hold); wait $L
  exit $rc'
rc=$?
[ -n "$log" ] && cp "$D/out/log" "$log" 2>/dev/null
[ -n "$log" ] && [ "$drive" != drive.py ] && cp "$D"/out/* "$(dirname "$log")/" 2>/dev/null
rm -rf "$D"
exit $rc
