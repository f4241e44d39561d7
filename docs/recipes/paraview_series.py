"""Draws every frame of a run, coloured by speed, as PNG files. Usage: pvpython paraview_series.py RUN FOLDER"""

import sys
from pathlib import Path

from paraview.simple import *

run, folder = Path(sys.argv[1]), Path(sys.argv[2])
folder.mkdir(parents=True, exist_ok=True)
# Frames hold the blocks where they are: nothing need be warped.
blocks = PVDReader(FileName=str((run / "fields.pvd").resolve()))
view = GetActiveViewOrCreate("RenderView")
view.ViewSize = [1280, 800]
shown = Show(blocks, view)
shown.Representation = "Surface With Edges"
ColorBy(shown, ("POINTS", "velocity_m_s", "Magnitude"))
shown.RescaleTransferFunctionToDataRangeOverTime()
shown.SetScalarBarVisibility(view, True)
ResetCamera(view)
view.CameraPosition = [a + b for a, b in zip(view.CameraFocalPoint, (0.5, -1, 0.4))]
view.CameraViewUp = [0, 0, 1]
ResetCamera(view)
scene = GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
SaveAnimation(str(folder / "frame.png"), view, FrameWindow=[0, len(blocks.TimestepValues) - 1])
