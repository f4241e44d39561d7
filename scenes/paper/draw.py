"""Pictures of docs/evidence/paper from its CSV, in the form of the paper's figures. Needs matplotlib."""

import io

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from PIL import Image

from results import read_curves

SCHEMES = ("paper", "Midpoint", "GeneralizedAlpha", "Midpoint, contact at the end")
NAMES = {"paper": "the paper's scheme"}
SHARED = {"sharex": True, "sharey": True, "constrained_layout": True}
# What the paper's text prints: curves it names, and the size that it gives their errors.
CLAIMS = {
    "fig5": [(1e-4, "paper, k_n = 1e-5 E: 1e-4"), (1e-3, "paper, k_n = 1e-6 E: 1e-3")],
    "fig6": [(1e-4, "paper, k_n = 1e-1 to 1e-5 E: 1e-4")],
    "fig7": [(1e-4, "paper: 1e-4")],
    "fig8": [(1e-3, "paper, k_s ≥ 1e-2 E: 1e-3"), (0.14, "paper, k_s = 1e-3 E: at most 0.14")],
    "fig9": [(1e-2, "paper, k_s ≥ 1e-2 E: 1e-2"), (0.4, "paper, k_s = 1e-3 E: at most 0.4")],
}


def parts(label):
    """What varies, scheme and start of a curve."""
    return (*label.split(" | "), "", "")[:3]


def panel(axes, name, start, times, curves):
    """Curves of one scheme and one start over time."""
    varied = list(dict.fromkeys(parts(label)[0] for label in curves))
    colours = plt.colormaps["viridis"]
    for label, values in curves.items():
        kind, scheme, begins = parts(label)
        if scheme == name and begins == start:
            colour = colours(0.88 * varied.index(kind) / max(len(varied) - 1, 1))
            axes.semilogy(times, [abs(v) for v in values], linewidth=0.8, color=colour, label=kind)
    axes.set_title(", ".join(filter(None, (NAMES.get(name, name), "" if start == "touching" else start))), fontsize=9)


def errors(figure, folder, times, curves):
    """One panel per scheme and start, all with the same axes."""
    starts = list(dict.fromkeys(parts(label)[2] for label in curves))
    schemes = [s for s in SCHEMES if any(parts(label)[1] == s for label in curves)]
    size = (3.0 * len(schemes) + 1.6, 2.7 * len(starts))
    canvas, grid = plt.subplots(len(starts), len(schemes), figsize=size, squeeze=False, **SHARED)
    for i, start in enumerate(starts):
        for j, scheme in enumerate(schemes):
            axes = grid[i][j]
            panel(axes, scheme, start, times, curves)
            for k, (size, said) in enumerate(CLAIMS.get(figure, [])):
                axes.axhline(size, color="#b5523b", linewidth=1, linestyle=("--", ":")[k], label=said)
            axes.set_ylim(1e-9, 1e3 if figure == "fig5" else 1)
            axes.grid(alpha=0.25)
    for axes in grid[-1]:
        axes.set_xlabel("t [s]", fontsize=9)
    for row in grid:
        row[0].set_ylabel("|relative displacement error|", fontsize=8)
    handles, labels = grid[0][0].get_legend_handles_labels()
    canvas.legend(handles, labels, loc="outside right upper", fontsize=7, frameon=False)
    save(canvas, folder / f"{figure}.png")


def steps(folder):
    """Fig. 7: k_n = 1e-5 E at both steps."""
    both = {}
    for figure, step in (("fig5", "Δt = 1e-4 s"), ("fig6", "Δt = 1e-5 s")):
        times, curves = read_curves(folder / f"{figure}.csv")
        for label, values in curves.items():
            kind, scheme, start = parts(label)
            if kind == "k_n = 1e-5 E" and scheme in SCHEMES[:3]:
                both[" | ".join((step, scheme, start))] = values
    errors("fig7", folder, times, both)


def momentum(folder):
    """Fig. 3: momentum over time, a panel per case and scheme."""
    times, curves = read_curves(folder / "fig3.csv")
    canvas, grid = plt.subplots(2, 3, figsize=(9, 4.6), **SHARED)
    for i, case in enumerate("12"):
        for j, scheme in enumerate(SCHEMES[:3]):
            axes = grid[i][j]
            for name, colour in (("A", "#7f9dbb"), ("B", "#5f8a4f"), ("total", "#333333")):
                axes.plot(times, curves[f"{case} | {scheme} | {name}"], color=colour, label={"total": "both"}.get(name, name))
            axes.axhline(2650, color="#b5523b", linestyle=":", label="exact, both: 2650")
            axes.set_title(f"case {case}, {NAMES.get(scheme, scheme)}", fontsize=9)
            axes.grid(alpha=0.25)
    grid[0][0].legend(fontsize=7, frameon=False)
    for axes in grid[1]:
        axes.set_xlabel("t [s]")
    for row in grid:
        row[0].set_ylabel("momentum [kg m/s]", fontsize=8)
    save(canvas, folder / "fig3.png")


def save(canvas, path):
    """As a PNG of few colours, which is a third of the size."""
    pixels = io.BytesIO()
    canvas.savefig(pixels, dpi=90)
    plt.close(canvas)
    Image.open(pixels).convert("RGB").quantize(64, dither=Image.Dither.NONE).save(path, optimize=True)


def draw(folder):
    """All pictures."""
    momentum(folder)
    for figure in ("fig5", "fig6", "fig8", "fig9", "fig10", "fig11"):
        times, curves = read_curves(folder / f"{figure}.csv")
        errors(figure, folder, times, curves)
    steps(folder)
