#!/usr/bin/env bash
# Bad input to the kiosk: the right exit code and exactly one line on stderr that names the place.
# Usage: kiosk_errors.sh KIOSK DEMO_FOLDER. Exit 77: skipped, with the reason.
set -euo pipefail
kiosk=$1 demo=$2
[ -e "$demo/demo.lwp" ] && [ -e "$demo/sphere.lws" ] || { echo "SKIPPED: no demo pack in $demo; run scripts/demo"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0 checks=0
# expect CODE PATTERN ARGUMENTS...
expect() {
  local code=$1 pattern=$2 status=0
  shift 2
  checks=$((checks + 1))
  "$kiosk" "$@" >/dev/null 2>"$work/err" || status=$?
  if [ "$status" -ne "$code" ] || [ "$(wc -l <"$work/err")" -ne 1 ] || ! grep -q "^lackwerk-kiosk: .*$pattern" "$work/err"; then
    echo "FAILED: $*: exit code $status (expected $code), stderr:"
    cat "$work/err"
    failures=$((failures + 1))
  fi
}
good=(--pack "$demo/demo.lwp" --scene "$demo/sphere.lws" --size 64x64 --frames 1)
expect 2 "pack"
expect 2 "scene" --pack "$demo/demo.lwp"
expect 2 "option" "${good[@]}" --nonsense
expect 2 "option" "${good[@]}" stray
expect 2 "platform" "${good[@]}" --platform vulkan
expect 2 "size" "${good[@]}" --size 0x0
expect 2 "size" "${good[@]}" --size 99999x10
expect 2 "frames" "${good[@]}" --frames -3
expect 2 "record-samples" "${good[@]}" --record-samples 0
expect 1 "no/such" --pack no/such.lwp --scene "$demo/sphere.lws"
expect 1 "no/such" --pack "$demo/demo.lwp" --scene no/such.lws
expect 1 "demo.lwp" --pack "$demo/demo.lwp" --scene "$demo/demo.lwp"
expect 1 "no/such.tour" "${good[@]}" --input-script no/such.tour
printf '0 fly 3\n' >"$work/bad.tour"
expect 1 "line 1" "${good[@]}" --input-script "$work/bad.tour"
head -c 5000 "$demo/demo.lwp" >"$work/short.lwp"
expect 1 "short.lwp" --pack "$work/short.lwp" --scene "$demo/sphere.lws" --frames 1
cp "$demo/demo.lwp" "$work/flipped.lwp"
printf '\x01' | dd of="$work/flipped.lwp" bs=1 seek=70000 conv=notrunc status=none
cmp -s "$demo/demo.lwp" "$work/flipped.lwp" && printf '\x02' | dd of="$work/flipped.lwp" bs=1 seek=70000 conv=notrunc status=none
expect 1 "flipped.lwp" --pack "$work/flipped.lwp" --scene "$demo/sphere.lws" --frames 1
expect 1 "record" "${good[@]}" --record /proc/no
expect 1 "screenshot\|png" "${good[@]}" --screenshot /proc/no.png
expect 2 "core-es2" "${good[@]}" --core-es2 x
expect 2 "quality" "${good[@]}" --quality x
expect 2 "still-frames" "${good[@]}" --still-frames 999
expect 2 "frame-ms" "${good[@]}" --frame-ms 0
expect 2 "language" "${good[@]}" --language fr
printf '[interface]\npin = "1234"\n' >"$work/pin.toml"
expect 1 "line 2, interface.pin: .*hash-pin" "${good[@]}" --config "$work/pin.toml"
grep -q 1234 "$work/err" && { echo "FAILED: a PIN in an error message"; failures=$((failures + 1)); }
for pin in '' 123 1234567890123 '12 34' abcd; do
  printf '%s\n' "$pin" >"$work/typed"
  expect 2 "PIN: must be 4 to 12 digits" --hash-pin <"$work/typed"
done
# What --hash-pin prints is what the file takes: it goes on to the next mistake.
{
  echo '[interface]'
  echo 4711 | "$kiosk" --hash-pin
  echo 'dpi = 5'
} >"$work/pin.toml"
expect 1 "line 3, interface.dpi" "${good[@]}" --config "$work/pin.toml"
echo "$checks runs, $failures failures"
[ $failures -eq 0 ]
