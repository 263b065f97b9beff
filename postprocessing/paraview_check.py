"""Opens every kind of exported file in the real ParaView, compares arrays and ranges, and draws figure 3 of the paper.

usage: pvbatch postprocessing/paraview_check.py RUN... --out PICTURE.png       (`make paraview` calls it)

Each RUN has been exported with `--format vtu,xdmf,vtkhdf`, and with `--deformed`. For each step the arrays that ParaView shows have the
names that the .vtu file lists and the ranges that stand in it; the other formats have the ranges of the .vtu. The picture has a map of
sigma11 for each run on one colour scale, on the deformed grid. Exit code 1: a difference, with the file and the array.
"""

import re
import sys
from pathlib import Path

from paraview import servermanager
from paraview.simple import (
    ColorBy,
    CreateView,
    Delete,
    GetColorTransferFunction,
    GetParaViewVersion,
    GetScalarBar,
    OpenDataFile,
    PVDReader,
    Render,
    SaveScreenshot,
    Show,
    Text,
    UpdatePipeline,
)

# Time-dependent VTKHDF came with ParaView 5.12.
READS_VTKHDF = (5, 12)
SIZE = [560, 520]


def fail(what):
    print(f"paraview: {what}")
    sys.exit(1)


def written(path):
    """{section: {name: (low, high)}} of the arrays of a .vtu file, by the attributes of its text; ranges of single numbers."""
    text = Path(path).read_text()
    found = {}
    for section in ("PointData", "CellData"):
        body = re.search(f"<{section}>(.*?)</{section}>", text, re.S)
        arrays = re.findall(r'<DataArray type="[^"]*" Name="([^"]*)"(.*?)>', body.group(1)) if body else []
        limits = [(name, [float(re.search(f'{key}="([^"]*)"', rest).group(1)) for key in ("RangeMin", "RangeMax")])
                  for name, rest in arrays]
        found[section] = dict(limits)
    return found


def shown(source):
    """The same as ParaView has it: the smallest and the largest number of all components."""
    found = {}
    for section, data in (("PointData", source.PointData), ("CellData", source.CellData)):
        ranges = {}
        for array in data:
            each = [array.GetRange(k) for k in range(array.GetNumberOfComponents())]
            ranges[array.Name] = [min(low for low, _ in each), max(high for _, high in each)]
        found[section] = ranges
    return found


def same(expected, found, path, sections):
    """Names and ranges to the last bit; ranges of numbers that are not finite are not compared."""
    for section in sections:
        missing = set(expected[section]) - set(found[section])
        if missing:
            fail(f"{path}: {section} has no {', '.join(sorted(missing))}")
        for name, limits in expected[section].items():
            finite = all(abs(x) < 1e300 for x in limits)
            if finite and list(found[section][name]) != list(limits):
                fail(f"{path}: {section} {name} has the range {found[section][name]}, not {limits}")


def at(source, time):
    UpdatePipeline(time, source)
    return shown(source)


def check(run):
    """Opens the files of an export; returns how many were opened."""
    export = Path(run) / "export"
    opened = 0
    for name in ("grid", "points", "grid_deformed", "points_deformed"):
        series = PVDReader(FileName=str(export / f"{name}.pvd"))
        parts = sorted(p for p in export.glob(f"{name}_*.vtu") if re.fullmatch(rf"{name}_\d+\.vtu", p.name))
        times = list(series.TimestepValues)
        if len(times) != len(parts):
            fail(f"{export / name}.pvd: {len(times)} times of {len(parts)} files")
        same_kind = {}
        if not name.startswith("points"):
            suffix = name.removeprefix("grid")
            same_kind["XDMF"] = OpenDataFile(str(export / f"series{suffix}.xdmf"))
        if GetParaViewVersion() >= READS_VTKHDF:
            same_kind["VTKHDF"] = OpenDataFile(str(export / f"{name}.vtkhdf"))
        for time, part in zip(times, parts):
            expected = written(part)
            alone = OpenDataFile(str(part))
            for source, path in ((series, f"{name}.pvd"), (alone, part.name)):
                same(expected, at(source, time), export / path, ("PointData", "CellData"))
            for kind, source in same_kind.items():
                if source is None:
                    fail(f"{export}: the {kind} file of {name} is not opened")
                same(expected, at(source, time), f"{export}: {kind} of {name}", ("PointData", "CellData"))
            Delete(alone)
            opened += 1
        opened += 1 + len(same_kind)
        for source in (series, *same_kind.values()):
            Delete(source)
    for name, cells in (("mesh.xdmf", True), ("boundary.xdmf", True)):
        source = OpenDataFile(str(export / name))
        UpdatePipeline(proxy=source)
        if (source.GetDataInformation().GetNumberOfCells() > 0) != cells:
            fail(f"{export / name}: no cells")
        Delete(source)
        opened += 1
    return opened


