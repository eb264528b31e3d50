#!/usr/bin/env python3
"""The result that tremie.html opens on, by the native program: make_opening.py TREMIE > page/opening.json.

Mix A as the page's fields have it at first, with its error bar; cost is left out, so that the file depends on the result alone."""
import csv, json, pathlib, subprocess, sys, tempfile

SCENE = 'apparatus = "slump_flow"\nmix = "mix_a"\n[test]\nduration = "120 s"\n[output]\nframes = false\n'


def opening(program):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "scene.toml").write_text(SCENE)
        said = subprocess.run([program, "run", folder / "scene.toml", "--out", folder / "out", "--with-error", "--threads", "1"],
                              check=True, capture_output=True, text=True).stdout
        summary = json.loads((folder / "out/summary.json").read_text())
        rows = list(csv.reader((folder / "out/timeseries.csv").open()))[1:]
    kept = rows[: len(rows) // 2 : 3] + rows[len(rows) // 2 : -1 : 6] + rows[-1:]
    keep = {"results": summary["results"], "checks": summary["checks"], "cost": {"steps": summary["cost"]["steps"]},
            "error": {"spread_mm": summary["error"]["spread_mm"]}}
    return {"summary": keep, "lines": [line for line in said.splitlines() if line.startswith("t500")],
            "time": [round(float(row[0]), 4) for row in kept], "spread": [round(float(row[1]), 3) for row in kept]}


if __name__ == "__main__":
    print(json.dumps(opening(sys.argv[1])))
