#!/bin/sh
# Scans from files to the kiosk: morphed, signed, stored, played; damaged and hopeless ones refused in one line.
# Usage: scans.sh PATH_TO_LACKWERK PATH_TO_KIOSK SCENE_FOLDER SCAN_FOLDER. Without the real scans the rest is tried, and it
# ends with 77.
set -eu
lackwerk=$(realpath "$1")
kiosk=$(realpath "$2")
scene=$(realpath -m "$3")/sphere.lws
data=$4
[ ! -d "$data" ] || data=$(realpath "$data")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
failures=0
checks=0

# is CODE PATTERN COMMAND...: exit code, and a basic regular expression for what it prints on both. Refusals are one line.
is() {
  code=$1 pattern=$2
  shift 2
  checks=$((checks + 1))
  status=0
  "$@" >out.txt 2>err.txt || status=$?
  if [ "$status" -ne "$code" ]; then
    echo "FAILED: $*: exit code $status, expected $code"
  elif ! cat out.txt err.txt | grep -q -e "$pattern"; then
    echo "FAILED: $*: no '$pattern'"
  elif [ "$code" -ne 0 ] && [ "$(wc -l <err.txt)" -ne 1 ]; then
    echo "FAILED: $*: $(wc -l <err.txt) lines on stderr, expected 1"
  else
    return 0
  fi
  cat out.txt err.txt
  failures=$((failures + 1))
}

# ---- a stem and a leaf, made here: 0 and 1 days old
awk 'BEGIN { for (i = 0; i < 400; i++) print 0.3 * sin(7 * i), 0.3 * cos(7 * i), i / 10 }' >young.xyz
awk 'BEGIN { for (i = 0; i < 600; i++) print 0.3 * sin(7 * i), 0.3 * cos(7 * i), i / 10
  for (i = 0; i < 900; i++) { r = 12 * sqrt(i / 900); print 13 + r * cos(2.4 * i), r * sin(2.4 * i), 59 } }' >old.xyz
is 0 'grown' "$lackwerk" scan morph young.xyz old.xyz --no-alignment --name Bean --time-unit days -o bean.lwp
is 0 'Bean, 2 scans' "$lackwerk" pack info bean.lwp
is 0 '"kind": "scans"' "$lackwerk" pack info --json bean.lwp
is 0 'scan pack, whole and sound' "$lackwerk" pack verify bean.lwp
cp bean.lwp first.lwp
is 0 'paths' "$lackwerk" scan morph young.xyz old.xyz --no-alignment --name Bean --time-unit days --threads 1 -o bean.lwp
checks=$((checks + 1))
if ! cmp -s first.lwp bean.lwp; then
  echo "FAILED: the number of threads changes the pack"
  failures=$((failures + 1))
fi
is 0 'points' "$lackwerk" scan render bean.lwp --time 0.5 --size 320x180 -o bean.png

# ---- what is hopeless
printf '1 2 nan\n3 4 5\n' >nan.xyz
: >empty.xyz
is 1 'empty.xyz' "$lackwerk" scan morph young.xyz empty.xyz -o x.lwp
is 2 'scans' "$lackwerk" scan morph young.xyz -o x.lwp
is 1 'absent.xyz' "$lackwerk" scan morph young.xyz absent.xyz -o x.lwp
is 1 'spacing' "$lackwerk" scan morph young.xyz old.xyz --spacing 1e-12 -o x.lwp
is 2 'times' "$lackwerk" scan morph young.xyz old.xyz --times 1 -o x.lwp
is 2 'time' "$lackwerk" scan morph young.xyz old.xyz --times 2,1 -o x.lwp
status=0
"$lackwerk" scan morph young.xyz nan.xyz --no-alignment -o x.lwp >out.txt 2>err.txt || status=$?
checks=$((checks + 1))
if [ "$status" -gt 1 ] || { [ "$status" -eq 1 ] && [ "$(wc -l <err.txt)" -ne 1 ]; }; then
  echo "FAILED: rows that are no numbers: exit code $status"
  cat out.txt err.txt
  failures=$((failures + 1))
fi
head -c 900 bean.lwp >cut.lwp
is 1 'cut.lwp' "$lackwerk" pack verify cut.lwp
is 1 'cut.lwp' "$lackwerk" scan render cut.lwp -o x.png

# ---- the store and the kiosk
if minisign -v >/dev/null 2>&1; then
  mkdir keys
  minisign -G -W -p keys/maker.pub -s maker.key >/dev/null
  is 1 'not signed' "$lackwerk" store add bean.lwp --root store --keyring keys
  is 0 'id=bean serial=1' "$lackwerk" pack sign bean.lwp --secret maker.key
  is 0 'scan pack, whole and sound, signed as bean 1' "$lackwerk" pack verify bean.lwp --keyring keys
  is 0 'bean' "$lackwerk" store add bean.lwp --root store --keyring keys
  is 0 'bean' "$lackwerk" store list --root store
fi
if [ -e "$scene" ]; then
  printf '0 time 0\n0 time 0.8 over 900\n' >grow.script
  is 0 'points' "$kiosk" --pack first.lwp --scene "$scene" --platform osmesa --size 480x270 --frames 30 \
    --input-script grow.script --record frames
  checks=$((checks + 1))
  # Growing, every frame is another one, and none is black: a file of nothing has a few hundred bytes.
  if [ "$(cd frames && cksum ./*.png | awk '{ print $1 }' | sort -u | wc -l)" -lt 20 ] ||
    [ -n "$(find frames -name '*.png' -size -4k)" ]; then
    echo "FAILED: the frames of a morph"
    ls -l frames
    failures=$((failures + 1))
  fi
  is 1 'cut.lwp' "$kiosk" --pack cut.lwp --scene "$scene" --platform osmesa --frames 1
fi

# ---- real scans
if [ -d "$data/tomato" ]; then
  is 0 'left out and rebuilt' "$lackwerk" scan check --times 5,6,8 -- \
    "$data/tomato/03-05.xyz" "$data/tomato/03-06.xyz" "$data/tomato/03-08.ply"
  cat out.txt
  is 0 '3 matched' "$lackwerk" scan morph --times 5,6,8 -o tomato.lwp -- \
    "$data/tomato/03-05.xyz" "$data/tomato/03-06.xyz" "$data/tomato/03-08.ply"
  is 0 'points' "$lackwerk" scan render tomato.lwp --time 5.5 --size 320x180 -o tomato.png
fi
echo "$checks checks, $failures failed"
[ "$failures" -eq 0 ] || exit 1
[ -d "$data/tomato" ] || {
  echo "SKIPPED: no scans in $data"
  exit 77
}
