"""The emulated machine: starts it, talks to it, pulls its plug.

Why it exists: the kiosk is a thing in a room, and a room has a power switch, a screen, a hand and a USB port. One
Machine is one disk that may be switched on many times. Only the standard library; one thread; the emulator is a child
process that never outlives this one. Every wait has a limit and raises Failure with what was waited for.
"""
import ctypes
import hashlib
import json
import os
import pathlib
import signal
import socket
import struct
import subprocess
import time
import zlib

PR_SET_PDEATHSIG = 1
QMP_WAIT_S = 60.0  # an emulator that is only slow answers within this
PORT_NAME = "lackwerk.agent"


class Failure(Exception):
    """What a test expected did not happen."""


class Done:
    """A command that ran in the guest: exit code, output as text."""

    def __init__(self, code, out, err):
        self.code, self.raw, self.err = code, out, err.decode(errors="replace")

    @property
    def out(self):
        return self.raw.decode(errors="replace")


class Picture:
    """Eight-bit RGB, rows from the top."""

    def __init__(self, width, height, rgb):
        self.width, self.height, self.rgb = width, height, rgb

    @staticmethod
    def from_ppm(data):
        fields, at = [], 0
        while len(fields) < 4:
            end = at
            while data[end:end + 1] not in (b" ", b"\n", b"\t", b""):
                end += 1
            if end > at:
                fields.append(data[at:end])
            at = end + 1
            if end >= len(data):
                break
        if len(fields) != 4 or fields[0] != b"P6" or fields[3] != b"255":
            raise Failure("the screen dump is no 8-bit PPM")
        width, height = int(fields[1]), int(fields[2])
        rgb = data[at:at + width * height * 3]
        if len(rgb) != width * height * 3:
            raise Failure("the screen dump is cut short")
        return Picture(width, height, rgb)

    def save_png(self, path):
        rows = b"".join(b"\0" + self.rgb[y * self.width * 3:(y + 1) * self.width * 3] for y in range(self.height))

        def chunk(kind, body):
            return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

        head = struct.pack(">IIBBBBB", self.width, self.height, 8, 2, 0, 0, 0)
        pathlib.Path(path).write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) +
                                       chunk(b"IDAT", zlib.compress(rows, 6)) + chunk(b"IEND", b""))

    def colours(self):
        """How many different colours it has: 1 is a dead screen, a picture of a car has thousands."""
        return len({self.rgb[i:i + 3] for i in range(0, len(self.rgb), 3)})

    def changed_share(self, other):
        """Share of the pixels that differ by more than 2 of 255 in some channel."""
        if (self.width, self.height) != (other.width, other.height):
            return 1.0
        if self.rgb == other.rgb:
            return 0.0
        different = sum(1 for i in range(0, len(self.rgb), 3)
                        if max(abs(a - b) for a, b in zip(self.rgb[i:i + 3], other.rgb[i:i + 3])) > 2)
        return different / (self.width * self.height)


