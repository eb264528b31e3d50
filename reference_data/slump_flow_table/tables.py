#!/usr/bin/env python3
"""Makes the tables that `tremie estimate` reads, one for each mould: tables.py TREMIE [MOULD...]

A table is a study of slump_exact.toml over a grid. The Abrams cone's is finer; another mould's range is the Abrams cone's by
its size. A run that is not to be trusted has its value from its neighbours along
the viscosity, on which a spread at rest hardly depends, and the header counts them."""

import csv
import math
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
MOULDS = ["abrams", "abrams_inverted", "half_abrams", "haegermann", "kantro", "astm_c230", "gb_t_8077", "vicat", "cylinder"]
COLUMNS = ["spread_mm", "slump_mm", "t500_s"]


def scale(mould):
    """How large the mould is beside the Abrams cone."""
    text = (HERE.parent / "cones" / f"{mould}.toml").read_text()
    top, bottom, height = (float(re.search(rf'{key}\s*=\s*"([\d.]+) mm"', text)[1]) for key in ("top_radius", "bottom_radius", "height"))
    return (height * (top**2 + top * bottom + bottom**2) / (300 * (50**2 + 50 * 100 + 100**2))) ** (1 / 3)


def nodes(low, high, count):
    """Evenly on a logarithmic scale, to three digits."""
    return [float(f"{low * (high / low) ** (i / (count - 1)):.3g}") for i in range(count)]


def grid(mould):
    size = scale(mould)
    if mould == "abrams":
        return nodes(6.5, 2200, 26), nodes(2, 500, 12)
    least = 2 if "abrams" in mould else 1.5  # of the viscosity: more fluid ones are ruled by inertia
    return nodes(8 * size, 2200 * size, 18), nodes(least * size**1.5, 250 * size**1.5, 6)


def values(numbers, unit):
    return "[" + ", ".join(f'"{x:g} {unit}"' for x in numbers) + "]"


def study(tremie, mould, folder):
    tau_0, mu = grid(mould)
    (folder / "base.toml").write_text(f'cone = "{mould}"\n' + (HERE / "slump_exact.toml").read_text())
    (folder / "study.toml").write_text(
        f'base = "base.toml"\n'
        f'[[factor]]\nkey = "mix.yield_stress"\nvalues = {values(tau_0, "Pa")}\n'
        f'[[factor]]\nkey = "mix.plastic_viscosity"\nvalues = {values(mu, "Pa.s")}\n'
        f'[design]\nmethod = "grid"\n[read]\nresults = ["spread_mm", "slump_mm", "t500_s"]\n')
    subprocess.run([tremie, "study", "study.toml", "--out", "out", "--jobs", "2", "--force"], cwd=folder, check=False)
    with open(folder / "out" / "study.csv") as file:
        rows = {(float(r["mix.yield_stress_Pa"]), float(r["mix.plastic_viscosity_Pa_s"])): r for r in csv.DictReader(file)}
    return tau_0, mu, rows


def number(row, column):
    return float(row[column]) if row and row["exit_code"] == "0" and row[column] else math.nan


def to_finer_cells(mould, tau_0):
    """Spread on half the cells over that on the default ones. Measured for the Abrams cone on 25 runs of 7 to 60 Pa: 1.0 to
    1.1 % below 20 Pa, 0.4 % at 26 to 38 Pa, 0.2 % at 50 to 60 Pa, scatter 0.3 %."""
    if mould != "abrams":
        return 1.0
    return 1.0 + min(0.011, 0.011 * max(0.0, math.log(75.0 / tau_0)) / math.log(75.0 / 15.0))


def filled(line):
    """Values over the viscosity, those that are missing from the nearest on both sides."""
    known = [j for j, value in enumerate(line) if not math.isnan(value)]
    out = list(line)
    for j, value in enumerate(line):
        if math.isnan(value) and known:
            low, high = max((k for k in known if k < j), default=None), min((k for k in known if k > j), default=None)
            ends = [line[k] for k in (low, high) if k is not None]
            out[j] = sum(ends) / len(ends)
    return out


def main():
    tremie, moulds = sys.argv[1], sys.argv[2:] or MOULDS
    for mould in moulds:
        with tempfile.TemporaryDirectory() as folder:
            tau_0, mu, rows = study(tremie, mould, pathlib.Path(folder))
        untrusted = sum(math.isnan(number(row, "spread_mm")) for row in rows.values())
        lines = [f"# Made by tables.py: exact Bingham at rest, no slip, 2400 kg/m3; {len(rows)} runs, {untrusted} of them not to be trusted.",
                 "yield_stress_Pa,plastic_viscosity_Pa_s," + ",".join(COLUMNS)]
        for x in tau_0:
            at = {c: [number(rows.get((x, y)), c) for y in mu] for c in COLUMNS}
            at = {c: line if c == "t500_s" else filled(line) for c, line in at.items()}
            at["spread_mm"] = [spread * to_finer_cells(mould, x) for spread in at["spread_mm"]]
            for j, y in enumerate(mu):
                cells = ["" if math.isnan(at[c][j]) else f"{at[c][j]:.{3 if c == 't500_s' else 2}f}" for c in COLUMNS]
                lines.append(f"{x:g},{y:g}," + ",".join(cells))
        (HERE / f"{mould}.csv").write_text("\n".join(lines) + "\n")
        print(f"{mould}: {len(rows)} runs, {untrusted} not to be trusted", flush=True)


main()
