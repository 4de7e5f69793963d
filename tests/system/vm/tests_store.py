"""Packs that come on a stick: taken, refused, and a stick pulled too early."""
import json
import pathlib
import shutil
import subprocess
import time

from testing import Skip, expect, test
from tests_kiosk import ANSWER_S, needs_kiosk, wait_picture

IMPORT = "/run/lackwerk/import.json"
STORE = "/var/lib/lackwerk/store"
KEYS = "/etc/lackwerk/keys"
MOUNTS = "/run/lackwerk-import"


def needs_importer(room):
    needs_kiosk(room)
    if shutil.which("minisign") is None:
        raise Skip("no minisign; install it")
    if not (room.build / "lackwerk").exists():
        raise Skip(f"no lackwerk in {room.build}")
    if "--import" not in subprocess.run([room.build / "lackwerk-kiosk", "--help"], capture_output=True, text=True).stdout:
        raise Skip("this lackwerk-kiosk has no --import")


class Maker:
    """A key pair, and sticks with what it signed. The guest trusts it once `trust` was called."""

    def __init__(self, room, name):
        self.room, self.folder = room, room.artefacts / name
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)
        self.public, self.secret = self.folder / "maker.pub", self.folder / "maker.key"
        subprocess.run(["minisign", "-G", "-W", "-f", "-p", self.public, "-s", self.secret], check=True,
                       stdout=subprocess.DEVNULL)

    def trust(self, name):
        self.room.machine.run(f"mkdir -p {KEYS}", check=True)
        self.room.machine.put(f"{KEYS}/{name}.pub", self.public.read_bytes())

    def stick(self, name="stick"):
        """A folder to be plugged in, with the one folder in it that is looked at."""
        folder = self.folder / name
        shutil.rmtree(folder, ignore_errors=True)
        (folder / "lackwerk").mkdir(parents=True)
        return folder

    def put(self, stick, name="demo.lwp"):
        """The demo pack, signed."""
        pack = stick / "lackwerk" / name
        shutil.copyfile(self.room.demo / "demo.lwp", pack)
        subprocess.run([self.room.build / "lackwerk", "pack", "sign", pack, "--secret", self.secret], check=True,
                       stdout=subprocess.DEVNULL)
        return pack


def plug(room, stick):
    """Plugs a stick in and returns what the importer says of it."""
    m = room.machine
    m.run(f"rm -f {IMPORT}")
    started = time.monotonic()
    m.stick_plug("stick", pathlib.Path(stick).resolve())
    text = m.until("the stick was looked at", ANSWER_S * 2, lambda: m.run(f"cat {IMPORT}").out.strip())
    room.note(f"from plugging a stick in to its result: {time.monotonic() - started:.1f} s")
    return json.loads(text)


def pull(room):
    m = room.machine
    m.stick_pull("stick")
    m.until("nothing of the stick is left", ANSWER_S, lambda: not m.read(f"ls {MOUNTS} 2>/dev/null || true") and
            not m.read(f"grep {MOUNTS} /proc/mounts || true"))


def stored(room):
    return room.machine.read(f"cat {STORE}/state 2>/dev/null || true")


@test
def stick_brings_a_pack(room):
    needs_importer(room)
    m = room.machine
    wait_picture(room)
    m.run(f"rm -rf {STORE}")
    maker = Maker(room, "maker")
    maker.trust("maker")
    stick = maker.stick()
    maker.put(stick)
    result = plug(room, stick)
    try:
        expect(result["good"] and result["files"][0]["result"] == "stored", f"the stick was refused: {result}")
        name = result["files"][0]["id"]
        expect(f"pack {name} " in stored(room), f"the store says: {stored(room)}")
        expect(m.run(f"cmp $(find {STORE} -name pack.lwp) /var/lib/lackwerk/demo.lwp").code == 0, "another file is stored")
        expect(m.read(f"stat -c %U {STORE}/state") == "lackwerk", "the importer ran as somebody else")
        again = m.read("systemctl show -P Result 'lackwerk-import@*.service' | sort -u")
        expect(again in ("", "success"), f"the importer ended with: {again}")
    finally:
        pull(room)
    result = plug(room, stick)
    pull(room)
    expect(result["good"] and result["files"][0]["result"] == "already there", f"the second time: {result}")


