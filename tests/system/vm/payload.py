"""The second disk: the software under test, laid out as its package lays it out.

Why it exists: the root image is cached for weeks, the software changes with every build. mkfs.ext4 writes the tree into
a file without a mount, and the guest's first program copies it over the root (guest/install).
"""
import hashlib
import pathlib
import shutil
import subprocess

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[2]
HELPERS = ("agent", "dial", "touch")
# Where Debian's packages put what lies in systemd/.
UNIT_FOLDER, RULE_FOLDER = "usr/lib/systemd/system", "usr/lib/udev/rules.d"


def build_helpers(folder):
    """Static programs, so that the guest needs no compiler and no run-time libraries for them."""
    folder.mkdir(parents=True, exist_ok=True)
    newest_header = max(p.stat().st_mtime for p in (HERE / "guest").glob("*.hpp"))
    for name in HELPERS:
        source, program = HERE / "guest" / f"{name}.cpp", folder / name
        if program.exists() and program.stat().st_mtime > max(source.stat().st_mtime, newest_header):
            continue
        subprocess.run(["c++", "-std=c++20", "-O1", "-static", "-s", "-Wall", "-Wextra", "-Werror", source, "-o", program],
                       check=True)
    return folder


def destination(path):
    """Place of a file of systemd/ in the root; None for what is not installed."""
    if path.suffix in (".service", ".socket", ".target", ".path", ".timer"):
        return f"{UNIT_FOLDER}/{path.name}"
    if path.suffix == ".rules":
        return f"{RULE_FOLDER}/{path.name}"
    if path.suffix == ".conf" and "sysusers" in str(path.relative_to(SOURCE)):
        return "usr/lib/sysusers.d/lackwerk.conf"
    if path.suffix == ".conf" and "tmpfiles" in str(path.relative_to(SOURCE)):
        return "usr/lib/tmpfiles.d/lackwerk.conf"
    return None


def make(out, build, helpers, files):
    """Writes the disk `out`. `files`: more {place in the root: host path}. Returns the units of systemd/ it enables."""
    tree = out.with_suffix(".tree")
    shutil.rmtree(tree, ignore_errors=True)
    (tree / "tree").mkdir(parents=True)

    def place(source, where, mode=0o644):
        target = tree / "tree" / where
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, target)
        target.chmod(mode)

    units = ["vm-agent.service"]
    place(HERE / "guest" / "vm-agent.service", f"{UNIT_FOLDER}/vm-agent.service")
    for name in HELPERS:
        place(helpers / name, f"opt/vm/{name}", 0o755)
    place(HERE / "guest" / "dial_gadget", "opt/vm/dial_gadget", 0o755)
    for path in sorted((SOURCE / "systemd").rglob("*")):
        where = destination(path) if path.is_file() else None
        if where is None:
            continue
        place(path, where)
        if where.startswith(UNIT_FOLDER) and "[Install]" in path.read_text():
            units.append(path.name)
    kiosk = build / "lackwerk-kiosk"
    if kiosk.exists():
        place(kiosk, "usr/bin/lackwerk-kiosk", 0o755)
        subprocess.run(["strip", tree / "tree/usr/bin/lackwerk-kiosk"], check=True)
    for where, source in files.items():
        place(source, where)
    shutil.copyfile(HERE / "guest" / "install", tree / "install")
    (tree / "units").write_text("\n".join(units) + "\n")
    digest = hashlib.sha256()
    for path in sorted(p for p in tree.rglob("*") if p.is_file()):
        digest.update(str(path.relative_to(tree)).encode() + b"\0" + path.read_bytes())
    (tree / "id").write_text(digest.hexdigest() + "\n")
    size_mb = sum(p.stat().st_size for p in tree.rglob("*") if p.is_file()) // (1 << 20) + 24
    out.unlink(missing_ok=True)
    subprocess.run(["truncate", "-s", f"{size_mb}M", out], check=True)
    subprocess.run(["mkfs.ext4", "-q", "-F", "-L", "payload", "-m", "0", "-O", "^has_journal", "-d", tree, out], check=True,
                   env={"PATH": "/usr/sbin:/sbin:/usr/bin:/bin"})
    shutil.rmtree(tree)
    return units[1:]