def make_stick(image, folder, partitioned):
    """Writes a FAT32 disk with the files of `folder` into the file `image`, without a mount."""
    sector, start = 512, 2048 if partitioned else 0  # where sticks are sold with their partition: at 1 MiB
    # FAT32 is what it is by having more than 65,525 clusters: 32 MiB and some of one sector each.
    files = sum(p.stat().st_size for p in folder.rglob("*") if p.is_file())
    sectors = (files + (40 << 20)) // sector
    image.unlink(missing_ok=True)
    with open(image, "wb") as disk:
        disk.truncate((start + sectors) * sector)
        if partitioned:
            # One entry of type 0x0c, FAT32 by sector numbers; those by cylinders say "see the others".
            entry = struct.pack("<B3sB3sII", 0, b"\xfe\xff\xff", 0x0C, b"\xfe\xff\xff", start, sectors)
            disk.write(bytes(446) + entry + bytes(48) + b"\x55\xaa")
    where = {"PATH": "/usr/sbin:/sbin:/usr/bin:/bin", "MTOOLS_SKIP_CHECK": "1"}
    subprocess.run(["mkfs.vfat", "-F", "32", "-s", "1", "-n", "STICK", f"--offset={start}", image, str(sectors // 2)],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=where)
    subprocess.run(["mcopy", "-s", "-o", "-Q", "-i", f"{image}@@{start * sector}", *sorted(folder.iterdir()), "::/"], check=True,
                   stdin=subprocess.DEVNULL, env=where)


def _die_with_parent():
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    os.setpgid(0, 0)
    os.nice(5)


def patience():
    """By how much longer than on an idle host to wait: how many programs share a core, at most ten."""
    return min(10.0, max(1.0, os.getloadavg()[0] / (os.cpu_count() or 1)))


class Machine:
    """`image`: folder of scripts/vm-image. `payload`: ext4 file with the software under test. `work`: scratch folder.
    `size` of the monitor: one that is too small (320x180) makes the emulated monitor's description invalid."""

    def __init__(self, image, payload, work, size=(640, 360), memory_mb=2048):
        self.image, self.payload, self.work = map(pathlib.Path, (image, payload, work))
        self.size, self.memory_mb = size, memory_mb
        self.process = self._qmp = self._agent = None
        self._next_id, self._qmp_buffer, self._agent_buffer = 1, b"", b""
        self.events = []
        self._sticks = {}  # digests of those that are plugged in, by name
        self.started_at = 0.0
        self.boots = 0
        self.work.mkdir(parents=True, exist_ok=True)
        self.disk = self.work / "disk.qcow2"
        self.disk.unlink(missing_ok=True)
        subprocess.run(["qemu-img", "create", "-q", "-f", "qcow2", "-F", "raw", "-b", self.image / "root.img", self.disk],
                       check=True)

    # ---- power

    def start(self, monitor=True, wait_s=240.0):
        """Switches on; returns when the command channel answers. The disk keeps what it had. `monitor`: on the cable."""
        self.boots += 1
        qmp, agent = self.work / "qmp", self.work / "agent"
        for path in (qmp, agent):
            path.unlink(missing_ok=True)
        self.serial = self.work / f"serial-{self.boots}.log"
        command = [
            "qemu-system-x86_64", "-accel", "tcg,thread=multi", "-cpu", "Nehalem", "-smp", "2",
            "-m", str(self.memory_mb), "-nodefaults", "-no-user-config", "-no-reboot", "-display", f"vnc=unix:{self.work / 'vnc'}", "-vga", "none",
            "-device", f"virtio-gpu-pci,xres={self.size[0]},yres={self.size[1]}",
            "-device", "qemu-xhci,id=usb", "-device", "usb-tablet",
            "-drive", f"file={self.disk},format=qcow2,if=virtio",
            "-drive", f"file={self.payload},format=raw,if=virtio,readonly=on",
            "-device", "virtio-serial-pci", "-chardev", f"socket,id=agent,path={agent},server=on,wait=off",
            "-device", f"virtserialport,chardev=agent,name={PORT_NAME}",
            "-serial", f"file:{self.serial}", "-qmp", f"unix:{qmp},server=on,wait=off",
            "-kernel", self.image / "vmlinuz", "-initrd", self.image / "initrd",
            "-append", "console=ttyS0 quiet panic=5 rw mitigations=off audit=0 noresume random.trust_cpu=on",
        ]
        self.started_at = time.monotonic()
        log = open(self.work / f"emulator-{self.boots}.log", "wb")
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                        preexec_fn=_die_with_parent)
        log.close()
        self._qmp = self._connect(qmp)
        self._qmp_buffer, self.events = b"", []
        self._qmp_line(QMP_WAIT_S)  # the greeting
        self.qmp("qmp_capabilities")
        # Said once while the firmware runs, so that the emulator takes the next word as a change.
        self.monitor(*self.size)
        if not monitor:
            self.monitor(0, 0)
        self._agent = self._connect(agent)
        self._agent_buffer = b""
        self.until("the command channel answers", wait_s, lambda: self._ping(), step_s=0.2)

    def _ping(self):
        try:
            return self.run("true", timeout_s=2.0).code == 0
        except Failure:
            if self.process.poll() is not None:
                raise
            return False

    def _connect(self, path):
        end = time.monotonic() + 30.0
        while time.monotonic() < end:
            if self.process.poll() is not None:
                raise Failure(f"the emulator ended at once: {self.emulator_log()}")
            try:
                connection = socket.socket(socket.AF_UNIX)
                connection.connect(str(path))
                return connection
            except OSError:
                connection.close()
                time.sleep(0.05)
        raise Failure(f"the emulator never opened {path}")

    def kill(self):
        """Power cut: what the guest had not flushed is gone."""
        if self.process is None:
            return
        self.process.kill()
        self.process.wait()
        for connection in (self._qmp, self._agent):
            if connection is not None:
                connection.close()
        self.process = self._qmp = self._agent = None
        self._sticks = {}

    def up_s(self):
        """Seconds since it was switched on."""
        return time.monotonic() - self.started_at

    # ---- waiting

    def until(self, what, limit_s, condition, step_s=0.25):
        """Calls condition() until it is true and returns its value; raises Failure after limit_s, or later on a busy
        host: an emulated second is then worth less."""
        limit_s *= patience()
        end = time.monotonic() + limit_s
        while True:
            value = condition()
            if value:
                return value
            if self.process is None or self.process.poll() is not None:
                raise Failure(f"the machine went off while waiting: {what}; {self.emulator_log()}")
            if time.monotonic() >= end:
                raise Failure(f"not within {limit_s:.0f} s: {what}")
            time.sleep(step_s)

    # ---- commands in the guest

    def run(self, command, timeout_s=60.0, data=b"", check=False):
        """Runs a shell command as root. `check`: a code other than 0 raises Failure."""
        ident, self._next_id = self._next_id, self._next_id + 1
        text = command.encode()
        head = f"{ident} {int(timeout_s * patience() * 1000)} {len(text)} {len(data)}\n".encode()
        self._agent.settimeout(QMP_WAIT_S)
        # The guest keeps the time limit by its own clock and answers in any case; a dead one is given up after twice that.
        end = time.monotonic() + (timeout_s if command == "true" else timeout_s * 2.0 * patience() + 10.0)
        try:
            self._agent.sendall(head + text + data)
            while True:
                words = self._agent_line(end).split()
                if len(words) != 4 or not all(w.lstrip(b"-").isdigit() for w in words):
                    continue
                answered, code, out_bytes, err_bytes = map(int, words)
                out, err = self._agent_bytes(out_bytes, end), self._agent_bytes(err_bytes, end)
                if answered == ident:
                    break
        except (TimeoutError, OSError) as problem:
            raise Failure(f"no answer to '{command[:80]}': {problem}") from problem
        done = Done(code, out, err)
        if check and code != 0:
            raise Failure(f"'{command[:120]}' ended with {code}: {done.err.strip()[-400:]} {done.out.strip()[-200:]}")
        return done

    def read(self, command, timeout_s=60.0):
        """Output of a command that must succeed, without the last line break."""
        return self.run(command, timeout_s, check=True).out.rstrip("\n")

    def put(self, path, data, mode="644"):
        """It is on the disk when this returns: a machine that is killed later has it."""
        self.run(f"cat > '{path}' && chmod {mode} '{path}' && sync '{path}'", data=data, check=True)

    def get(self, path):
        return self.run(f"cat '{path}'", check=True).raw

    def background(self, unit, command):
        """Starts a helper that stays, as a transient service; stop it with `systemctl stop UNIT`."""
        self.run(f"systemctl stop {unit} 2>/dev/null; systemctl reset-failed {unit} 2>/dev/null; "
                 f"systemd-run --quiet --collect --unit={unit} {command}", check=True)

    def _agent_line(self, end):
        while b"\n" not in self._agent_buffer:
            self._agent_more(end)
        line, self._agent_buffer = self._agent_buffer.split(b"\n", 1)
        return line

    def _agent_bytes(self, count, end):
        while len(self._agent_buffer) < count:
            self._agent_more(end)
        out, self._agent_buffer = self._agent_buffer[:count], self._agent_buffer[count:]
        return out

    def _agent_more(self, end):
        left = end - time.monotonic()
        if left <= 0:
            raise TimeoutError("time is up")
        self._agent.settimeout(left)
        more = self._agent.recv(1 << 20)
        if not more:
            raise OSError("the channel is closed")
        self._agent_buffer += more

    # ---- the emulator's own channel

    def qmp(self, name, **arguments):
        message = {"execute": name}
        if arguments:
            message["arguments"] = {key.replace("_", "-"): value for key, value in arguments.items()}
        self._qmp.sendall(json.dumps(message).encode())
        while True:
            answer = self._qmp_line(QMP_WAIT_S)
            if "event" in answer:
                self.events.append(answer)
            elif "error" in answer:
                raise Failure(f"emulator: {name}: {answer['error'].get('desc')}")
            else:
                return answer.get("return")

    def _qmp_line(self, limit_s):
        self._qmp.settimeout(limit_s)
        while b"\n" not in self._qmp_buffer:
            try:
                more = self._qmp.recv(1 << 16)
            except OSError as problem:
                raise Failure(f"the emulator does not answer: {problem}") from problem
            if not more:
                raise Failure(f"the emulator ended: {self.emulator_log()}")
            self._qmp_buffer += more
        line, self._qmp_buffer = self._qmp_buffer.split(b"\n", 1)
        return json.loads(line)

    def screen(self, save_as=None):
        """What the monitor shows."""
        path = self.work / "screen.ppm"
        self.qmp("screendump", filename=str(path))
        picture = Picture.from_ppm(path.read_bytes())
        if save_as is not None:
            picture.save_png(save_as)
        return picture

    def monitor(self, width, height):
        """Puts another monitor on the cable, or none (0, 0), as a viewer of the emulator's screen can: the guest's driver
        gets the interrupt of a real hot-plug, the connector's state changes, its preferred mode is width x height."""
        with socket.socket(socket.AF_UNIX) as viewer:
            viewer.settimeout(QMP_WAIT_S)
            viewer.connect(str(self.work / "vnc"))

            def take(count):
                got = b""
                while len(got) < count:
                    more = viewer.recv(count - len(got))
                    if not more:
                        raise Failure("the emulator's screen server hung up")
                    got += more
                return got

            # RFC 6143, 7.1 to 7.3: version, security type 1 (none), shared session.
            take(12)
            viewer.sendall(b"RFB 003.008\n")
            take(take(1)[0])
            viewer.sendall(b"\1")
            take(4)
            viewer.sendall(b"\1")
            take(struct.unpack(">20xI", take(24))[0])
            # SetEncodings: ExtendedDesktopSize (-308); then SetDesktopSize with one screen.
            viewer.sendall(struct.pack(">BxHi", 2, 1, -308))
            viewer.sendall(struct.pack(">BxHHBxIHHHHI", 251, width, height, 1, 0, 0, 0, width, height, 0))
            # The emulator answers once it has passed the wish on.
            viewer.sendall(struct.pack(">BBHHHH", 3, 0, 0, 0, 1, 1))
            take(4)

    def pointer(self, x, y, button=None):
        """Moves the emulated tablet to a fraction of the screen; `button`: True presses, False lets go."""
        events = [{"type": "abs", "data": {"axis": axis, "value": int(round(place * 32767))}}
                  for axis, place in (("x", x), ("y", y))]
        if button is not None:
            events.append({"type": "btn", "data": {"button": "left", "down": button}})
        self.qmp("input-send-event", events=events)

    def tap(self, x, y):
        self.pointer(x, y)
        self.pointer(x, y, True)
        time.sleep(0.15)
        self.pointer(x, y, False)

    def drag(self, x0, y0, x1, y1, steps=12, period_s=0.05):
        self.pointer(x0, y0)
        self.pointer(x0, y0, True)
        for i in range(1, steps + 1):
            time.sleep(period_s)
            self.pointer(x0 + (x1 - x0) * i / steps, y0 + (y1 - y0) * i / steps)
        self.pointer(x1, y1, False)

    def usb_plug(self, ident, driver="usb-tablet"):
        self.qmp("device_add", driver=driver, id=ident, bus="usb.0")

    def usb_unplug(self, ident):
        """Returns when the guest's controller has let go of it."""
        self.qmp("device_del", id=ident)

        def gone():
            self.qmp("query-status")
            return any(e["event"] == "DEVICE_DELETED" and e["data"].get("device") == ident for e in self.events)

        self.until(f"USB device {ident} is gone", 30.0, gone)
        self.events = [e for e in self.events if e["data"].get("device") != ident]

    def stick_plug(self, ident, folder, partitioned=True):
        """A USB stick with the files of a host folder, as sticks are sold: FAT32, in a partition (or on the whole stick).
        It can be written to; stick_pull says whether anybody has."""
        image = self.stick_image(ident)
        make_stick(image, pathlib.Path(folder), partitioned)
        self._sticks[ident] = hashlib.sha256(image.read_bytes()).digest()
        self.qmp("blockdev-add", driver="raw", node_name=f"{ident}-disk", file={"driver": "file", "filename": str(image)})
        self.qmp("device_add", driver="usb-storage", id=ident, bus="usb.0", drive=f"{ident}-disk", removable=True)

    def stick_pull(self, ident):
        """Without asking anybody, as visitors do. True: nothing was written to it."""
        self.usb_unplug(ident)
        self.qmp("blockdev-del", node_name=f"{ident}-disk")
        image = self.stick_image(ident)
        same = hashlib.sha256(image.read_bytes()).digest() == self._sticks.pop(ident)
        image.unlink()
        return same

    def stick_image(self, ident):
        return self.work / f"{ident}.img"

    # ---- traces for whoever must find out why

    def emulator_log(self):
        path = self.work / f"emulator-{self.boots}.log"
        return path.read_text(errors="replace").strip()[-500:] if path.exists() else ""

    def collect(self, folder):
        """Leaves serial logs, the journal, the status file and a picture in `folder`; what fails is left out."""
        folder = pathlib.Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        for path in list(self.work.glob("serial-*.log")) + list(self.work.glob("emulator-*.log")):
            (folder / path.name).write_bytes(path.read_bytes())
        if self.process is None or self.process.poll() is not None:
            return
        for name, command in (("journal.txt", "journalctl --no-pager -o short-monotonic -n 3000"),
                              ("kernel.txt", "dmesg"), ("units.txt", "systemctl --no-pager --failed; systemctl list-jobs"),
                              ("status.json", "cat /run/lackwerk/status.json"),
                              ("import.json", "cat /run/lackwerk/import.json"),
                              ("input-devices.txt", "cat /proc/bus/input/devices; ls -l /dev/hidraw* /dev/dri")):
            try:
                (folder / name).write_bytes(self.run(command, 30.0).raw)
            except Failure as problem:
                (folder / name).write_text(f"{problem}\n")
        try:
            self.screen(folder / "screen.png")
        except Failure:
            pass
