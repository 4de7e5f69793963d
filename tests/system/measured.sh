#!/bin/sh
# Measurements in: every kind of file becomes a capture, a model and a paint of one pack; bad ones are refused by name.
# Usage: measured.sh PATH_TO_LACKWERK RGL_FOLDER. Without the real files the rest is tried, and it ends with 77.
set -eu
lackwerk=$(realpath "$1")
here=$(dirname "$(realpath "$0")")
data=$2
[ ! -d "$data" ] || data=$(realpath "$data")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
failures=0
checks=0

# is CODE PATTERN ARGUMENTS...: exit code, and a basic regular expression for what it prints on both. Refusals are one line.
is() {
  code=$1 pattern=$2
  shift 2
  checks=$((checks + 1))
  status=0
  "$lackwerk" "$@" >out.txt 2>err.txt || status=$?
  if [ "$status" -ne "$code" ]; then
    echo "FAILED: lackwerk $*: exit code $status, expected $code"
  elif ! cat out.txt err.txt | grep -q -e "$pattern"; then
    echo "FAILED: lackwerk $*: no '$pattern'"
  elif [ "$code" -ne 0 ] && [ "$(wc -l <err.txt)" -ne 1 ]; then
    echo "FAILED: lackwerk $*: $(wc -l <err.txt) lines on stderr, expected 1"
  else
    return 0
  fi
  cat out.txt err.txt
  failures=$((failures + 1))
}

# ---- a spectrophotometer's table becomes a map
cat >six.csv <<'CSV'
# name = Six readings
# source = made up for a test
angle,L,a,b
15as45,95,2,6
25as45,70,3,5
45as45,38,3,1
75as45,22,2,-2
110as45,18,2,-4
-15as45,88,2,5
CSV
is 0 'not fitted yet' import --angles six.csv -o six --provenance simulated
is 1 'six: fitted: .*lackwerk fit' pack build six -o no.lwp
is 0 'isochromatic map.*' fit six --colour map
is 0 '6 readings' fit six --colour map
is 0 '"name":"Six readings"' fit six --colour map --json
is 2 'ior' fit six --colour map --ior 9
is 0 'mean' measure-compare six.csv six --of-b model
is 1 'more than' measure-compare six.csv six --of-b model --max-mean 0
sed 's/70,3,5/nan,3,5/' six.csv >nan.csv
is 1 'nan.csv: .*L' import --angles nan.csv -o d
sed 's/25as45/25xx45/' six.csv >name.csv
is 1 'name.csv: .*25xx45' import --angles name.csv -o d
head -n 3 six.csv >empty.csv
is 1 'empty.csv' import --angles empty.csv -o d

# ---- what is none
: >zero
for kind in rgl merl angles; do
  is 1 'zero' import --$kind zero -o d
  is 1 'missing' import --$kind missing -o d
done
for kind in btf photos; do
  is 1 'nowhere' import --$kind nowhere -o d
done
# MERL's three dimensions, and nothing or not enough behind them.
printf '\377\377\377\177\377\377\377\177\377\377\377\177' >huge
is 1 'huge: .*dimensions' import --merl huge -o d
printf '\132\0\0\0\132\0\0\0\264\0\0\0short' >short
is 1 'short' import --merl short -o d
is 2 'help' import -o d
test ! -e d

# A whole MERL file (their layout: doubles, colour by colour, 1500, 1500/1.15 and 1500/1.66 to the unit): grey of albedo
# 0.5 with a tenth of its cells missing.
python3 - <<'PY'
import array, math, struct
cells = 90 * 90 * 180
with open("grey.binary", "wb") as file:
    file.write(struct.pack("<3i", 90, 90, 180))
    for scale in (1.0, 1.15, 1.66):
        value = 0.5 / math.pi * 1500.0 / scale
        array.array("d", (-1.0 if k % 10 == 3 else value for k in range(cells))).tofile(file)
PY
is 0 ' holes' import --merl grey.binary -o grey --name Grey --provenance simulated
is 0 '    diffuse\.r 0\.[45]' fit grey --lobes 1
rm grey.binary

# ---- flakes as captured, beside the map in one pack
cp "$here/small.toml" .
is 0 '' capture small.toml -o flakes --edge 16 --texel-mm 0.05
captures='flakes six'
weights=0.5,0.5

# ---- a real measured BRDF
satin=$data/satin_rosaline_rgb.bsdf
if [ -e "$satin" ]; then
  is 0 'vinyl film' import --rgl "$satin" -o satin
  is 0 'sphere pixels: mean 0\.' fit satin --colour table --picture satin.png
  test -s satin.png || { echo 'FAILED: no picture of the fit'; failures=$((failures + 1)); }
  is 0 'mean' measure-compare satin satin --of-a brdf --of-b model --max-mean 3
  head -c 100000 "$satin" >cut.bsdf
  is 1 'cut.bsdf: ' import --rgl cut.bsdf -o d
  is 1 'satin_rosaline_rgb.bsdf' import --merl "$satin" -o d
  captures="$captures satin"
  weights=0.3,0.3,0.4
fi

# shellcheck disable=SC2086
is 0 '' pack build $captures -o all.lwp
is 0 'given; nothing measured' pack info all.lwp
is 0 'mapped; CIEDE2000 against the measurement, 6 readings: mean' pack info all.lwp
[ ! -e "$satin" ] || is 0 'fitted; CIEDE2000 against the measurement, [0-9]* sphere pixels' pack info all.lwp
is 0 '"judged_by": "readings"' pack info all.lwp --json
is 0 '' render --pack all.lwp --scene sphere --weights $weights --size 160x120 --quality moving -o mix.png
test -s mix.png || { echo 'FAILED: no picture of the mix'; failures=$((failures + 1)); }

echo "$checks runs, $failures failures"
[ "$failures" -eq 0 ] || exit 1
[ -e "$satin" ] || { echo "SKIPPED: no real BRDF in $data"; exit 77; }
