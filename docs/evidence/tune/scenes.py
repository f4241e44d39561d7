#!/usr/bin/env python3
"""What `ndda tune` answers on every scene of scenes/ and on three that no test knows: prints a table for docs/guide/certify.md.

  docs/evidence/tune/scenes.py NDDA FOLDER [SCENE ...]

NDDA is the program. Each scene is tuned to an error of 10 % within BUDGET_S seconds of runs, in FOLDER; a row of FOLDER/results.csv is written as
soon as it is done, and a scene that has its row is not done again. Scenes that take long are shortened as docs/evidence/certify/run.py
shortens them. Gain: processor time of the scene's own setting, at the longest step that reaches the error, over that of the answer.
"""

import json
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "docs" / "evidence" / "certify"))
import run as certify  # noqa: E402

BUDGET_S = 20
ERROR = "1e-1"
COLUMNS = ["scene", "changed", "code", "error", "time_s", "setting", "spent_s", "said"]


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__.strip())
    program, folder = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    results = folder / "results.csv"
    for row in certify.each(sys.argv[3:], results, COLUMNS, lambda scene: tuned(program, folder, scene)):
        print(f"{row['scene']}: code {row['code']}, error {row['error']}, {row['spent_s']} s", file=sys.stderr)
    show(certify.rows(results))


def tuned(program, folder, scene):
    began = time.time()
    sets = [word for value in certify.SHORTENED.get(scene, []) for word in ("--set", value)]
    out = folder / scene.replace("/", "_").removesuffix(".ron")
    row = dict.fromkeys(COLUMNS, "") | {"scene": scene, "changed": " ".join(certify.SHORTENED.get(scene, []))}
    words = ["tune", str(ROOT / scene), "--error", ERROR, "--budget-s", str(BUDGET_S), "--quiet", "--out", str(out), *sets]
    row["code"], row["said"] = certify.ran(program, words)
    answer = out / "tune.json"
    if answer.exists():
        best = json.loads(answer.read_text(encoding="utf-8")).get("best")
        if best:
            row |= {"error": f"{best['error']:.1e}", "time_s": f"{best['time_s']:.3g}", "setting": best["label"]}
    row["spent_s"] = f"{time.time() - began:.0f}"
    return row


def show(found):
    print("| scene | changed | code | error | time [s] | setting | search [s] | remark |\n|---|---|---|---|---|---|---|---|")
    for row in found:
        remark = row["said"].replace("|", "∣")[:120] if not row["setting"] else ""
        cells = [row["scene"], row["changed"], row["code"], row["error"], row["time_s"], row["setting"], row["spent_s"], remark]
        print("| " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