@test
def stick_is_not_trusted(room):
    needs_importer(room)
    m = room.machine
    m.run(f"rm -rf {STORE}")
    stranger = Maker(room, "stranger")
    stick = stranger.stick()
    stranger.put(stick, "strange.lwp")
    pack = stranger.put(stick, "unsigned.lwp")
    pack.with_name(pack.name + ".minisig").unlink()
    # As much as a stick of the emulator holds is less than what is refused by its size: a long signature does it too.
    pack = stranger.put(stick, "talkative.lwp")
    pack.with_name(pack.name + ".minisig").write_bytes(b"x" * 5000)
    (stick / "lackwerk" / "folder.lwp").mkdir()
    result = plug(room, stick)
    pull(room)
    reasons = {entry["file"]: entry.get("error", "") for entry in result["files"]}
    expect(not result["good"] and len(reasons) == 4, f"four packs should be refused: {result}")
    for name, reason in (("strange.lwp", "not in the keyring"), ("unsigned.lwp", "is not there"),
                         ("talkative.lwp", "at most 4096"), ("folder.lwp", "not a regular file")):
        expect(reason in reasons.get(name, ""), f"{name}: {reasons.get(name)}")
    expect(not stored(room), f"something was stored: {stored(room)}")
    expect(m.run(f"test -e {STORE}/staging/pack").code != 0, "something was left in staging")


@test
def stick_is_mounted_harmlessly(room):
    needs_importer(room)
    m = room.machine
    maker = Maker(room, "slow")
    stick = maker.stick()
    maker.put(stick)
    # Another program in the importer's place holds the mount open and says what it sees.
    drop_in = "/run/systemd/system/lackwerk-import@.service.d"
    seen = "/run/lackwerk/seen"
    look = (f"grep {MOUNTS}/%i /proc/self/mounts >{seen}; id -un >>{seen}; touch {MOUNTS}/%i/x 2>>{seen}; "
            f"cat /dev/%I 2>>{seen} >/dev/null; sleep 1000")
    m.run(f"mkdir -p {drop_in}", check=True)
    m.put(f"{drop_in}/look.conf", f"[Service]\nExecStart=\nExecStart=/bin/sh -c \"{look}\"\n".encode())
    m.run("systemctl daemon-reload", check=True)
    try:
        m.stick_plug("stick", stick.resolve())
        text = m.until("the stick is mounted", ANSWER_S, lambda: (m.run(f"cat {seen}").out.count("\n") >= 4 and
                                                                  m.run(f"cat {seen}").out))
        room.note(text.splitlines()[0])
        for option in ("ro", "nosuid", "nodev", "noexec"):
            expect(option in text.splitlines()[0].split()[3].split(","), f"mounted without {option}: {text}")
        expect(text.splitlines()[1] == "lackwerk", f"runs as {text.splitlines()[1]}")
        # Pulled while it is read: the unit ends by itself, and nothing of the mount stays.
        pull(room)
        m.until("the importer has ended", ANSWER_S,
                lambda: not m.read("systemctl list-units --no-legend 'lackwerk-import@*' | grep running || true"))
    finally:
        m.run(f"rm -r {drop_in}; systemctl daemon-reload; rm -f {seen}")


@test
def store_survives_a_power_cut(room):
    needs_importer(room)
    m = room.machine
    m.run(f"rm -rf {STORE}")
    maker = Maker(room, "power")
    maker.trust("power")
    stick = maker.stick()
    maker.put(stick)
    m.run(f"rm -f {IMPORT}")
    m.stick_plug("stick", stick.resolve())
    m.until("the importer has begun", ANSWER_S, lambda: m.run(f"test -e {STORE}/lock").code == 0, step_s=0.02)
    m.kill()
    m.start()
    found = stored(room)
    room.note("after the power cut the store had " + ("the pack" if found else "nothing"))
    result = plug(room, stick)
    pull(room)
    expect(result["good"], f"the store is not usable any more: {result}")
    expect(m.read(f"ls {STORE}/staging 2>/dev/null | wc -l") == "0", "something was left in staging")
    wait_picture(room)
