"""Remembers that the whole suite has passed, by the hash of everything that goes into the machine.

The suite takes a quarter of an hour of two cores, and most changes do not touch the kiosk. What was shown for the very
same inputs is told again instead of run again: with the lines of the run that passed, never silently.
LACKWERK_FRESH=1 runs it all the same.
"""
import hashlib
import os
import pathlib
import time

import payload

# What the kiosk, the machine and the tests are made of; the tools' own sources only make its pictures and packs.
ROOTS = ("core", "packs", "render_gles", "input", "kiosk/display", "systemd", "tests/system/vm")
FILES = ("CMakeLists.txt", "CMakePresets.json", "scripts/vm-image")
NOT_IN_IT = ("core/analysis", "packs/tools")


def _sources():
    for name in FILES:
        yield payload.SOURCE / name
    for root in ROOTS:
        for path in sorted((payload.SOURCE / root).rglob("*")):
            inner = path.relative_to(payload.SOURCE).as_posix()
            if path.is_file() and "__pycache__" not in inner and not inner.startswith(NOT_IN_IT):
                yield path


def key(build, image, patterns):
    """A hash of sources, kind of build, root image, demo pack and choice of tests."""
    digest = hashlib.sha256()
    kind = next((line for line in (build / "CMakeCache.txt").read_text().splitlines()
                 if line.startswith("CMAKE_BUILD_TYPE")), "")
    for text in (kind, image.name, *patterns):
        digest.update(text.encode() + b"\0")
    for path in _sources():
        digest.update(path.relative_to(payload.SOURCE).as_posix().encode() + b"\0")
        digest.update(hashlib.sha256(path.read_bytes()).digest())
    for name in ("demo.lwp", "sphere.lws"):
        shown = payload.SOURCE / "build" / "demo" / name
        digest.update(hashlib.sha256(shown.read_bytes()).digest() if shown.exists() else b"none")
    return digest.hexdigest()[:32]


def _folder():
    cache = os.environ.get("LACKWERK_CACHE") or pathlib.Path(
        os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "lackwerk"
    return pathlib.Path(cache) / "vm-passed"


def recall(name):
    """The lines of the run that passed, or None."""
    if os.environ.get("LACKWERK_FRESH", "") not in ("", "0"):
        return None
    try:
        return (_folder() / name).read_text()
    except OSError:
        return None


def remember(name, lines):
    folder = _folder()
    folder.mkdir(parents=True, exist_ok=True)
    fresh = folder / (name + ".new")
    fresh.write_text(time.strftime("passed on %Y-%m-%d %H:%M UTC, with the same inputs:\n", time.gmtime()) + lines)
    fresh.replace(folder / name)
