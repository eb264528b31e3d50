#!/usr/bin/env python3
"""The pours of docs/guide/bored_pile.md, computed by the program and drawn by their loads: pours.py PROGRAM. Writes pours.svg here. Needs
python3-h5py; four minutes of one core."""
import json, pathlib, subprocess, sys, tempfile

import h5py
import numpy

program, here = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(__file__).resolve().parent
scene = here.parents[1] / "apparatus/scenes/bored_pile_model.toml"
cage = ["cage.radius=225 mm", "cage.bars=10", "cage.bar_diameter=20 mm", "cage.hoop_spacing=100 mm", "cage.hoop_diameter=10 mm"]
pause = ["load[1].pause=20 min"]
pours = [
    (["no cage,", "no pause"], []),
    (["a cage", ""], cage),
    (["20 min of pause,", "A_thix = 0.1 Pa/s"], [*pause, "mix.thixotropy.structuration_rate=0.1 Pa/s"]),
    (["20 min of pause,", "A_thix = 0.2 Pa/s"], [*pause, "mix.thixotropy.structuration_rate=0.2 Pa/s"]),
]
colours = {1: "#0067a5", 2: "#f0b33c", 3: "#a63a50"}
radius, depth, across, up = 0.3, 2.0, 0.0125, 0.02  # of the pile and of a rectangle [m]
scale, wide, top = 200.0, 200.0, 70.0  # pixels a metre, a pour, above it


def run(settings, out):
    command = [program, "run", str(scene), "--out", str(out), "--force", "--quiet", "--threads", "1"]
    for setting in settings:
        command += ["--set", setting]
    code = subprocess.run(command).returncode
    results = json.loads((out / "summary.json").read_text())["results"]
    print(settings, "code", code, {k: results[k] for k in ("plug_share", "head_needed_m", "level_end_m")}, flush=True)
    with h5py.File(out / "results.h5") as file:
        last = file["frames"][sorted(file["frames"])[-1]]
        return last["position"][:], last["load"][:], results


def bands(position, load):
    """(column, row, rows, load) of rectangles of one load: the load of most points of each."""
    columns, rows = round(radius / across), round(1.05 * depth / up)
    votes = numpy.zeros((4, columns, rows))
    i = numpy.clip((position[:, 0] / across).astype(int), 0, columns - 1)
    j = numpy.clip((position[:, 2] / up).astype(int), 0, rows - 1)
    numpy.add.at(votes, (load.astype(int), i, j), 1.0)
    winner = numpy.where(votes.sum(axis=0) > 0, votes.argmax(axis=0), 0)
    for i in range(columns):
        for k in range(1, rows - 1):  # a rectangle without a point inside of the concrete has its neighbour's load
            if winner[i, k] == 0 and winner[i, k + 1 :].any():
                winner[i, k] = winner[i, k - 1]
        for k in range(rows - 2, -1, -1):  # near the base that above it
            if winner[i, k] == 0 and k < 5:
                winner[i, k] = winner[i, k + 1]
        start = 0
        for k in range(1, rows + 1):
            if k == rows or winner[i, k] != winner[i, start]:
                if winner[i, start]:
                    yield i, start, k - start, winner[i, start]
                start = k


def draw(x0, words, position, load, results):
    yield f'<text x="{x0}" y="24" text-anchor="middle">{words[0]}</text><text x="{x0}" y="42" text-anchor="middle">{words[1]}</text>'
    for i, row, rows, number in bands(position, load):
        w, h = scale * across, scale * up * rows
        y = top + scale * (1.05 * depth) - scale * up * row - h
        for x in (x0 + w * i, x0 - w * (i + 1)):
            yield f'<rect x="{x:.1f}" y="{y:.1f}" width="{w + 0.3:.1f}" height="{h + 0.3:.1f}" fill="{colours[number]}"/>'
    bottom = top + scale * 1.05 * depth
    yield f'<path d="M{x0 - scale * radius:.1f} {top} V{bottom:.1f} H{x0 + scale * radius:.1f} V{top}" fill="none" stroke="#222" stroke-width="1.5"/>'
    end = "to the top" if results["head_suffices"] else f"stops at {results['level_end_m']:.1f} m"
    plug = results["plug_share"]
    told = "" if plug is None or not results["head_suffices"] else f", plug share {plug:.2f}"
    yield f'<text x="{x0}" y="{bottom + 22:.0f}" text-anchor="middle">{end}{told}</text>'


with tempfile.TemporaryDirectory() as folder:
    parts = []
    for n, (words, settings) in enumerate(pours):
        parts += draw(wide * (n + 0.5), words, *run(settings, pathlib.Path(folder) / str(n)))
height = top + scale * 1.05 * depth + 64
key = "".join(f'<rect x="{40 + 130 * n}" y="{height - 26:.0f}" width="14" height="14" fill="{colours[n + 1]}"/><text x="{60 + 130 * n}" y="{height - 14:.0f}">load {n + 1}</text>' for n in range(3))
width = wide * len(pours)
svg = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" font-family="sans-serif" font-size="14"><rect width="{width:.0f}" height="{height:.0f}" fill="#fff"/>{"".join(parts)}{key}</svg>\n'
(here / "pours.svg").write_text(svg)
