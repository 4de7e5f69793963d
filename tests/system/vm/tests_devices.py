"""The room itself: does the machine have the screen, the fingers and the knobs that the kiosk's tests rely on?"""
import re
import time

from testing import Skip, expect, test

DIAL = "/run/dial.fifo"
TOUCH = "/run/touch.fifo"


def plug_touch(machine, name="Test touch screen"):
    machine.background("vm-touch", f"/opt/vm/touch {TOUCH} '{name}'")
    machine.until("the touch screen is there", 30, lambda: machine.run(f"test -p {TOUCH}").code == 0)


def plug_uhid(machine, profile):
    machine.background("vm-dial", f"/opt/vm/dial uhid {profile} {DIAL}")
    machine.until("the dial is there", 30, lambda: machine.run(f"test -p {DIAL}").code == 0)


def plug_gadget(machine, profile):
    node = machine.read(f"/opt/vm/dial_gadget make {profile}")
    machine.until("the gadget is on the bus", 30, lambda: hidraw_of(machine, profile))
    machine.background("vm-gadget-dial", f"/opt/vm/dial hidg {profile} {DIAL}.usb {node}")
    machine.until("the gadget listens", 30, lambda: machine.run(f"test -p {DIAL}.usb").code == 0)


def tell(machine, fifo, command):
    machine.run(f"echo '{command}' > {fifo}", check=True)


def hidraw_of(machine, profile):
    """Device nodes of the simulated dial, as the kernel names them."""
    name = machine.read(f"/opt/vm/dial ids {profile} | cut -d' ' -f4-")
    return machine.read("for d in /sys/class/hidraw/*/device; do [ -e $d/uevent ] || continue; "
                        f"grep -q 'HID_NAME=.*{name}' $d/uevent && basename $(dirname $d); done; true").split()


def descriptors(machine, pid):
    return int(machine.read(f"ls /proc/{pid}/fd | wc -l"))


@test
def service_manager(room):
    m = room.machine
    m.until("systemd has started everything", 180,
            lambda: m.run("systemctl is-active multi-user.target").out.strip() == "active")
    room.note(f"switched on to multi-user.target: {m.up_s():.1f} s; " + m.read("systemd-analyze time | head -n 1"))
    m.until("the graphics card is there", 60, lambda: m.run("test -c /dev/dri/card0").code == 0)
    expect(m.read("cat /sys/class/drm/card0-Virtual-1/status") == "connected", "the monitor is not connected")


