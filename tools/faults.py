#!/usr/bin/env python3
"""The fault campaign: a small run with checkpoints, outputs, regrids and plasticity is killed, runs out of disk, and finds corrupted
files. Each time its results are compared byte by byte with those of a run that nothing has disturbed. The figures go to standard
output and into docs/reliability.md; the exit code is 1 where a result was lost or wrong.

usage: DGMPM=path/to/dgmpm tools/faults.py [--kills 100] [--corruptions 200] [--seed 1]
"""
import argparse
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from results import differences, results

PROGRAM = str(Path(os.environ["DGMPM"]).resolve())
BEGIN, END = "<!-- begin of make faults -->", "<!-- end of make faults -->"

ROOT = Path(__file__).resolve().parent.parent
# The scene of tests/checkpoint, with a checkpoint at each step.
SCENE = (ROOT / "tests" / "checkpoint" / "case.toml").read_text().replace("every_steps = 3\n[time]", "every_steps = 1\n[time]")
assert "every_steps = 1\n[time]" in SCENE
PAGE = ROOT / "docs" / "reliability.md"


def call(folder, *arguments):
    """Runs the program in a folder: exit code and messages."""
    done = subprocess.run([PROGRAM, *arguments], cwd=folder, capture_output=True, text=True, timeout=600)
    return done.returncode, done.stderr


def kills(work, whole, seconds, count, dice):
    """SIGKILL at random moments; each time the run goes on."""
    lost, wrong, done, runs, fresh = 0, 0, 0, 0, 0
    moments = []
    folder = work / "killed"
    while done < count or folder.exists():
        has_checkpoint = any((folder / "checkpoints").glob("*.h5")) if folder.exists() else False
        command = ["resume", "killed"] if has_checkpoint else ["run", "case.toml", "--out", "killed", "--force"]
        fresh += not has_checkpoint
        child = subprocess.Popen(
            [PROGRAM, *command], cwd=work, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
        )
        if done < count:
            pause = dice.uniform(0, 0.5 * seconds)
            time.sleep(pause)
            if child.poll() is None:
                child.send_signal(signal.SIGKILL)
                child.communicate()
                done += 1
                moments.append(pause)
                continue
        errors = child.communicate()[1]
        # Killed behind its end, it is done.
        if child.returncode == 2 and "at its end" in errors:
            child.returncode = 0
        runs += 1
        if child.returncode != 0:
            lost += 1
            print("lost:", errors, file=sys.stderr)
        elif differences(whole, results(folder)):
            wrong += 1
            print("wrong:", differences(whole, results(folder)), file=sys.stderr)
        shutil.rmtree(folder)
    return {"kills": done, "runs": runs, "from the start": fresh, "lost": lost, "wrong": wrong}


class Disk:
    """A tmpfs of a size in KiB that can be changed; None where it cannot be mounted."""

    def __init__(self, place):
        self.place = place
        place.mkdir()
        command = ["mount", "-t", "tmpfs", "-o", "size=4k", "none", str(place)]
        self.is_there = subprocess.run(command, capture_output=True).returncode == 0

    def resize(self, kib):
        subprocess.run(["mount", "-o", f"remount,size={kib}k", str(self.place)], check=True)

    def fill(self):
        """Takes all space that is left."""
        try:
            with open(self.place / "filler", "ab", buffering=0) as filler:
                while True:
                    filler.write(bytes(4096))
        except OSError:
            pass

    def clear(self):
        for path in self.place.iterdir():
            shutil.rmtree(path) if path.is_dir() else path.unlink()

    def remove(self):
        # Lazily where something still looks into it, such as an indexer of the system.
        if subprocess.run(["umount", str(self.place)], stderr=subprocess.DEVNULL).returncode != 0:
            subprocess.run(["umount", "-l", str(self.place)], check=True)


def stayed(before, folder):
    """Names of files that are not as they were: tables may have more whole rows."""
    out = []
    for name, data in before.items():
        path = folder / name
        now = path.read_bytes() if path.exists() else b""
        # The run keeps its last two checkpoints.
        if name.startswith("checkpoints/") or name in (".dgmpm", "summary.json"):
            continue
        whole = now.startswith(data) and now.endswith(b"\n") if name.endswith(".csv") else now == data
        if not whole:
            out.append(name)
    return out


