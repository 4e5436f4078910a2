#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# page.sh PROGRAM PAGE: does what docs/linuxcnc.md says, as its reader would: its `bash` blocks and test remarks as one script, in order, with PROGRAM
# as steadyrest. LinuxCNC runs without a screen (DISPLAY = hold), in its own namespaces, as an unprivileged user; needs root.
# Exit status 0: every command did; 77: LinuxCNC cannot run here.
set -u
here=$(cd "$(dirname "$0")" && pwd)
stock=/usr/share/doc/linuxcnc/examples/sample-configs/sim/axis/axis_mm.ini
command -v linuxcnc >/dev/null && [ -f $stock ] || { echo "linuxcnc or its examples are not installed" >&2; exit 77; }
[ "$(id -u)" = 0 ] && unshare --ipc --pid --fork --mount true 2>/dev/null || { echo "namespaces are not permitted" >&2; exit 77; }
D=$(mktemp -d /var/tmp/page.XXXXXX); export D
mkdir -p "$D/bin" "$D/home" "$D/tmp"
cp "$1" "$D/bin/steadyrest"; cp "$here/at_screen.py" "$here/../../scripts/linuxcnc/bring_up.py" "$D/"
# A linuxcnc without a screen: as the real one, but for DISPLAY and the HAL file that opens a window.
cat >"$D/bin/linuxcnc" <<'END'
#!/bin/bash
mkdir -p bin; cp "$D/hold" bin/
sed 's/^\( *DISPLAY *=\).*/\1 hold/;/axis_manualtoolchange.hal/d;/^INTRO_/d' "$1" >headless.ini
/usr/bin/linuxcnc -r "$PWD/headless.ini" </dev/null >"$D/linuxcnc.log" 2>&1
rm -f headless.ini
END
cp "$here/../../scripts/linuxcnc/hold" "$D/"; chmod 755 "$D/bin/linuxcnc" "$D/hold" "$D/bin/steadyrest"
{ echo 'set -eu'
  awk '/^```bash$/ {inside = 1; next} /^```$/ {inside = 0} inside {print}
       /^<!-- test: / {sub(/^<!-- test: /, ""); sub(/ -->$/, ""); sub(/at_screen.py/, "\"$D/at_screen.py\""); sub(/^python3/, "/usr/bin/python3"); print}' "$2"
} >"$D/script"
chown -R 65534:65534 "$D"; chmod 755 "$D"; chmod 1777 "$D/tmp"
unshare --ipc --pid --fork --kill-child --mount --mount-proc bash -c '
  mount --bind "$D/tmp" /tmp
  exec setpriv --reuid=65534 --regid=65534 --clear-groups env -i PATH="$D/bin:/usr/bin:/bin" HOME="$D/home" XDG_RUNTIME_DIR="$D/tmp" D="$D" LANG=C.UTF-8 \
    bash -x "$D/script"' >"$D/said" 2>&1
rc=$?
cat "$D/said"
[ $rc = 0 ] || cat "$D/linuxcnc.log" >&2
# Undone, the configuration is the stock one again.
diff --no-dereference -r -x '*.var*' -x position_mm.txt -x bin -x machine.toml -x runs -x run.txt -x '*.sock' "$(dirname $stock)" "$D/home/linuxcnc/configs/samples/sim/axis" || rc=1
rm -rf "$D"
exit $rc
