"""States of runs of gallery scenes for ParaView: RUN/view.pvsm, and a picture of the end. Usage: pvpython paraview_gallery.py RUN ..."""

import json
import sys
from pathlib import Path

from paraview.simple import *

VIEWS = json.loads((Path(__file__).parent / "views.json").read_text())
for run in map(Path, sys.argv[1:]):
    look = VIEWS[json.loads((run / "summary.json").read_text())["scene"]]
    ResetSession()
    blocks = PVDReader(FileName=str((run / "fields.pvd").resolve()))
    view = CreateView("RenderView")
    AssignViewToLayout(view=view, layout=CreateLayout())
    view.ViewSize = [1280, 800]
    shown = Show(blocks, view)
    shown.Representation = "Surface With Edges"
    shown.Opacity = 0.4 if look.get("clear") else 1.0
    ColorBy(shown, ("POINTS", look.get("colour", "displacement_m"), "Magnitude"))
    shown.RescaleTransferFunctionToDataRangeOverTime()
    scene = GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.AnimationTime = look.get("end", blocks.TimestepValues[-1])
    ResetCamera(view)
    view.CameraPosition = [a + b for a, b in zip(view.CameraFocalPoint, look["eye"])]
    view.CameraViewUp = look.get("up", [0, 0, 1])
    ResetCamera(view)
    SaveScreenshot(str(run / "view.png"), view)
    SaveState(str(run / "view.pvsm"))
