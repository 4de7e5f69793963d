#!/usr/bin/env bash
# lackwerk report, quick: every file is there, every knob has its default and its curve, no stiff case is beyond its
# bound. Prints how long it took; asserts no time.
# Usage: report.sh LACKWERK
set -euo pipefail
lackwerk=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
fails() { echo "FAILED: $*"; failures=$((failures + 1)); }

code=0
"$lackwerk" report -o "$work/none" --only nothing 2>"$work/err" || code=$?
[ "$code" = 2 ] && [ "$(wc -l <"$work/err")" = 1 ] && grep -q "parts are:" "$work/err" || fails "an unknown part is not refused in one line that names the known ones"
[ ! -e "$work/none" ] || fails "a refused report leaves a folder behind"
touch "$work/file"
code=0
"$lackwerk" report -o "$work/file/inside" --quick 2>"$work/err" || code=$?
[ "$code" = 1 ] && [ "$(wc -l <"$work/err")" = 1 ] || fails "a folder that cannot be made is not refused in one line"

started=$(date +%s.%N)
code=0
"$lackwerk" report -o "$work/out" --quick >"$work/printed" || code=$?
echo "lackwerk report --quick: $(echo "$(date +%s.%N) $started" | awk '{printf "%.1f", $1 - $2}') s (it promises 60 on an idle machine of two cores)"
tail -n 3 "$work/printed"
[ "$code" = 0 ] || fails "exit code $code: $(cat "$work/printed")"
for file in index.html report.json error-time.md quality.json; do
  [ -s "$work/out/$file" ] || fails "$file is missing"
done
python3 - "$work/out" <<'PY' || fails "report.json does not hold what it should"
import json, os, sys
folder = sys.argv[1]
report = json.load(open(os.path.join(folder, "report.json")))
bad = list(report["left_out"])
wanted = ["clusters", "octree_depth", "ranks", "corners", "cuboid_space", "angle_taps", "levels", "memory", "quality",
          "still", "light_path", "cut_lights", "coat", "ggx_samples", "isochromatic", "environment", "transport",
          "precision", "scan_neighbours", "scan_gamma", "scan_spacing"]
knobs = {knob["id"]: knob for knob in report["knobs"]}
bad += ["no knob " + name for name in wanted if name not in knobs]
for knob in report["knobs"]:
    labels = [setting["label"] for setting in knob["settings"]]
    if knob["default"] not in labels: bad.append(knob["id"] + ": its default is none of its settings")
    if len(set(labels)) != len(labels): bad.append(knob["id"] + ": a label stands twice")
    if not knob["why"]: bad.append(knob["id"] + ": no reason for the default")
    curve = any(os.path.exists(os.path.join(folder, knob["id"] + end)) for end in (".svg", "-bytes.svg"))
    if not curve: bad.append(knob["id"] + ": no curve")
    for setting in knob["settings"]:
        if setting["error"] is None: bad.append(knob["id"] + ", " + setting["label"] + ": no error")
kernels = {case["kernel"] for case in report["stiff"]}
if len(report["stiff"]) < 400: bad.append("only %d stiff cases" % len(report["stiff"]))
if len(kernels) < 6: bad.append("only these kernels: " + ", ".join(sorted(kernels)))
if report["stiff_failed"]: bad.append("%d stiff cases failed" % report["stiff_failed"])
print("%d knobs, %d stiff cases of %d kernels, %d speeds (%d short of their aims on this machine now)" % (
    len(knobs), len(report["stiff"]), len(kernels), len(report["speeds"]), report["speeds_missed"]))
print("\n".join("FAILED: " + line for line in bad))
sys.exit(1 if bad else 0)
PY
[ "$failures" = 0 ] || exit 1
echo "report: all passed"
