"""Opens an exported run in ParaView: the grid on its deformed shape, coloured by stress, with the material points.

Without a window:        pvbatch postprocessing/paraview_state.py RUN [OUT]
Without a display:       xvfb-run -a -s "-noreset -screen 0 1600x1200x24" pvbatch ...     (Debian's ParaView needs an X
                         server, and opens it twice: one that resets in between refuses the second time)
In a window:             paraview --script=postprocessing/paraview_state.py     (the run from DGMPM_RUN)
As a macro:              Macros > Import new macro; then DGMPM_RUN, or the folder that ParaView was started in

Without a window it writes OUT.png (the last step) and OUT.0000.png, ... (the animation); OUT is RUN/export/paraview.
The settings below are meant to be edited. Tested with ParaView 5.11.
"""

import os
import sys

from paraview.simple import (
    ColorBy,
    GetActiveViewOrCreate,
    GetAnimationScene,
    GetColorTransferFunction,
    GetScalarBar,
    PVDReader,
    Render,
    ResetCamera,
    SaveAnimation,
    SaveScreenshot,
    Show,
    WarpByVector,
)

FIELD, COMPONENT = "cauchy_stress", "XX"  # a vector has X, Y, Magnitude; a scalar None
COLOURS = "Cool to Warm (Extended)"
WARP = 1.0  # factor on the displacement
SUBDIVISION = 3  # of the curved, high-order cells where they are drawn
POINT_SIZE = 0.006  # radius in m, 0 for no points
PICTURE = [1400, 1100]


def export_folder(run):
    """The folder with grid.pvd, given a run folder or its export folder."""
    for folder in (run, os.path.join(run, "export")):
        if os.path.isfile(os.path.join(folder, "grid.pvd")):
            return os.path.abspath(folder)
    raise SystemExit(f"{run}: no grid.pvd here nor in export/; run `dgmpm export` first")


def warped(path):
    """Reads a .pvd series and moves it by its displacement, where it has one."""
    reader = PVDReader(FileName=path)
    reader.UpdatePipeline(reader.TimestepValues[-1] if len(reader.TimestepValues) else 0.0)
    if reader.PointData.GetArray("displacement") is None:
        return reader
    return WarpByVector(Input=reader, Vectors=["POINTS", "displacement"], ScaleFactor=WARP)


def component_index():
    """The place of COMPONENT in its array; tensors are row-major 3 x 3. -1 is the magnitude."""
    names = {"X": 0, "Y": 1, "XX": 0, "XY": 1, "YX": 3, "YY": 4, "ZZ": 8, "Magnitude": -1, None: 0}
    return names[COMPONENT]


def symmetric_range(source):
    """The range of the drawn component in the last step; the same to both sides of zero if it holds zero."""
    low, high = source.PointData.GetArray(FIELD).GetRange(component_index())
    return (-max(-low, high), max(-low, high)) if low < 0 < high else (low, high)


def show_grid(folder, view):
    """The grid as a coloured surface with a colour bar."""
    grid = warped(os.path.join(folder, "grid.pvd"))
    surface = Show(grid, view)
    surface.Representation = "Surface"
    surface.NonlinearSubdivisionLevel = SUBDIVISION
    surface.Ambient, surface.Diffuse = 1.0, 0.0  # a lamp would change the colours
    ColorBy(surface, ("POINTS", FIELD))
    colours = GetColorTransferFunction(FIELD)
    if component_index() >= 0:  # by number: not every version names the components of a tensor
        colours.VectorMode, colours.VectorComponent = "Component", component_index()
    colours.ApplyPreset(COLOURS, True)
    colours.RescaleTransferFunction(*symmetric_range(grid))
    bar = GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle = FIELD.replace("_", " "), COMPONENT or ""
    bar.TitleColor = bar.LabelColor = [0.0, 0.0, 0.0]
    bar.WindowLocation, bar.Position, bar.ScalarBarLength = "Any Location", [0.87, 0.2], 0.6
    surface.SetScalarBarVisibility(view, True)


def show_points(folder, view):
    """The material points as small dark spheres."""
    path = os.path.join(folder, "points.pvd")
    if not (POINT_SIZE and os.path.isfile(path)):
        return
    points = Show(warped(path), view)
    points.Representation = "Point Gaussian"
    points.ShaderPreset = "Sphere"
    points.GaussianRadius = POINT_SIZE
    points.Position = [0.0, 0.0, 2 * POINT_SIZE]  # in front of the surface
    points.ColorArrayName = [None, ""]
    points.DiffuseColor = points.AmbientColor = [0.1, 0.1, 0.1]


def main(run, out):
    folder = export_folder(run)
    view = GetActiveViewOrCreate("RenderView")
    view.ViewSize = PICTURE
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    show_grid(folder, view)
    show_points(folder, view)
    scene = GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.GoToLast()
    view.InteractionMode = "2D"
    ResetCamera(view)
    view.CameraParallelScale *= 0.78  # a little larger, and to the left of the colour bar
    shift = 0.12 * view.CameraParallelScale
    view.CameraPosition = [view.CameraPosition[0] + shift, *view.CameraPosition[1:]]
    view.CameraFocalPoint = [view.CameraFocalPoint[0] + shift, *view.CameraFocalPoint[1:]]
    Render(view)
    if out:
        SaveScreenshot(out + ".png", view, ImageResolution=PICTURE)
        SaveAnimation(out + ".png", view, ImageResolution=PICTURE, SuffixFormat=".%04d")
        print(out + ".png")


# In a window sys.argv holds no run: the run comes from the environment, and no picture is written.
arguments = [argument for argument in sys.argv[1:] if not argument.startswith("-")]
chosen = arguments[0] if arguments else os.environ.get("DGMPM_RUN", os.getcwd())
picture = (arguments[1:] or [os.path.join(export_folder(chosen), "paraview")])[0] if arguments else None
main(chosen, picture)
