#!/bin/sh
# Bad input to the `lackwerk` program: the right exit code, one line on stderr that names the place, nothing else.
# Usage: cli_errors.sh PATH_TO_LACKWERK
set -eu
lackwerk=$(realpath "$1")
here=$(dirname "$(realpath "$0")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
failures=0
checks=0

# expect CODE PATTERN ARGUMENTS...: runs the program; PATTERN is a basic regular expression for the line on stderr.
expect() {
  code=$1 pattern=$2
  shift 2
  checks=$((checks + 1))
  status=0
  "$lackwerk" "$@" >out.txt 2>err.txt || status=$?
  lines=$(wc -l <err.txt)
  if [ "$status" -ne "$code" ]; then
    echo "FAILED: lackwerk $*: exit code $status, expected $code"
  elif [ "$lines" -ne 1 ]; then
    echo "FAILED: lackwerk $*: $lines lines on stderr, expected 1"
  elif ! grep -q "^lackwerk: .*$pattern" err.txt; then
    echo "FAILED: lackwerk $*: no '$pattern' in the error"
  else
    return 0
  fi
  cat err.txt
  failures=$((failures + 1))
}

# succeed ARGUMENTS...: exit code 0 and a silent stderr.
succeed() {
  checks=$((checks + 1))
  if ! "$lackwerk" "$@" >out.txt 2>err.txt || [ -s err.txt ]; then
    echo "FAILED: lackwerk $*"
    cat err.txt
    failures=$((failures + 1))
  fi
}

cp "$here/small.toml" .

# Usage.
expect 2 'subcommand'
expect 2 'help' frobnicate
expect 2 'help' pack build
expect 2 'help' pack info
expect 2 'help' capture small.toml --no-such-option -o d
expect 2 'edge' capture small.toml -o d --edge 100000
expect 2 'paint' scene build tank -o s.lws
expect 2 'help' scene build
expect 2 'help' compare only-one.png
for command in '' capture pack 'pack build' 'pack info' 'pack verify' scene 'scene build' compare; do
  # shellcheck disable=SC2086
  succeed $command --help
done

# Recipes.
expect 1 'missing.toml' capture missing.toml -o d
echo 'name = "x' >broken.toml
expect 1 'broken.toml: line 1' capture broken.toml -o d
sed 's/diffuse/difuse/' small.toml >typo.toml
expect 1 'typo.toml: .*difuse' capture typo.toml -o d
expect 1 'broken.toml' capture small.toml -o broken.toml --edge 16

# Captures.
succeed capture small.toml -o good --edge 16 --texel-mm 0.05
succeed capture small.toml -o other --edge 32 --texel-mm 0.05 --json
slice=$(ls good/flakes/* | head -n 1)
cp -r good cut
truncate -s 100 "cut/${slice#good/}"
cp -r good lost
rm "lost/${slice#good/}"
cp -r good scribble
echo 'nonsense = 1' >>scribble/paint.toml
expect 1 'nowhere' pack build nowhere -o p.lwp
expect 1 'cut/flakes' pack build cut -o p.lwp
expect 1 'lost/flakes' pack build lost -o p.lwp
expect 1 'scribble/paint.toml' pack build scribble -o p.lwp
expect 1 'other: edge_texels: .*good' pack build good other -o p.lwp
expect 2 'captures' pack build good good good good good good -o p.lwp
expect 1 'id' pack build good -o p.lwp --id 'two words'
expect 1 'no/such' pack build good -o no/such/p.lwp
expect 2 'threads' pack build good -o p.lwp --threads -3
test ! -e p.lwp

# Packs.
succeed pack build good good -o p.lwp --serial 7
succeed pack verify p.lwp
succeed pack info p.lwp
succeed pack info p.lwp --json
grep -q '"serial": 7' out.txt && grep -q '"paints"' out.txt || { echo 'FAILED: pack info --json'; failures=$((failures + 1)); }
grep -q '"beyond_limit"' out.txt || { echo 'FAILED: no beyond_limit'; failures=$((failures + 1)); }
# Every field says what it is, and nothing is said of a field that is not there.
python3 - out.txt <<'EOF' || { echo 'FAILED: pack info --json has fields without a word about them'; failures=$((failures + 1)); }
import json, sys
info = json.load(open(sys.argv[1]))
seen = set()
def walk(value, path):
    for key, inner in value.items():
        here = f"{path}.{key}" if path else key
        seen.add(here)
        if here == "fields":
            continue
        if isinstance(inner, list) and inner and isinstance(inner[0], dict):
            for entry in inner:
                walk(entry, here + "[]")
        elif isinstance(inner, dict):
            walk(inner, here)
walk(info, "")
said = set(info["fields"])
assert seen == said, f"without a word: {sorted(seen - said)}; not there: {sorted(said - seen)}"
assert all(field["meaning"] for field in info["fields"].values())
EOF
expect 1 'missing.lwp' pack info missing.lwp
expect 1 'regular file' pack info good
# flip FILE OFFSET: another byte there.
flip() {
  byte=$(od -An -tu1 -j "$2" -N 1 "$1" | tr -d ' ')
  # shellcheck disable=SC2059
  printf "\\$(printf %o $((byte ^ 4)))" | dd of="$1" bs=1 seek="$2" conv=notrunc 2>/dev/null
}
for place in 3:magic 9:format_version 13:kind 17:payload_bytes 25:reserved 40:digest 100:digest 5000:digest; do
  cp p.lwp flipped.lwp
  flip flipped.lwp "${place%%:*}"
  expect 1 "flipped.lwp: ${place##*:}" pack verify flipped.lwp
  expect 1 "flipped.lwp: ${place##*:}" pack info flipped.lwp
done
for size in 0 10 64 65 1000; do
  head -c "$size" p.lwp >cut.lwp
  expect 1 'cut.lwp: ' pack verify cut.lwp
done

# Pictures.
printf 'P6 2 2 255\n012345678901' >a.ppm
printf 'P6 2 1 255\n012345' >b.ppm
head -c 15 a.ppm >c.ppm
expect 1 'b.ppm: size' compare a.ppm b.ppm
expect 1 'missing.png' compare a.ppm missing.png
expect 1 'small.toml' compare a.ppm small.toml
succeed compare a.ppm a.ppm --json --map map.png
head -c 50 map.png >half.png
expect 1 'half.png' compare map.png half.png
expect 1 'map.xyz' compare a.ppm a.ppm --map map.xyz

# Weights are refused before anything is drawn.
if "$lackwerk" render --help 2>/dev/null | grep -q -e --weights; then
  for weights in 0.5 0.5,0.6 0.2,0.3,0.5 0.5,nan a,b 0.5,; do
    expect 2 'weights' render --pack p.lwp --scene sphere --weights "$weights" -o w.png
  done
  expect 1 'missing.lwp' render --pack missing.lwp --scene sphere -o w.png
  expect 1 'flipped.lwp' render --pack flipped.lwp --scene sphere -o w.png
  expect 2 'white' render --pack p.lwp --scene sphere --white 1.1 -o w.png
fi

# Codes of mixes. Of two paints of pack p: 0.25 and 0.75 of serial 7, and of serial 8; the third is of pack demo.
mix=LW1W2G2CR744W8DHMG1 newer=LW1W2G2CR844W83G6N1 other=LW1V3E2ST186Q18062TFR
expect 2 'mix code: does not begin' render --pack p.lwp --mix '' -o w.png
expect 2 'mix code: does not begin' render --pack p.lwp --mix nonsense -o w.png
expect 2 'mix code: is too long' render --pack p.lwp --mix "$(head -c 300 /dev/zero | tr '\0' 0)" -o w.png
expect 2 'mix code: is damaged' render --pack p.lwp --mix "${mix%?}Z" -o w.png
expect 2 'mix' render --pack p.lwp --mix "$mix" --weights 0.5,0.5 -o w.png
expect 2 'mix' render --pack p.lwp --mix "$mix" --white 0.5 -o w.png
expect 1 'mix code: .*another pack' render --pack p.lwp --mix "$other" -o w.png
expect 1 'mix code: .*serial 8' render --pack p.lwp --mix "$newer" -o w.png
# This one is taken: the scene is what is missing.
expect 1 'no/such.lws' render --pack p.lwp --mix "$mix" --scene no/such.lws -o w.png
test ! -e w.png

# Scenes.
succeed scene build sphere -o s.lws --occlusion-rays 4
succeed pack verify s.lws
expect 1 's.lws: kind' pack info s.lws
cp s.lws t.lws
flip t.lws 200
expect 1 't.lws: digest' pack verify t.lws
expect 1 'no/such' scene build sphere -o no/such/s.lws --occlusion-rays 0

# Models and maps from elsewhere.
cat >car.obj <<'OBJ'
v 0 0 0
v 0 4 0
v 2 4 0
v 2 0 1
usemtl Lack
f 1 3 2
f 1 1 2
usemtl Glas
f 1 4 3
OBJ
succeed scene build car.obj -o m.lws --paint lack --material Glas=glass --occlusion-rays 8 --json
grep -q '"Glas":"glass"' out.txt && grep -q '1 face without area left out' out.txt && grep -q '"fit_error_p95"' out.txt ||
  { echo 'FAILED: scene build --json'; failures=$((failures + 1)); }
succeed pack verify m.lws
sed 's/v 0 4 0/v 0 nan 0/' car.obj >nan.obj
sed '/^f/d' car.obj >faceless.obj
: >empty.glb
expect 1 'nowhere.glb: no such file' scene build nowhere.glb --paint a -o m.lws
expect 1 'car.obj: --paint: .*Lack, Glas' scene build car.obj --paint Body -o m.lws
expect 1 "car.obj: --material: .*'Body'" scene build car.obj --paint Lack --material Body=glass -o m.lws
expect 1 'nan.obj: .*not finite' scene build nan.obj --paint Lack -o m.lws
expect 1 'faceless.obj' scene build faceless.obj --paint Lack -o m.lws
expect 1 'empty.glb' scene build empty.glb --paint Lack -o m.lws
expect 1 'small.toml' scene build small.toml --paint Lack -o m.lws
expect 1 'nowhere.hdr' scene build sphere --env nowhere.hdr -o m.lws
expect 2 'small.toml' scene build sphere --env small.toml -o m.lws
expect 2 'material' scene build car.obj --paint Lack --material Glas -o m.lws
expect 2 'gold' scene build car.obj --paint Lack --material Glas=gold -o m.lws
expect 2 'paint' scene build sphere --paint Lack -o m.lws
expect 2 'up' scene build car.obj --paint Lack --up x -o m.lws
expect 2 'room-radius' scene build sphere --room-radius-mm 5 -o m.lws
expect 2 'length' scene build car.obj --paint Lack --length-mm -4 -o m.lws
expect 2 'core-es2' render --core-es2 x --pack p.lwp -o w.png
expect 2 'rung' render --rung x --pack p.lwp -o w.png

echo "$checks runs, $failures failures"
test "$failures" -eq 0