def files_of(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


# What fails on a full disk before a run steps, or after it; `{}` is the disk.
COMMANDS = {
    "mesh": "mesh rectangle --size 1,0.5 --cells 40,20 --out {}/m.h5",
    "mesh for Gmsh": "mesh rectangle --size 1,0.5 --cells 40,20 --out {}/m.msh",
    "cloud": "seed case.toml --out {}/c.h5",
    "operators": "preprocess case.toml --out {}/o.h5",
    "input of a run": "run case.toml --out {}/new",
    "VTU": "export {}/r --format vtu",
    "XDMF": "export {}/r --format xdmf",
    "plot": "stability --body 4,1 --degree 1 --over poisson=.3,.4 --plot {}/p.svg",
    "study": "study case.toml --set regrid=[] --methods rk-dgfem --degrees 1 --refine 1 --repeat 1 --out {}/study",
}
# Runs that fail in their midst, by the one file that they write again and again.
OUTPUTS = {
    "snapshots": '[{kind="fields",every_steps=1}]',
    "ledger": '[{kind="ledger"}]',
    "lines": '[{kind="line",name="l",from=[0.0,0.0],to=[1.0,0.0],samples=50,every_steps=1}]',
    "tracks": '[{kind="force",name="f"}]',
    "checkpoints": '[]',
}


def without_numbers(name):
    """The name of a file without the number of a step or a grid: `snapshots/000120.h5` is `snapshots/.h5`."""
    return re.sub(r"_?\d+(?=\.)", "", name)


def full_at_each_kind(work, disk):
    """A disk without any space at each kind of write: one message, exit code 5, and what was there stays. Rows of a table."""
    rows = []
    for kind, command in COMMANDS.items():
        disk.resize(65536)
        shutil.copytree(work / "whole", disk.place / "r")
        before = files_of(disk.place / "r")
        disk.fill()
        code, errors = call(work, *command.format("disk").split())
        rows.append((kind, code, errors, stayed(before, disk.place / "r")))
        disk.clear()
    for kind, outputs in OUTPUTS.items():
        disk.resize(65536)
        every = 1 if kind == "checkpoints" else 10**9
        sets = ["time.end=1e3", "regrid=[]", "quantity=[]", f"output={outputs}", f"checkpoint.every_steps={every}"]
        command = [PROGRAM, "run", "case.toml", "--out", "disk/r", *(word for key in sets for word in ("--set", key))]
        child = subprocess.Popen(command, cwd=work, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        folder = disk.place / "r"
        written = folder / kind if kind != "ledger" else folder / "ledger.csv"
        start = time.time()
        while time.time() - start < 60 and not (
            len(list(written.iterdir())) > 1 or kind in ("lines", "tracks") and any(p.stat().st_size > 4096 for p in written.iterdir())
            if written.is_dir()
            else written.exists() and written.stat().st_size > 4096
        ):
            time.sleep(0.005)
        # Whole files of a moment: those that the run had finished.
        before = {name: data for name, data in files_of(folder).items() if not name.endswith((".part", ".csv"))}
        disk.fill()
        try:
            errors = child.communicate(timeout=120)[1]
        except subprocess.TimeoutExpired:
            child.kill()
            errors = child.communicate()[1] + "it did not stop"
        left = stayed(before, folder)
        left += [str(path.name) for path in folder.rglob("*.csv") if torn(path)]
        rows.append((kind, child.returncode, errors, left))
        disk.clear()
    out, bad = [], 0
    for kind, code, errors, left in rows:
        good = code == 5 and errors.count("error: ") == 1 and "cannot write" in errors and not left
        bad += not good
        if not good:
            print(f"full disk, {kind}: exit code {code}, {left}, {errors}", file=sys.stderr)
        name = errors.split("cannot write ")[-1].split(": ")[0] if "cannot write" in errors else "-"
        out.append([kind, f"`{without_numbers(name.removeprefix('disk/'))}`", code, "yes" if not left else "no"])
    return out, bad


def torn(path):
    """Whether a table has a row that is not whole."""
    text = path.read_text()
    columns = {line.count(",") for line in text.splitlines()}
    return not text.endswith("\n") or len(columns) > 1


def full_disks(work, whole, sizes, tmpfs):
    """Disks of some sizes that run full; then there is space again, and the run goes on."""
    disk = tmpfs.place
    out = {"disks": 0, "ran full": 0, "resumed": 0, "from the start": 0, "lost": 0, "wrong": 0, "files": set()}
    for size in sizes:
        tmpfs.resize(size)
        out["disks"] += 1
        code, errors = call(work, "run", "case.toml", "--out", "disk/r", "--force")
        if code != 0:
            messages = errors.count("error: ")
            good = code == 5 and messages == 1 and "cannot write" in errors
            out["ran full"] += 1
            if not good:
                out["lost"] += 1
                print(f"{size} KiB: exit code {code}, {errors}", file=sys.stderr)
            place = errors.split("cannot write ")[-1].split(": ")[0]
            out["files"].add("/".join(Path(place).parts[2:3]) or place)
            tmpfs.resize(65536)
            again = any((disk / "r" / "checkpoints").glob("*.h5"))
            out["resumed" if again else "from the start"] += 1
            command = ["resume", "disk/r"] if again else ["run", "case.toml", "--out", "disk/r", "--force"]
            code, errors = call(work, *command)
        if code != 0:
            out["lost"] += 1
            print(f"{size} KiB, again: exit code {code}, {errors}", file=sys.stderr)
        elif differences(whole, results(disk / "r")):
            out["wrong"] += 1
            print(f"{size} KiB: {differences(whole, results(disk / 'r'))}", file=sys.stderr)
        shutil.rmtree(disk / "r", ignore_errors=True)
    out["files"] = ", ".join(sorted(out["files"]))
    return out


def corruptions(work, whole, count, dice):
    """A flipped bit in a file of a stopped run, which is then resumed and exported."""
    stopped = work / "stopped"
    shutil.copytree(work / "whole", stopped)
    code, errors = call(work, "export", "stopped")
    assert code == 0, errors
    whole = results(stopped)
    sorted((stopped / "checkpoints").glob("*.h5"))[-1].unlink()
    kinds = {}
    for path in stopped.rglob("*"):
        name = str(path.relative_to(stopped))
        if path.is_file() and path.stat().st_size > 0:
            kind = name.split("/")[0] if "/" in name else without_numbers(name)
            kinds.setdefault(kind, []).append(name)
    reference = dict(whole)
    out = {kind: {"flips": 0, "found": 0, "harmless": 0, "wrong": 0, "by verify": 0} for kind in sorted(kinds)}
    for number in range(count):
        kind = sorted(kinds)[number % len(kinds)]
        name = dice.choice(kinds[kind])
        folder = work / "flipped"
        shutil.copytree(stopped, folder)
        data = bytearray((folder / name).read_bytes())
        data[dice.randrange(len(data))] ^= 1 << dice.randrange(8)
        (folder / name).write_bytes(data)
        row = out[kind]
        row["flips"] += 1
        verified = call(work, "verify", "flipped", "--steps", "0")[0] == 6
        row["by verify"] += verified
        code, errors = call(work, "resume", "flipped")
        after = results(folder)
        kept = {file: data for file, data in after.items() if file != name}
        same = all(kept[file] == reference.get(file) for file in kept) and len(after) == len(reference)
        # The file itself, if the run has not written it again, is looked at by the commands that read it.
        healed = after.get(name) == reference.get(name)
        if code != 0 or "warning: " in errors:
            # A damaged checkpoint gives way to the one before, with a warning and the same results.
            good = code == 2 or (code == 0 and same and healed)
            row["found" if good else "wrong"] += 1
            if not good:
                print(f"{name}: exit code {code}, {errors}", file=sys.stderr)
        elif same and healed:
            row["harmless"] += 1
        elif same and verified:
            # A file that a resumed run neither reads nor writes, such as an export.
            row["found"] += 1
        elif same and name.endswith(".vtu"):
            # A bit of the comment around its seal, or `verify` would have found it.
            row["harmless"] += 1
        elif same and name.endswith(".h5"):
            code, errors = call(work, "export", "flipped", "--format", "vtu")
            row["found" if code == 2 and "damaged" in errors else "wrong"] += 1
        elif same and name == "scene.toml":
            # A comment, a title, or what says the same: the results are the same.
            row["harmless"] += 1
        else:
            row["wrong"] += 1
            print(f"{name}: exit code {code}, differs: {differences(reference, after)}", file=sys.stderr)
        shutil.rmtree(folder)
    return out


def table(head, rows):
    """A table in Markdown."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--kills", type=int, default=100)
    options.add_argument("--corruptions", type=int, default=200)
    options.add_argument("--seed", type=int, default=1)
    options = options.parse_args()
    dice = random.Random(options.seed)
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        (work / "case.toml").write_text(SCENE)
        start = time.time()
        code, errors = call(work, "run", "case.toml", "--out", "whole")
        assert code == 0, errors
        seconds = time.time() - start
        whole = results(work / "whole")
        text = []
        found = kills(work, whole, seconds, options.kills, dice)
        bad = found["lost"] + found["wrong"]
        text.append("SIGKILL at random moments, then `dgmpm resume`:\n\n" + table(found.keys(), [found.values()]))
        size = sum(path.stat().st_size for path in (work / "whole").rglob("*") if path.is_file()) // 1024
        disk = Disk(work / "disk")
        if disk.is_there:
            try:
                disks = full_disks(work, whole, [max(8, size * k // 16) for k in range(1, 17)], disk)
                kinds, faults = full_at_each_kind(work, disk)
            finally:
                disk.remove()
            bad += disks["lost"] + disks["wrong"] + faults
            text.append("A disk (tmpfs) that runs full, and then has space:\n\n" + table(disks.keys(), [disks.values()]))
            head = ["without space for", "message about", "exit code", "what was there stays"]
            text.append("A disk without any space, at each kind of write:\n\n" + table(head, kinds))
        else:
            print("full disks: skipped, mounting a tmpfs needs the rights of root")
        flips = corruptions(work, whole, options.corruptions, dice)
        bad += sum(row["wrong"] for row in flips.values())
        rows = [[f"`{kind}`", *row.values()] for kind, row in flips.items()]
        rows.append(["all", *(sum(row[key] for row in flips.values()) for key in next(iter(flips.values())))])
        text.append(
            "A flipped bit in a file of a stopped run, then `dgmpm verify`, `dgmpm resume` and `dgmpm export`:\n\n"
            + table(["file or folder", *next(iter(flips.values()))], rows)
        )
    text = "\n\n".join(text)
    print(text)
    page = PAGE.read_text()
    before, after = page.split(BEGIN)[0], page.split(END)[1]
    PAGE.write_text(f"{before}{BEGIN}\n\n{text}\n\n{END}{after}")
    print(f"{bad} results lost or wrong")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
