"""Volume and mean speed of every block, frame by frame, with pyvista. Usage: block_speeds.py RUN"""

import sys
from pathlib import Path

import numpy
import pandas
import pyvista

reader = pyvista.get_reader(str(Path(sys.argv[1], "fields.pvd")))
rows = []
for time in reader.time_values:
    reader.set_active_time_value(time)
    grid = reader.read()[0]
    # From nodes to tetrahedra, whose volumes weigh the mean.
    cells = grid.point_data_to_cell_data().compute_cell_sizes(length=False, area=False)
    speed = numpy.linalg.norm(cells["velocity_m_s"], axis=1)
    table = pandas.DataFrame({"block": grid["block_id"], "volume_m3": cells["Volume"], "flow": cells["Volume"] * speed})
    sums = table.groupby("block").sum()
    rows += [(time, block, row.volume_m3, row.flow / row.volume_m3) for block, row in sums.iterrows()]
result = pandas.DataFrame(rows, columns=["time_s", "block", "volume_m3", "mean_speed_m_s"])
print(result[result.time_s == result.time_s.max()].to_string(index=False))
