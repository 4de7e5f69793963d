"""Packs that come on a stick: taken, refused, and a stick pulled too early."""
import json
import os
import shutil
import subprocess
import time

import payload
from testing import Skip, expect, test
from machine import patience
from tests_kiosk import ANSWER_S, UNIT, needs_kiosk, pid, status, wait_picture, wait_rest

IMPORT = "/run/lackwerk/import.json"
IMPORTER = "'lackwerk-import@*.service'"
STORE = "/var/lib/lackwerk/store"
KEYS = "/etc/lackwerk/keys"
MOUNTS = "/run/lackwerk-import"
# What a pack may cost while it is opened and realised: docs/packs-and-store.md, "Memory".
MOST_PACK_MB = 64 + 8 + 11


def needs_importer(room):
    needs_kiosk(room)
    for tool, package in (("minisign", "minisign"), ("mkfs.vfat", "dosfstools"), ("mcopy", "mtools")):
        if shutil.which(tool, path=os.environ["PATH"] + ":/usr/sbin:/sbin") is None:
            raise Skip(f"no {tool}; install {package}")
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

    def stick(self, name="stick", inside="lackwerk"):
        """A folder to be plugged in, with the one folder in it that is looked at."""
        folder = self.folder / name
        shutil.rmtree(folder, ignore_errors=True)
        (folder / inside).mkdir(parents=True)
        return folder

    def put(self, stick, name="demo.lwp", source=None):
        """The demo pack or another one, signed."""
        pack = next(stick.iterdir()) / name
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


def plug(room, stick, partitioned=True):
    """Plugs a stick in and returns what the importer says of it."""
    m = room.machine
    m.run(f"rm -f {IMPORT}")
    started = time.monotonic()
    m.stick_plug("stick", stick, partitioned)
    text = m.until("the stick was looked at", ANSWER_S * 2, lambda: m.run(f"cat {IMPORT}").out.strip())
    room.note(f"from plugging a stick in to its result: {time.monotonic() - started:.1f} s")
    return json.loads(text)


def pull(room):
    m = room.machine
    unwritten = m.stick_pull("stick")
    m.until("nothing of the stick is left", ANSWER_S,
            lambda: not m.read(f"ls {MOUNTS} 2>/dev/null; grep {MOUNTS} /proc/mounts; "
                               f"systemctl list-units --all --plain --no-legend {IMPORTER}; true"))
    expect(unwritten, "something was written to the stick")


def stored(room):
    return room.machine.read(f"cat {STORE}/state 2>/dev/null || true")


@test
def stick_brings_a_pack(room):
    needs_importer(room)
    m = room.machine
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
    finally:
        pull(room)
    expect(m.run(f"journalctl --no-pager -u {IMPORTER} | grep -q 'Finished'").code == 0, "the importer did not succeed")
    # The same as old systems write it: short names, in capitals alone.
    stick = maker.stick(inside="LACKWERK")
    maker.put(stick, "DEMO.LWP")
    result = plug(room, stick)
    pull(room)
    expect(result["good"] and result["files"][0]["result"] == "already there", f"the second time: {result}")
    expect(result["files"][0]["file"] == "DEMO.LWP", f"no capitals: {result}")


@test
def stick_is_not_trusted(room):
    needs_importer(room)
    m = room.machine
    m.run(f"rm -rf {STORE}; mkdir -p {KEYS}")
    stranger = Maker(room, "stranger")
    stick = stranger.stick()
    stranger.put(stick, "strange.lwp")
    pack = stranger.put(stick, "unsigned.lwp")
    pack.with_name(pack.name + ".minisig").unlink()
    pack = stranger.put(stick, "talkative.lwp")
    pack.with_name(pack.name + ".minisig").write_bytes(b"x" * 4097)
    pack = stranger.put(stick, "huge.lwp")
    os.truncate(pack, (64 << 20) + 1)
    (pack.parent / "folder.lwp").mkdir()
    # A stick without partitions.
    result = plug(room, stick, partitioned=False)
    pull(room)
    reasons = {entry["file"]: entry.get("error", "") for entry in result["files"]}
    expect(not result["good"] and len(reasons) == 5, f"five packs should be refused: {result}")
    for name, reason in (("strange.lwp", "not in the keyring"), ("unsigned.lwp", "is not there"),
                         ("talkative.lwp", "at most 4096"), ("huge.lwp", "at most 67108864"),
                         ("folder.lwp", "not a regular file")):
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
        m.stick_plug("stick", stick)
        text = m.until("the stick is mounted", ANSWER_S, lambda: (m.run(f"cat {seen}").out.count("\n") >= 4 and
                                                                  m.run(f"cat {seen}").out))
        mount, user, write, device = text.splitlines()[:4]
        room.note(mount)
        for option in ("ro", "nosuid", "nodev", "noexec"):
            expect(option in mount.split()[3].split(","), f"mounted without {option}: {text}")
        expect(user == "lackwerk", f"runs as {user}")
        expect("Read-only" in write, f"a file could be made: {write}")
        expect("No such file" in device or "not permitted" in device, f"the device itself can be read: {device}")
        # Pulled while it is read: the unit ends by itself, and nothing of the mount stays.
        pull(room)
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
    m.stick_plug("stick", stick)
    m.until("the importer has begun", ANSWER_S, lambda: m.run(f"test -e {STORE}/lock").code == 0, step_s=0.02)
    m.kill()
    m.start()
    found = stored(room)
    room.note("after the power cut the store had " + ("the pack" if found else "nothing"))
    result = plug(room, stick)
    pull(room)
    expect(result["good"], f"the store is not usable any more: {result}")
    expect(m.read(f"ls {STORE}/staging 2>/dev/null | wc -l") == "0", "something was left in staging")


