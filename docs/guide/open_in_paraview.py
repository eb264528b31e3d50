"""A run's frames in ParaView: pvpython docs/guide/open_in_paraview.py DIR PICTURE.png [SECONDS] [COLOUR]

Opens DIR/frames.pvd as it is, mirrors a section at its axis, colours it by COLOUR (shear_rate; flocculation, pressure) at the frame
nearest to SECONDS (the last), and writes PICTURE.png and beside it PICTURE.pvsm, which ParaView's File, Load State opens to go on.
"""

import pathlib
import sys

from paraview.simple import *  # noqa: F403

UNITS = {"shear_rate": "shear rate, 1/s", "flocculation": "flocculation λ", "pressure": "pressure, Pa"}

folder, picture = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
colour = sys.argv[4] if len(sys.argv) > 4 else "shear_rate"
frames = PVDReader(FileName=str(folder / "frames.pvd"))
times = list(frames.TimestepValues)
wanted = float(sys.argv[3]) if len(sys.argv) > 3 else times[-1]
frames.UpdatePipeline(min(times, key=lambda t: abs(t - wanted)))
low_x, high_x, low_y, high_y, low_z, high_z = frames.GetDataInformation().GetBounds()
section = high_y == low_y  # x is the radius, z the height

LoadPalette(paletteName="WhiteBackground")
view = GetActiveViewOrCreate("RenderView")
view.ViewSize = [1100, 320]
animation = GetAnimationScene()
animation.UpdateAnimationUsingDataTimeSteps()
animation.AnimationTime = min(times, key=lambda t: abs(t - wanted))
shown = Reflect(Input=frames, Plane="X", Center=0.0) if section else frames
display = Show(shown, view)
display.SetRepresentationType("Point Gaussian")
display.GaussianRadius = 0.0025
display.ShaderPreset = "Plain circle"
ColorBy(display, ("POINTS", colour))
display.RescaleTransferFunctionToDataRange(False, True)
table = GetColorTransferFunction(colour)
table.ApplyPreset("Viridis (matplotlib)", True)
display.SetScalarBarVisibility(view, True)
bar = GetScalarBar(table, view)
bar.Title, bar.ComponentTitle = UNITS.get(colour, colour), ""
bar.Orientation, bar.WindowLocation, bar.ScalarBarLength = "Horizontal", "Upper Center", 0.4
bar.TitleFontSize = bar.LabelFontSize = 14
view.CameraParallelProjection = 1
view.CameraFocalPoint = [0.0, 0.0, 0.62 * high_z]
view.CameraPosition = [0.0, -1.0, 0.62 * high_z] if section else [0.0, -1.0, 0.6]
view.CameraViewUp = [0.0, 0.0, 1.0]
view.CameraParallelScale = max(0.33 * high_x, 0.75 * high_z)
Render()
SaveScreenshot(str(picture), view, ImageResolution=[1100, 320])
SaveState(str(picture.with_suffix(".pvsm")))