def largest_stress(source):
    low, high = source.PointData.GetArray("cauchy_stress").GetRange(0)
    return max(-low, high)


def title(run):
    import json

    summary = json.loads((Path(run) / "summary.json").read_text())
    return f"{summary['method'].upper()}, S{summary['degree']}"


def draw(runs, out):
    """A map of sigma11 for each run, beside each other on one symmetric colour scale."""
    view = CreateView("RenderView")
    view.ViewSize = [SIZE[0] * len(runs), SIZE[1]]
    view.UseColorPaletteForBackground, view.Background = 0, [1.0, 1.0, 1.0]
    view.OrientationAxesVisibility, view.InteractionMode = 0, "2D"
    sources = []
    for run in runs:
        source = PVDReader(FileName=str(Path(run) / "export" / "grid_deformed.pvd"))
        UpdatePipeline(source.TimestepValues[-1], source)
        sources.append(source)
    view.ViewTime = sources[0].TimestepValues[-1]
    limit = max(largest_stress(source) for source in sources)
    colours = GetColorTransferFunction("cauchy_stress")
    colours.VectorMode, colours.VectorComponent = "Component", 0
    colours.ApplyPreset("Cool to Warm (Extended)", True)
    bounds = [source.GetDataInformation().GetBounds() for source in sources]
    width = 1.12 * max(high - low for low, high, *_ in bounds)
    for k, (run, source) in enumerate(zip(runs, sources)):
        surface = Show(source, view)
        surface.Representation, surface.NonlinearSubdivisionLevel = "Surface", 2
        surface.Ambient, surface.Diffuse = 1.0, 0.0  # a lamp would change the colours
        surface.Position = [k * width, 0.0, 0.0]
        ColorBy(surface, ("POINTS", "cauchy_stress"))
        label = Show(Text(Text=title(run)), view)
        label.Color, label.FontSize = [0.0, 0.0, 0.0], 20
        label.WindowLocation, label.Position = "Any Location", [0.07 + 0.29 * k, 0.93]
    bar = GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle = "sigma11 (Pa)", ""
    bar.TitleColor = bar.LabelColor = [0.0, 0.0, 0.0]
    bar.WindowLocation, bar.Position, bar.ScalarBarLength = "Any Location", [0.9, 0.2], 0.6
    surface.SetScalarBarVisibility(view, True)
    Render(view)
    view.ResetCamera()
    middle, height = 0.5 * (len(runs) - 1) * width + 0.5 * width, max(high - low for _, _, low, high, *_ in bounds)
    view.CameraParallelScale = 0.62 * height
    # What is shown first has set the range.
    colours.AutomaticRescaleRangeMode = "Never"
    colours.RescaleTransferFunction(-limit, limit)
    # To the left of the colour bar.
    x = bounds[0][0] + middle + 0.17 * width
    y = 0.5 * (bounds[0][2] + bounds[0][3])
    view.CameraPosition, view.CameraFocalPoint = [x, y, 10.0], [x, y, 0.0]
    Render(view)
    SaveScreenshot(str(out), view, ImageResolution=view.ViewSize)


def main(arguments):
    if "--out" not in arguments or len(arguments) < 3:
        raise SystemExit(__doc__)
    place = arguments.index("--out")
    out, runs = arguments[place + 1], arguments[:place] + arguments[place + 2:]
    servermanager.SetProgressPrintingEnabled(False)
    opened = sum(check(run) for run in runs)
    draw(runs, out)
    print(f"paraview {GetParaViewVersion()}: {opened} files opened, arrays and ranges as written; {out}")


main(sys.argv[1:])