@test
def screen_dump(room):
    m = room.machine
    m.until("the frame buffer is there", 60, lambda: m.run("test -c /dev/fb0").code == 0)
    # It stays stopped until its own tests: what the tests of the room touch and turn must not reach it.
    if "lackwerk-kiosk.service" in room.units:
        m.run("systemctl stop lackwerk-kiosk", 60)
    width, height = map(int, m.read("cat /sys/class/graphics/fb0/virtual_size").split(","))
    expect((width, height) == m.size, f"the frame buffer is {width}x{height}, the monitor {m.size}")
    # Left half red, right half blue (32 bits, blue first).
    row = b"\x00\x00\xff\x00" * (width // 2) + b"\xff\x00\x00\x00" * (width - width // 2)
    m.run("echo 0 > /sys/class/graphics/fbcon/cursor_blink; cat > /dev/fb0", data=row * height, check=True)
    picture = m.until("the pattern is on the screen", 10, lambda: _half_red(m.screen()))
    picture.save_png(room.artefacts / "pattern.png")


def _half_red(picture):
    middle = picture.height // 2 * picture.width * 3
    left = picture.rgb[middle + 30:middle + 33]
    right = picture.rgb[middle + (picture.width - 10) * 3:middle + (picture.width - 9) * 3]
    return picture if (left, right) == (b"\xff\x00\x00", b"\x00\x00\xff") else None


@test
def uhid_dial_appears(room):
    m = room.machine
    for profile, evdev in (("plain", True), ("surface", None)):
        plug_uhid(m, profile)
        nodes = m.until(f"hidraw of {profile}", 30, lambda: hidraw_of(m, profile))
        tell(m, DIAL, "turns 40 3 100")
        report = m.run(f"timeout 10 head -c 2 /dev/{nodes[0]} | od -An -tx1", 30).out.split()
        expect(len(report) == 2, f"no report came through {nodes[0]}")
        devices = m.read("cat /proc/bus/input/devices")
        name = m.read(f"/opt/vm/dial ids {profile} | cut -d' ' -f4-")
        has_evdev = name in devices
        expect(evdev is None or has_evdev == evdev, f"evdev device of {profile}: {has_evdev}")
        room.note(f"{profile}: {nodes[0]}, first bytes {' '.join(report)}, evdev {'yes' if has_evdev else 'no'}")
        m.run("systemctl stop vm-dial", check=True)
        m.until("the node is gone", 30, lambda: not hidraw_of(m, profile))


@test
def gadget_dial_appears(room):
    m = room.machine
    if m.run("modprobe -n dummy_hcd usb_f_hid libcomposite").code != 0:
        raise Skip("this kernel has no dummy_hcd or usb_f_hid")
    plug_gadget(m, "plain")
    usb = m.read("for d in /sys/bus/usb/devices/*; do [ -e $d/product ] && "
                 "echo ${d##*/} $(cat $d/idVendor):$(cat $d/idProduct) $(cat $d/product); done")
    expect("1209:0001" in usb, f"not on the USB bus: {usb}")
    node = hidraw_of(m, "plain")[0]
    m.run(f"cat /dev/{node} > /run/reports & echo $! > /run/reader", check=True)
    m.until("the reader has it open", 20, lambda: "hidraw" in m.run("ls -l /proc/$(cat /run/reader)/fd").out)
    time.sleep(0.5)  # usbhid drops what comes in the first 50 ms after an open
    tell(m, DIAL + ".usb", "turns 5 7 20")
    m.until("five reports came over USB", 20, lambda: m.read("stat -c %s /run/reports") == "10")
    m.run("kill $(cat /run/reader)")
    expect(m.read("od -An -tx1 /run/reports | head -n 1").split()[:2] == ["00", "07"], "the reports say something else")
    m.run("/opt/vm/dial_gadget release", check=True)
    m.until("usbhid has let go", 20, lambda: not hidraw_of(m, "plain"))
    m.run("/opt/vm/dial_gadget claim", check=True)
    m.until("usbhid has it again", 20, lambda: hidraw_of(m, "plain"))
    m.run("/opt/vm/dial_gadget unplug", check=True)
    m.until("the gadget is unplugged", 20, lambda: not hidraw_of(m, "plain"))
    m.run("systemctl stop vm-gadget-dial; /opt/vm/dial_gadget remove", check=True)
    room.note("USB: " + "; ".join(line for line in usb.splitlines() if "1209" in line))


@test
def touch_appears(room):
    m = room.machine
    plug_touch(m)
    m.until("udev knows it as a touch screen", 30, lambda: _touch_event(m))
    event = _touch_event(m)
    m.run(f"cat {event} > /run/touched & echo $! > /run/reader", check=True)
    tell(m, TOUCH, "pinch 0.5 0.5 0.1 0.3 4 20")
    # Each event is 24 bytes; two fingers down, four steps, two fingers up are more than 30.
    m.until("a pinch is seen", 20, lambda: int(m.read("stat -c %s /run/touched")) > 30 * 24)
    m.run("kill $(cat /run/reader); systemctl stop vm-touch", check=True)


def _touch_event(m):
    for block in m.read("cat /proc/bus/input/devices").split("\n\n"):
        found = re.search(r"Handlers=.*\b(event\d+)", block)
        if "Test touch screen" in block and found:
            node = f"/dev/input/{found.group(1)}"
            return node if "ID_INPUT_TOUCHSCREEN=1" in m.run(f"udevadm info {node}").out else None
    return None


@test
def usb_hot_plug(room):
    m = room.machine
    before = m.read("cat /proc/bus/input/devices").count("QEMU USB Tablet")
    m.usb_plug("second")
    m.until("a second tablet is there", 30,
            lambda: m.read("cat /proc/bus/input/devices").count("QEMU USB Tablet") == before + 1)
    m.usb_unplug("second")
    m.until("it is gone again", 30, lambda: m.read("cat /proc/bus/input/devices").count("QEMU USB Tablet") == before)


def connector(machine):
    """State of the connector and its preferred mode."""
    return machine.read("cd /sys/class/drm/card0-Virtual-1; echo $(cat status) $(head -n 1 modes)")


@test
def monitor_off_and_on(room):
    m = room.machine
    width, height = m.size
    m.run("udevadm monitor --udev --property --subsystem-match=drm > /run/drm-events & echo $! > /run/reader; sleep 1",
          check=True)
    for size, state in (((0, 0), "disconnected"), ((800, 600), "connected 800x600"),
                        (m.size, f"connected {width}x{height}")):
        events = int(m.read("grep -c HOTPLUG=1 /run/drm-events || true"))
        m.monitor(*size)
        m.until("the hot-plug event arrives", 30, lambda: int(m.read("grep -c HOTPLUG=1 /run/drm-events || true")) > events)
        # The kernel looks at the cable when somebody asks.
        m.run("echo detect > /sys/class/drm/card0-Virtual-1/status", check=True)
        expect(connector(m) == state, f"the connector says '{connector(m)}', not '{state}'")
    m.run("kill $(cat /run/reader)")
