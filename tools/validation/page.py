"""docs/validation.md and its pictures."""

import subprocess
import tempfile
from pathlib import Path

from PIL import Image
from runs import ROOT

#: What stands above the table.
HEAD = (Path(__file__).parent / "head.md").read_text()


def number(value, unit="", digits=6):
    return f"{value:.{digits}g} {unit}".strip()


def difference(line, value):
    share = abs(line.difference(value))
    if line.absolute:
        return number(share, line.unit, 2)
    return f"{100 * share:.2g} %"


def allowed(line):
    return number(line.allowed, line.unit, 3) if line.absolute else f"{100 * line.allowed:.3g} %"


def within(line, value):
    """Whether a line is within its bound; a number that is none is not."""
    return abs(line.difference(value)) <= line.allowed


def rows(outcomes):
    yield "| case | quantity | reference | kind | ours | difference | allowed | within | seconds |"
    yield "|---|---|---|---|---|---|---|---|---|"
    for case, finished in outcomes:
        for line, value in finished.numbers(case):
            seconds = sum(finished.seconds[label] for label in line.runs)
            met = "yes" if within(line, value) else "**no**"
            cells = [
                f"[{case.title}](#{anchor(case.title)})",
                line.quantity,
                number(line.reference, line.unit),
                line.kind,
                number(value, line.unit),
                difference(line, value),
                allowed(line),
                met,
                f"{seconds:.1f}",
            ]
            yield f"| {' | '.join(cells)} |"


def anchor(title):
    kept = "".join(c for c in title.lower() if c.isalnum() or c in " -_")
    return kept.replace(" ", "-")


def write(outcomes):
    """The page from the finished cases."""
    numbers = [(case, line, value) for case, finished in outcomes for line, value in finished.numbers(case)]
    missed = [entry for entry in numbers if not within(*entry[1:])]
    seconds = sum(sum(finished.seconds.values()) for _, finished in outcomes)
    text = [HEAD, "## All lines\n"]
    text.append(f"{len(numbers) - len(missed)} of {len(numbers)} lines are within their bounds.")
    text.append(f"All runs together take {seconds:.0f} s of one core.\n")
    text += [*rows(outcomes), *reasons_of(missed)]
    for case, _ in outcomes:
        text += section(case)
    (ROOT / "docs/validation.md").write_text("\n".join(text) + "\n")


def reasons_of(missed):
    """What is not within its bound, a line for each reason."""
    if missed:
        yield "\n## What is not within its bound\n"
    for key in dict.fromkeys((case.title, line.open) for case, line, _ in missed):
        own = [(line, value) for case, line, value in missed if (case.title, line.open) == key]
        found = "; ".join(f"{line.quantity}: {number(value, line.unit, 3)}" for line, value in own)
        yield f"- {key[0]}: {found}. {key[1]}"


def section(case):
    """What a case shows, its picture, and the reasons for its bounds."""
    yield f"\n## {case.title}\n\n{case.text}\n\nScene: [`meshes/{case.scene}`](../meshes/{case.scene}).\n"
    yield f"![{case.title}](validation/{case.name}.png)\n\n*{case.picture.caption}*\n\nWhat is allowed, and why:\n"
    for bound, reason in dict.fromkeys((allowed(line), line.reason) for line in case.lines):
        own = [line.quantity for line in case.lines if (allowed(line), line.reason) == (bound, reason)]
        yield f"- {bound} ({'; '.join(own)}): {reason}."


def picture(program, case, finished):
    """The map of a case, by `dgmpm plot`, made smaller: docs/validation/<name>.png."""
    wanted = case.picture
    with tempfile.TemporaryDirectory() as folder:
        command = [
            program,
            "plot",
            finished.runs[wanted.run].folder,
            "--field",
            wanted.field,
            "--out",
            folder,
            "--quiet",
        ]
        command += ["--time", str(wanted.time)] if wanted.time is not None else []
        command += [f"--range={-wanted.limit},{wanted.limit}"] if wanted.limit else []
        subprocess.run(command, check=True)
        [drawn] = Path(folder).glob("*.png")  # the step is in its name where a run has several snapshots
        image = Image.open(drawn).convert("RGB")
        image.thumbnail((720, 720), Image.Resampling.LANCZOS)
        place = ROOT / "docs/validation" / f"{case.name}.png"
        place.parent.mkdir(exist_ok=True)
        # The octree keeps the colours of the whole bar, where other palettes take those of the largest areas.
        image.quantize(256, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE).save(place, optimize=True)
