#!/usr/bin/env bash
# The whole path on the real demo pack: both backends show the same car, a morph passes without a jump, and a kiosk
# in which nothing changes draws once.
# Usage: demo.sh LACKWERK KIOSK DEMO_FOLDER. Exit 77: skipped, with the reason.
set -euo pipefail
lackwerk=$1 kiosk=$2 demo=$3
[ -e "$demo/demo.lwp" ] && [ -e "$demo/builtin.lws" ] || { echo "SKIPPED: no demo pack in $demo; run scripts/demo"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
check() { # check WHAT VALUE OPERATOR LIMIT
  if awk "BEGIN{exit !($2 $3 $4)}"; then echo "ok: $1: $2 $3 $4"; else echo "FAILED: $1: $2 is not $3 $4"; failures=$((failures + 1)); fi
}
render() { "$lackwerk" render --pack "$demo/demo.lwp" --scene "$demo/builtin.lws" --size 640x360 --quality moving "$@" >/dev/null; }
metric() { "$lackwerk" compare "$1" "$2" --json | sed -E "s/.*\"$3\":([0-9.e+-]+).*/\1/"; }

for camera in hero macro; do
  render --weights 0.2,0.3,0.5 --camera $camera --backend egl -o "$work/egl.png"
  if render --weights 0.2,0.3,0.5 --camera $camera --backend osmesa -o "$work/osmesa.png" 2>"$work/why"; then
    check "EGL and OSMesa, $camera, mean CIEDE2000" "$(metric "$work/egl.png" "$work/osmesa.png" mean)" "<=" 0.1
  elif [ "${LACKWERK_REQUIRE_OSMESA:-0}" = 1 ]; then
    echo "FAILED: OSMesa is required: $(cat "$work/why")"
    failures=$((failures + 1))
  else
    echo "SKIPPED: OSMesa: $(cat "$work/why")"
  fi
done

# A morph in steps of 1/128 of the way: no pixel may jump. The whole way is far, so a jump would stand out.
render --weights 1,0,0 -o "$work/from.png"
render --weights 0,0,1 -o "$work/to.png"
check "the morph's two ends, mean CIEDE2000" "$(metric "$work/from.png" "$work/to.png" mean)" ">=" 3
for at in 0 0.4921875 0.9921875; do
  next=$(awk "BEGIN{print $at + 0.0078125}")
  render --weights "$(awk "BEGIN{print 1 - $at}"),0,$at" --camera macro -o "$work/a.png"
  render --weights "$(awk "BEGIN{print 1 - $next}"),0,$next" --camera macro -o "$work/b.png"
  check "one step at $at, p99 CIEDE2000" "$(metric "$work/a.png" "$work/b.png" p99)" "<=" 2
done

render --weights 1,0,0 --backend egl -o "$work/again.png"
cmp -s "$work/from.png" "$work/again.png" && echo "ok: the same call gives the same bytes" || { echo "FAILED: the same call gave other bytes"; failures=$((failures + 1)); }

printf '[interface]\ntour = false\n' >"$work/still.toml"
still=$("$kiosk" --config "$work/still.toml" --pack "$demo/demo.lwp" --scene "$demo/builtin.lws" --size 320x180 --frames 20 --still-frames 8)
echo "$still"
check "frames drawn while nothing changes" "$(sed -E 's/.* ([0-9]+) drawn.*/\1/' <<<"$still")" "==" 1
check "frames a resting picture is refined with, before nothing is done at all" "$(sed -E 's/.* ([0-9]+) refined.*/\1/' <<<"$still")" "==" 8
printf '0 weights 0 1 0 over 300\n' >"$work/short.tour"
moved=$("$kiosk" --pack "$demo/demo.lwp" --scene "$demo/builtin.lws" --size 320x180 --frames 20 --input-script "$work/short.tour" --screenshot "$work/shot.png")
echo "$moved"
check "frames drawn for a morph of 9 frames" "$(sed -E 's/.* ([0-9]+) drawn.*/\1/' <<<"$moved")" "==" 10
[ -s "$work/shot.png" ] || { echo "FAILED: no screenshot"; failures=$((failures + 1)); }
[ $failures -eq 0 ]
