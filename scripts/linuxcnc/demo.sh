#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The layer at work on LinuxCNC's simulator, with its page: `PORT=linuxcnc make demo`. Ctrl-C ends all of it.
#   PROGRAM   what is cut; by default the rib pocket
#   LISTEN    [ADDRESS:]PORT of the page; by default 8080 of this computer
#   FOR_S     ends after so many seconds
#   LAYER     the program; by default the one of build/release
#   KEEP      folder for the record and the answer of the run, which are else removed
# LinuxCNC runs without a screen in namespaces of its own: processes, shared memory and /tmp. They end with this script, so nothing is left behind, and
# another LinuxCNC on this computer is not touched.
set -eu
cd "$(dirname "$0")/../.."
program=${PROGRAM:-examples/programs/rib-pocket.ngc}
layer=${LAYER:-build/release/bin/steadyrest}
here=$PWD/scripts/linuxcnc
[ -r "$program" ] || { echo "$program cannot be read; give PROGRAM the file of a program for LinuxCNC" >&2; exit 2; }
command -v linuxcnc >/dev/null || { echo "LinuxCNC is not installed; run sh scripts/setup.sh --linuxcnc" >&2; exit 77; }

# LinuxCNC's realtime process refuses to run as root; without root, a user namespace permits the others.
if [ "$(id -u)" = 0 ]; then
  spaces='' as="setpriv --reuid=65534 --regid=65534 --clear-groups"
else
  spaces='--user --map-current-user' as=
fi
# shellcheck disable=SC2086 # words
unshare $spaces --ipc --pid --fork --mount true 2>/dev/null || {
  echo "this computer does not permit namespaces, in which the demo keeps LinuxCNC apart; run it as root" >&2; exit 77; }

D=$(mktemp -d /var/tmp/steadyrest-demo.XXXXXX)
trap 'rm -rf "$D"' EXIT
trap : INT TERM HUP
mkdir -p "$D/mill/bin" "$D/home" "$D/tmp" "$D/kept"
cp examples/linuxcnc/* "$D/mill/"
cp "$here/hold" "$D/mill/bin/"
cp "$here/cut_again.py" "$here/bring_up.py" "$here/inside.sh" "$D/"
cp "$layer" "$D/steadyrest"
cd "$D/mill"
"$D/steadyrest" machine from-linuxcnc mill.ini -o machine.toml --json >/dev/null
# The servos of servos.hal; what no INI file says.
sed -i -e 's/^servo_gain_1_s = 20 .*/servo_gain_1_s = 50/' -e 's/^feed_forward = .*/feed_forward = 0/' machine.toml
sed -i 's/^HALFILE = mill.hal/HALFILE = servos.hal/;s/^DISPLAY = .*/DISPLAY = hold/' mill.ini
"$D/steadyrest" linuxcnc setup mill.ini --offsets --json >/dev/null
sed -i 's/^HALFILE = mill-layer.hal/&\nHALFILE = drive.hal/' mill.ini
for tool in $(seq 99); do echo "T$tool P$tool Z0 D10"; done >mill.tbl
# The part lies within the travel: G54 at X100 Y60 Z-80.
awk 'BEGIN {
  for (n = 5161; n <= 5390; ++n)
    if (n % 20 >= 1 && n % 20 <= 10 && n != 5170 && n != 5190 && (n <= 5169 || n >= 5181) && (n < 5191 || n > 5209))
      printf "%d\t%g\n", n, n == 5220 ? 1 : n == 5221 ? 100 : n == 5222 ? 60 : n == 5223 ? -80 : 0
}' >mill.var
cd "$OLDPWD"
# M52 P1 lets the layer in; a % that begins a program stays the first line.
awk 'NR == 1 && /^%/ {print; print "M52 P1"; next} NR == 1 {print "M52 P1"} {print}' "$program" >"$D/mill/part.ngc"
[ "$(id -u)" != 0 ] || chown -R 65534:65534 "$D"
chmod 755 "$D"

echo "The page shows the layer on LinuxCNC, cutting $program again and again. Ctrl-C ends it."
# shellcheck disable=SC2086 # words
unshare $spaces --ipc --pid --fork --kill-child --mount --mount-proc sh -c '
  mount --bind "$1/tmp" /tmp
  # Its task feeds the planner from user space: on a busy computer the queue would run dry.
  renice -n -15 -p $$ >/dev/null 2>&1
  (ulimit -l unlimited && ulimit -r 40) 2>/dev/null && ulimit -l unlimited && ulimit -r 40
  shift
  exec "$@"' sh "$D" $as env -i PATH=/usr/bin:/bin HOME="$D/home" LANG=C.UTF-8 D="$D" LISTEN="${LISTEN:-8080}" FOR_S="${FOR_S:-}" \
  sh "$D/inside.sh" &
spaces=$!
trap 'for inside in $(pgrep -P $spaces); do kill -TERM "$inside" 2>/dev/null; done' INT TERM HUP
code=0
while kill -0 $spaces 2>/dev/null; do
  wait $spaces && code=0 || code=$?
done
[ -z "${KEEP:-}" ] || cp -r "$D/kept/." "$KEEP/"
exit $code