def memory(room):
    """Of the kiosk, in MiB: what it holds, the most it ever held, its unit's limit (0: none); its own resident pages and
    the most of those since forget_peak."""
    m = room.machine
    group = "/sys/fs/cgroup" + m.read(f"systemctl show -P ControlGroup {UNIT}")
    now, peak, limit = m.read(f"cd {group}; cat memory.current memory.peak memory.max").split()
    resident = dict(line.split()[:2] for line in m.read(f"grep -E 'VmRSS|VmHWM' /proc/{pid(room)}/status").splitlines())
    mib = {"now": int(now) >> 20, "peak": int(peak) >> 20, "limit": 0 if limit == "max" else int(limit) >> 20}
    return {**mib, "resident": int(resident["VmRSS:"]) >> 10, "resident_peak": int(resident["VmHWM:"]) >> 10}


def forget_peak(room):
    """See proc(5), clear_refs."""
    room.machine.run(f"echo 5 > /proc/{pid(room)}/clear_refs", check=True)


def light(picture):
    """Mean of all channels."""
    return sum(picture.rgb) / len(picture.rgb)


def watch_until(room, what, condition):
    """Every screen that is unlike the one before it, as fast as the emulator tells them, until condition() holds."""
    m, screens, end, look = room.machine, [], time.monotonic() + ANSWER_S * patience(), 0.0
    while True:
        shown = m.screen()
        if not screens or shown.rgb != screens[-1].rgb:
            screens.append(shown)
        if time.monotonic() >= look:
            if condition():
                return screens
            expect(time.monotonic() < end, f"not in time: {what}")
            look = time.monotonic() + 0.5


@test
def stick_changes_the_paint(room):
    """A kiosk that shows what the store holds: empty at first, then a stick, then another one while it runs."""
    needs_importer(room)
    m = room.machine
    text = m.read("cat /etc/lackwerk/kiosk.toml")
    m.run(f"systemctl stop {UNIT}; rm -rf {STORE} {KEYS}/revoked", 60, check=True)
    maker = Maker(room, "swap")
    maker.trust("swap")
    # On a busy host one frame of an emulated processor may take longer than the watchdog waits, which has its own tests.
    m.run("systemctl service-watchdogs no", check=True)
    try:
        ours = "\n".join(line for line in text.splitlines() if not line.startswith(("packs", "allow_unsigned")))
        m.put("/etc/lackwerk/kiosk.toml", ours.encode())
        m.run(f"systemctl start --no-block {UNIT}", check=True)
        m.until("a kiosk without a pack says so", ANSWER_S,
                lambda: "store is empty" in m.run(f"journalctl -u {UNIT} -n 50 --no-pager").out)
        stick = maker.stick("first")
        maker.put(stick)
        # Not by import.json: the kiosk that is started over and over takes its runtime folder with it.
        m.stick_plug("stick", stick)
        m.until("the first stick was taken", ANSWER_S * 2, lambda: "shown lackwerk.demo" in stored(room))
        pull(room)
        wait_picture(room)
        wait_rest(room)
        process, before = pid(room), m.screen(room.artefacts / "swap.before.png")
        expect(status(room)["packs"][0]["signed"], "the pack is signed, the status says otherwise")
        forget_peak(room)
        memory_before = memory(room)
        stick = maker.stick("second")
        maker.put(stick, "other.lwp", other_pack(room))
        m.stick_plug("stick", stick)

        def swapped():
            now = status(room)
            return now["packs"][0]["id"] == "other" and now["resting"]

        screens = watch_until(room, "the other pack is shown", swapped)
        memory_after = memory(room)
        pull(room)
        after = m.screen(room.artefacts / "swap.after.png")
        between = [s for s in screens if s.changed_share(before) > 0.01 and s.changed_share(after) > 0.01]
        for number, shown in enumerate(between):
            shown.save_png(room.artefacts / f"swap.between.{number}.png")
        darkest = min(light(s) for s in screens) / min(light(before), light(after))
        fewest = min(s.colours() for s in screens) / min(before.colours(), after.colours())
        room.note(f"pack to pack: {len(screens)} different screens, {len(between)} between; of the lesser end, the darkest "
                  f"has {darkest:.2f} of the light, the poorest {fewest:.2f} of the colours")
        room.note(f"memory in MiB before {memory_before}, after {memory_after}")
        expect(after.changed_share(before) > 0.05, "the picture is the same")
        expect(darkest > 0.8 and fewest > 0.5, "there was a black screen on the way")
        expect(pid(room) == process, "the kiosk was restarted")
        expect(memory_after["resident_peak"] <= memory_before["resident"] + MOST_PACK_MB, "the change took too much memory")
        expect(not memory_after["limit"] or memory_after["peak"] < memory_after["limit"], "the unit's limit was reached")
        # A pack that was damaged after it was stored never shows, whatever the store says.
        m.run(f"printf x >> $(find {STORE}/packs/lackwerk.demo -name pack.lwp); "
              f"sed 's/^shown .*/shown lackwerk.demo/' {STORE}/state > {STORE}/fresh; mv {STORE}/fresh {STORE}/state", check=True)
        m.until("the damaged pack is refused", ANSWER_S,
                lambda: any(f"{STORE}/packs/lackwerk.demo" in error["text"] for error in status(room)["errors"]))
        expect(pid(room) == process and status(room)["packs"][0]["id"] == "other", "a damaged file ended the kiosk")
    finally:
        m.put("/etc/lackwerk/kiosk.toml", text.encode())
        m.run(f"systemctl service-watchdogs yes; rm -rf {STORE}; systemctl restart --no-block {UNIT}", 60)
