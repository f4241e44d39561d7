#!/usr/bin/env python3
"""Draws docs/pictures/gallery/NAME.jpg: blocks of a scene at its start and at its end, coloured by how far they have moved.

Usage: gallery.py RUNS [NAME ...]     (RUNS holds the folders of `ndda run`, one per scene; needs pyvista and pillow)
"""

import json
import sys
from pathlib import Path

import numpy as np
import pyvista
from PIL import Image, ImageDraw, ImageFont

OUT = Path(__file__).parent / "gallery"
PANEL = (520, 400)
STILL = (0.82, 0.79, 0.74)
# Per scene: where the eye is from the middle of the blocks, how near, and what else differs from the usual.
VIEWS = json.loads((Path(__file__).parent.parent / "recipes" / "views.json").read_text(encoding="utf-8"))


def frame(reader, time):
    """Blocks at the frame that is nearest to a time, and that time."""
    times = np.array(reader.time_values)
    at = times[np.abs(times - time).argmin()]
    reader.set_active_time_value(at)
    grid = reader.read()[0]
    for name in ("displacement_m", "velocity_m_s"):
        grid[f"size of {name}"] = np.linalg.norm(grid[name], axis=1)
    return grid, at


def draw(grid, bounds, view, colour, largest):
    """One panel: moving blocks in colour, still ones in stone, the edges of all."""
    plotter = pyvista.Plotter(off_screen=True, window_size=PANEL)
    plotter.set_background("white")
    for block in np.unique(grid["block_id"]):
        surface = grid.extract_cells(grid["block_id"] == block).extract_surface(algorithm="dataset_surface")
        still = block in view["still"]
        clear = 0.12 if still and view.get("clear") else 1.0
        look = {"color": STILL} if still else {"scalars": colour, "cmap": "viridis", "clim": (0, largest)}
        plotter.add_mesh(surface, opacity=clear, show_scalar_bar=False, ambient=0.25, **look)
        edges = surface.extract_feature_edges(15, manifold_edges=False, non_manifold_edges=False)
        plotter.add_mesh(edges, color="black", opacity=0.35 if clear < 1 else 1.0, line_width=1.5)
    plotter.camera.parallel_projection = True
    plotter.view_vector(view["eye"], view.get("up", (0, 0, 1)))
    plotter.reset_camera(bounds=bounds)
    plotter.camera.zoom(view.get("zoom", 1.25))
    plotter.enable_anti_aliasing("ssaa")
    return Image.fromarray(plotter.screenshot(return_img=True))


def picture(run, name):
    """The two panels side by side, with their times and the meaning of colours."""
    view = dict(VIEWS[name])
    reader = pyvista.get_reader(str(run / "fields.pvd"))
    end = view.get("end", reader.time_values[-1])
    frames = [frame(reader, time) for time in (0.0, end)]
    field = view.get("colour", "displacement_m")
    colour = f"size of {field}"
    largest = max(grid[colour].max() for grid, _ in frames)
    last = frames[-1][0]
    # Per block the largest displacement at any of its nodes: what moves less than 1 % of the farthest is still.
    reach = {block: last.extract_cells(last["block_id"] == block)["size of displacement_m"].max() for block in np.unique(last["block_id"])}
    view["still"] = {block for block, value in reach.items() if value < 0.01 * max(reach.values())}
    both = np.array([grid.bounds for grid, _ in frames])
    bounds = [f(both[:, i]) for i, f in enumerate((np.min, np.max) * 3)]
    sheet = Image.new("RGB", (2 * PANEL[0], PANEL[1] + 28), "white")
    font = ImageFont.load_default(size=17)
    text = ImageDraw.Draw(sheet)
    for i, (grid, time) in enumerate(frames):
        sheet.paste(draw(grid, bounds, view, colour, largest), (i * PANEL[0], 28))
        text.text((i * PANEL[0] + 12, 6), f"t = {time:.4g} s", fill="black", font=font)
    unit = "displacement, 0 to {:.3g} m" if field == "displacement_m" else "speed, 0 to {:.3g} m/s"
    text.text((2 * PANEL[0] - 12, 6), "dark to bright: " + unit.format(largest), fill="black", font=font, anchor="ra")
    OUT.mkdir(exist_ok=True)
    sheet.save(OUT / f"{name}.jpg", quality=82, optimize=True)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__.strip())
    for scene in sys.argv[2:] or VIEWS:
        picture(Path(sys.argv[1]) / scene, scene)
        print(OUT / f"{scene}.jpg")
