"""Runs the system tests: builds or finds the root image, packs the software under test, boots, prints one line a test.

Usage: run.py BUILD_DIR [--remember] [PATTERN...]   (patterns: only tests whose names contain one)
--remember: what has passed with the same inputs (passed.py) is told again, not run again; LACKWERK_FRESH=1 runs it.
Exit codes: 0 all passed, 1 one failed, 77 nothing could run (1 when LACKWERK_REQUIRE_SYSTEM is set). A single test that
cannot run says SKIPPED and its reason, and counts as failed when LACKWERK_REQUIRE_SYSTEM is set.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import traceback

sys.dont_write_bytecode = True
import passed  # noqa: E402
import payload  # noqa: E402
from machine import Failure, Machine  # noqa: E402
from testing import TESTS, Room, Skip  # noqa: E402
import tests_devices  # noqa: E402,F401  (order: the room first, then who lives in it)
import tests_kiosk  # noqa: E402,F401
import tests_store  # noqa: E402,F401  (last: it changes which pack is shown)

REQUIRED = os.environ.get("LACKWERK_REQUIRE_SYSTEM", "") not in ("", "0")
EXIT_SKIPPED = 77


def give_up(reason):
    print(f"SKIPPED: system tests in a virtual machine: {reason}")
    if REQUIRED:
        print("LACKWERK_REQUIRE_SYSTEM is set: that is a failure")
    sys.exit(1 if REQUIRED else EXIT_SKIPPED)


def root_image():
    found = subprocess.run([payload.SOURCE / "scripts" / "vm-image"], stdout=subprocess.PIPE, text=True)
    if found.returncode == EXIT_SKIPPED:
        give_up("no root image (see above)")
    if found.returncode != 0:
        print("FAIL  the root image could not be built")
        sys.exit(1)
    return pathlib.Path(found.stdout.split()[-1])


def main():
    if len(sys.argv) < 2:
        print(__doc__)
        return 2
    build, patterns = pathlib.Path(sys.argv[1]).resolve(), [p for p in sys.argv[2:] if p != "--remember"]
    remembers = "--remember" in sys.argv
    for tool, package in (("qemu-system-x86_64", "qemu-system-x86"), ("qemu-img", "qemu-utils")):
        if shutil.which(tool) is None:
            give_up(f"no {tool}; install {package}")
    started = time.monotonic()
    image = root_image()
    print(f"      root image {image.name}, {time.monotonic() - started:.1f} s", flush=True)
    inputs = passed.key(build, image, patterns)
    before = passed.recall(inputs) if remembers else None
    if before is not None:
        print(before + "LACKWERK_FRESH=1 runs it again")
        return 0
    logs = build / "vm-logs"
    shutil.rmtree(logs, ignore_errors=True)
    logs.mkdir(parents=True)
    demo = payload.SOURCE / "build" / "demo"
    # A unix socket's path is at most 107 bytes: not below a long build folder.
    with tempfile.TemporaryDirectory(prefix="lackwerk-vm-", dir="/tmp") as scratch:
        work = pathlib.Path(scratch)
        disk = work / "payload.img"
        files = {"etc/lackwerk/kiosk.toml": payload.HERE / "kiosk.toml",
                 f"{payload.UNIT_FOLDER}/lackwerk-kiosk.service.d/emulated.conf": payload.HERE / "emulated.conf",
                 f"{payload.RULE_FOLDER}/99-test-knob.rules": payload.HERE / "guest" / "99-test-knob.rules"}
        for name in ("demo.lwp", "sphere.lws"):
            if (demo / name).exists():
                files[f"var/lib/lackwerk/{name}"] = demo / name
        units = payload.make(disk, build, payload.build_helpers(build / "vm-guest"), files)
        room = Room(Machine(image, disk, work), build, demo if len(files) == 5 else None, units, logs)
        code = run_all(room, patterns, logs, started)
        # Skipped tests are not remembered: what is missing may be there next time.
        if code == 0 and remembers and "SKIPPED" not in "".join(room.figures):
            passed.remember(inputs, "".join(line + "\n" for line in room.figures))
        return code


def run_all(room, patterns, logs, started):
    counts = {"PASS": 0, "FAIL": 0, "SKIPPED": 0}
    machine = room.machine
    try:
        for function in TESTS:
            if patterns and not any(p in function.__name__ for p in patterns):
                continue
            began = time.monotonic()
            verdict, why = "PASS", ""
            try:
                if machine.process is None:
                    machine.start()
                    room.note(f"switched on to the command channel: {machine.up_s():.1f} s")
                function(room)
            except Skip as reason:
                verdict, why = "SKIPPED", str(reason)
            except Failure as problem:
                verdict, why = "FAIL", str(problem)
            except Exception:  # a slip in a test must not leave the emulator running or hide the other results
                verdict, why = "FAIL", traceback.format_exc()
            counts[verdict] += 1
            room.say(f"{verdict:<7} {function.__name__} {time.monotonic() - began:.1f} s{': ' + why if why else ''}")
            if verdict == "FAIL":
                machine.collect(logs / function.__name__)
                # The next test starts from a machine that was switched on freshly.
                machine.kill()
    finally:
        machine.kill()
    room.say(f"{counts['PASS']} passed, {counts['FAIL']} failed, {counts['SKIPPED']} skipped in "
             f"{time.monotonic() - started:.0f} s, {machine.boots} boots; logs in {logs}")
    return 1 if counts["FAIL"] or (REQUIRED and counts["SKIPPED"]) else 0


if __name__ == "__main__":
    sys.exit(main())
