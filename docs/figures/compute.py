#!/usr/bin/env python3
"""What the figures of docs/paper_page.md show, computed by the program: compute.py PROGRAM. Writes errors.csv here, ../rheograph.svg."""
import csv, json, pathlib, subprocess, sys, tempfile

program, here = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(__file__).resolve().parent
scenes = here.parents[1] / "apparatus/scenes"
folder = tempfile.TemporaryDirectory()


def run(scene, *settings):
    """Spread [mm] and CPU time [s] of a scene; a result that is not to be trusted ends all."""
    out = pathlib.Path(folder.name) / "run"
    command = [program, "run", str(scenes / scene), "--out", str(out), "--force", "--quiet", "--threads", "1", "--set", "output.frames=false"]
    for setting in settings:
        command += ["--set", setting]
    code = subprocess.run(command, stdout=subprocess.DEVNULL).returncode
    summary = json.loads((out / "summary.json").read_text())
    print(scene, *settings, f"spread {summary['results']['spread_mm']:.1f} mm, {summary['cost']['cpu_s']:.2f} s, code {code}", flush=True)
    if code != 0:
        sys.exit(f"tremie run {scene} ended with code {code}")
    return summary["results"]["spread_mm"], summary["cost"]["cpu_s"]


def write(name, head, rows):
    with open(here / name, "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([head, *rows])


def errors():
    """Spread after 20 s, cone removed instantaneously, no thixotropy, against finite elements."""
    peers = list(csv.DictReader(open(here / "peers.csv")))
    truth = {row["mix"]: float(row["spread_mm"]) for row in peers if row["program"] == "finite elements"}
    alone = ["test.lift_speed=instant", "mix.thixotropy=false", "test.duration=20 s"]
    rows = []
    for mix in "AC":
        for cells in ("10 mm", "[10 mm, 5 mm]", "5 mm", "[5 mm, 2.5 mm]"):
            spread, cpu = run(f"slump_flow_mix_{mix.lower()}.toml", f"model.cell={cells}", *alone)
            rows.append(["section", mix, cells.replace("mm, ", "x ").strip("[]"), f"{abs(spread / truth[mix] - 1):.5f}", f"{cpu:.3f}", f"{cpu:.3f}"])
        spread, cpu = run(f"slump_flow_mix_{mix.lower()}.toml", "model.space=quarter", *alone)
        rows.append(["3D", mix, "14 x 7 mm", f"{abs(spread / truth[mix] - 1):.5f}", f"{cpu:.3f}", f"{cpu:.3f}"])
    for row in peers:
        if row["cpu_low_s"]:
            error = f"{abs(float(row['spread_mm']) / truth[row['mix']] - 1):.5f}" if row["spread_mm"] else ""
            rows.append([row["program"], row["mix"], row["cells"], error, row["cpu_low_s"], row["cpu_high_s"]])
    write("errors.csv", ["program", "mix", "cells", "error", "cpu_low_s", "cpu_high_s"], rows)


errors()
subprocess.run([program, "estimate", "--chart", str(here.parent / "rheograph.svg")], check=True)
