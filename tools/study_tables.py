"""Puts the tables of `make study` into docs/cost.md, and its plots into docs/img."""

import json
import shutil
import sys
from datetime import date
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROBLEMS = ["simple_wave", "smooth_box", "wall_impact"]
BEGIN, END = "<!-- study:begin -->", "<!-- study:end -->"


def replace(path: Path, text: str) -> None:
    """What stands between the markers of a document."""
    whole = path.read_text()
    before, rest = whole.split(BEGIN)
    _, after = rest.split(END)
    path.write_text(f"{before}{BEGIN}\n{text}\n{END}{after}")


def answers(study: dict) -> str:
    """The answers in words, as a list."""
    lines = []
    for answer in study["answers"]:
        use, error = answer["use"], answer["for_error"]
        asked = f"{100 * error:.3g} %" if error > 9e-6 else f"{error:.0e}"
        found = f"{use['cpu_seconds']:.2g} s (error {use['error']:.1e})"
        lines.append(f"- for an error of {asked}: {use['setting']} on {use['cells']} cells, {found}")
    return "\n".join(lines)


def section(folder: Path, name: str, images: str) -> str:
    """Table, answers and plot of one problem."""
    study = json.loads((folder / name / "study.json").read_text())
    table = (folder / name / "table.md").read_text().strip()
    head = "; ".join(study["head"][1:])
    plot = f"![error over CPU seconds]({images}/study_{name}.svg)"
    return f"### {study['title']}\n\n{head}.\n\n{table}\n\n{answers(study)}\n\n{plot}"


def main(folder: Path) -> None:
    images = ROOT / "docs/img"
    for name in PROBLEMS:
        shutil.copy(folder / name / "error_over_seconds.svg", images / f"study_{name}.svg")
        shutil.copy(folder / name / "error_over_dofs.svg", images / f"study_{name}_dofs.svg")
    made = f"Made by `make study`, {date.today().isoformat()}."
    whole = "\n\n".join(section(folder, name, "img") for name in PROBLEMS)
    replace(ROOT / "docs/cost.md", f"{made}\n\n{whole}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
