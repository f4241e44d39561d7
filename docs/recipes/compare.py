"""How far two runs of the same scene are apart, row by row of their histories. Usage: compare.py RUN OTHER"""

import sys
from pathlib import Path

import numpy
import pandas

run, other = (pandas.read_csv(Path(folder, "history.csv")).set_index("time_s") for folder in sys.argv[1:3])
# Their rows may be at other times: the other run is read in between.
for name in run.columns.intersection(other.columns).drop("h"):
    between = numpy.interp(run.index, other.index, other[name])
    size = run[name].abs().max()
    if size > 0:
        print(f"{name:40} {abs(run[name] - between).max() / size:.2e} of its largest value")
