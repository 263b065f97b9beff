"""Puts the tables of a part of `make study` into docs/cost.md, and its plots into docs/img."""

import json
import shutil
import sys
from datetime import date
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PARTS = {
    "smooth": ["simple_wave", "smooth_box", "wall_impact"],
    "hard": ["hard_impact", "hard_taylor", "hard_taylor_limited", "hard_plate"],
}
# What tells problems of one title apart.
NAMES = {
    "hard_taylor": ", without limiter",
    "hard_taylor_limited": ", with limiter",
}


def replace(path: Path, part: str, text: str) -> None:
    """What stands between the markers of a part of a document."""
    begin, end = f"<!-- {part}:begin -->", f"<!-- {part}:end -->"
    whole = path.read_text()
    before, rest = whole.split(begin)
    _, after = rest.split(end)
    path.write_text(f"{before}{begin}\n{text}\n{end}{after}")


def answers(study: dict) -> str:
    """The answers in words, as a list."""
    lines = []
    for answer in study["answers"]:
        use, error = answer["use"], answer["for_error"]
        asked = f"{100 * error:.3g} %" if error > 9e-6 else f"{error:.0e}"
        found = f"{use['cpu_seconds']:.2g} s (error {use['error']:.1e})"
        lines.append(f"- for an error of {asked}: {use['setting']} on {use['cells']} cells, {found}")
    return "\n".join(lines)


def failures(folder: Path) -> str:
    """The runs that did not get to their end, with the reason, as a list."""
    rows = [row for row in (folder / "study.csv").read_text().splitlines() if not row.startswith("#")]
    columns = rows[0].split(",")
    lines = []
    for row in rows[1:]:
        cells, status = row.split(',"')[0].split(","), row.split(',"')[1].rstrip('"')
        of = dict(zip(columns, cells, strict=False))
        if status != "done":
            lines.append(f"- {of['method']} S{of['degree']}, refinement {of['refinement']}: {status}")
    return "\n".join(lines)


def section(folder: Path, name: str, images: str) -> str:
    """Table, answers, quantities and plot of one problem."""
    study = json.loads((folder / name / "study.json").read_text())
    parts = [f"### {study['title']}{NAMES.get(name, '')}", "; ".join(study["head"][1:]) + "."]
    if study["answers"]:
        parts += [(folder / name / "table.md").read_text().strip(), answers(study)]
    quantities = folder / name / "quantities.md"
    if quantities.exists():
        parts.append(quantities.read_text().strip())
    failed = failures(folder / name)
    if failed:
        parts.append(f"Runs that did not get to their end:\n\n{failed}")
    if (folder / name / "error_over_seconds.svg").exists():
        parts.append(f"![error over CPU seconds]({images}/study_{name}.svg)")
    return "\n\n".join(parts)


def main(folder: Path, part: str) -> None:
    images = ROOT / "docs/img"
    for name in PARTS[part]:
        for axis, ending in [("seconds", ""), ("dofs", "_dofs")]:
            plot = folder / name / f"error_over_{axis}.svg"
            if plot.exists():
                shutil.copy(plot, images / f"study_{name}{ending}.svg")
    made = f"Made by `make study`, {date.today().isoformat()}."
    whole = "\n\n".join(section(folder, name, "img") for name in PARTS[part])
    replace(ROOT / "docs/cost.md", part, f"{made}\n\n{whole}")


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
