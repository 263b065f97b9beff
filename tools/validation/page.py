"""docs/validation.md and its pictures."""

import subprocess
import tempfile
from pathlib import Path

from PIL import Image
from runs import ROOT

HEAD = """# Validation

This page is written by `make validation`. It runs each case of `tools/validation/` with the scenes of `meshes/validation/`, and compares numbers
with values from elsewhere. `make test` runs a part of the cases and fails where a line leaves its bound.

The kind of a reference says what it is worth:

- *exact*: a formula for this very problem;
- *computed independently*: another method with converged cells, of which nothing comes from this program;
- *conservation law*: what the equations keep;
- *finer cells*: the result of the same program on finer cells, which shows convergence and no more;
- *reported*: numbers of the literature, quoted from memory and not checked against the papers; the bound is their spread.

"Allowed" is the largest difference that is in order: a share of the reference where it is in percent, otherwise a difference in the unit of the
line. The section of the case says why it is that much. Where a line is not within its bound the page says why; the bound stays. Seconds are CPU seconds of one
thread, of all runs that a line needs. Scenes have default settings but for what they name.
"""


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
    missed = [(case, line, value) for case, line, value in numbers if not within(line, value)]
    seconds = sum(sum(finished.seconds.values()) for _, finished in outcomes)
    text = [HEAD, "## All lines\n"]
    text.append(f"{len(numbers) - len(missed)} of {len(numbers)} lines are within their bounds. All runs together take {seconds:.0f} s of one core.\n")
    text += rows(outcomes)
    if missed:
        text.append("\n## What is not within its bound\n")
        for case, why in dict.fromkeys((case.title, line.open) for case, line, _ in missed):
            found = "; ".join(f"{line.quantity}: {number(value, line.unit, 3)}" for of, line, value in missed if (of.title, line.open) == (case, why))
            text.append(f"- {case}: {found}. {why}")
    for case, finished in outcomes:
        text.append(f"\n## {case.title}\n\n{case.text}\n\nScene: [`meshes/{case.scene}`](../meshes/{case.scene}).\n")
        text.append(f"![{case.title}](validation/{case.name}.png)\n\n*{case.picture.caption}*\n\nWhat is allowed, and why:\n")
        reasons = dict.fromkeys((allowed(line), line.reason) for line in case.lines)
        text += [f"- {bound} ({together(case, bound, reason)}): {reason}." for bound, reason in reasons]
    (ROOT / "docs/validation.md").write_text("\n".join(text) + "\n")


def together(case, bound, reason):
    return "; ".join(line.quantity for line in case.lines if (allowed(line), line.reason) == (bound, reason))


def picture(program, case, finished):
    """The map of a case, by `dgmpm plot`, made smaller: docs/validation/<name>.png."""
    wanted = case.picture
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "plot", finished.runs[wanted.run].folder, "--field", wanted.field, "--out", folder, "--quiet"]
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
