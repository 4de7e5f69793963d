"""Packs that come on a stick: taken, refused, and a stick pulled too early."""
import json
import pathlib
import shutil
import subprocess
import time

import payload
from testing import Skip, expect, test
from machine import patience
from tests_kiosk import ANSWER_S, UNIT, needs_kiosk, pid, status, wait_picture, wait_rest

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

    def put(self, stick, name="demo.lwp", source=None):
        """The demo pack or another one, signed."""
        pack = stick / "lackwerk" / name
        shutil.copyfile(source or self.room.demo / "demo.lwp", pack)
        subprocess.run([self.room.build / "lackwerk", "pack", "sign", pack, "--secret", self.secret], check=True,
                       stdout=subprocess.DEVNULL)
        return pack


def other_pack(room):
    """A small pack of one paint, unlike the demo's."""
    folder, pack = room.artefacts / "other.capture", room.artefacts / "other.lwp"
    recipe = payload.SOURCE / "packs" / "recipes" / "gu_opel_titan_coated.toml"
    subprocess.run([room.build / "lackwerk", "capture", recipe, "-o", folder, "--edge", "16"], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    subprocess.run([room.build / "lackwerk", "pack", "build", folder, "-o", pack, "--id", "other", "--serial", "7"],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
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
def store_survives_losing_power(room):
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


@test
def stick_changes_the_paint(room):
    """A kiosk that shows what the store holds: empty at first, then a stick, then another one while it runs."""
    needs_importer(room)
    m = room.machine
    text = m.read("cat /etc/lackwerk/kiosk.toml")
    m.run(f"systemctl stop {UNIT}; rm -rf {STORE} {KEYS}/revoked", 60, check=True)
    maker = Maker(room, "swap")
    maker.trust("swap")
    try:
        ours = "\n".join(line for line in text.splitlines() if not line.startswith(("packs", "allow_unsigned")))
        m.put("/etc/lackwerk/kiosk.toml", ours.encode())
        m.run(f"systemctl start --no-block {UNIT}", check=True)
        m.until("a kiosk without a pack says so", ANSWER_S,
                lambda: "store is empty" in m.run(f"journalctl -u {UNIT} -n 50 --no-pager").out)
        stick = maker.stick("first")
        maker.put(stick)
        expect(plug(room, stick)["good"], "the first stick was refused")
        pull(room)
        wait_picture(room)
        wait_rest(room)
        process, before = pid(room), m.screen(room.artefacts / "swap.before.png")
        expect(status(room)["packs"][0]["signed"], "the pack is signed, the status says otherwise")
        stick = maker.stick("second")
        maker.put(stick, "other.lwp", other_pack(room))
        expect(plug(room, stick)["good"], "the second stick was refused")
        darkest, changes, end = 1.0, 0, time.monotonic() + ANSWER_S
        while status(room)["packs"][0]["id"] != "other" or not status(room)["resting"]:
            shown = m.screen()
            changes += shown.changed_share(before) > 0.01
            darkest = min(darkest, shown.colours() / before.colours())
            expect(time.monotonic() < end, "the other pack is not shown")
        pull(room)
        after = m.screen(room.artefacts / "swap.after.png")
        room.note(f"pack to pack: {changes} screens seen on the way, fewest colours {darkest:.2f} of before")
        expect(after.changed_share(before) > 0.05, "the picture is the same")
        expect(darkest > 0.2, "there was a black screen on the way")
        expect(pid(room) == process, "the kiosk was restarted")
        # A pack that was damaged after it was stored never shows.
        m.run(f"f=$(find {STORE}/packs/other -name pack.lwp); printf x >> $f; touch {STORE}/x; mv {STORE}/x {STORE}/state2; "
              f"cp {STORE}/state {STORE}/y; mv {STORE}/y {STORE}/state", check=True)
        time.sleep(3.0)
        expect(pid(room) == process and status(room)["packs"][0]["id"] == "other", "a damaged file ended the kiosk")
    finally:
        m.put("/etc/lackwerk/kiosk.toml", text.encode())
        m.run(f"rm -rf {STORE}; systemctl restart --no-block {UNIT}", 60)
