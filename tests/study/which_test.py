#!/usr/bin/env python3
"""Which tests tell yield stress and viscosity of a mix: which_test.py TREMIE [FOLDER], or which_test.py --chart CSV SVG

Runs each test of a mix, and of mixes a sixth more and less in each parameter, for the sensitivities of its readings. A usual
error of each reading makes them an information matrix (Fisher); that of a pair of tests is the sum. Prints the standard errors
of both parameters, in per cent, by each test and by each pair, with walls that hold and with a layer that slides. Half an hour
of one core."""

import csv
import itertools
import json
import math
import pathlib
import subprocess
import sys
import tempfile

STEP = math.log(7.0 / 6.0)
PRIOR = math.log(10.0)  # standard deviation of the logarithm of a parameter of which nothing is known
MIXES = {"self-compacting": (25.0, 40.0), "tremie": (60.0, 30.0), "stiff": (400.0, 60.0)}  # Pa, Pa s
SLIDES = 'contact = "interface"\ninterface_yield_ratio = 0.5\ninterface_viscosity = "1000 Pa.s/m"\n'

# test: (apparatus, its walls' section, settings, {reading: usual standard error in its unit, or a share of it}, litres)
TESTS = {
    "slump flow": ("slump_flow", "floor", "", {"spread_mm": 15.0, "t500_s": 0.3, "slump_mm": 10.0}, 5.5),
    "L-box": ("l_box", "walls", '[model]\nspace = "plane_with_side_walls"\ncell = "20 mm"\n', {"passing_ratio": 0.03}, 12.0),
    "U-box": ("u_box", "walls", '[model]\ncell = "20 mm"\n', {"rise_mm": 8.0}, 19.0),
    "LCPC box": ("lcpc_box", "walls", '[model]\ncell = ["20 mm", "10 mm"]\n', {"length_mm": 15.0}, 6.0),
    "V-funnel": ("v_funnel", "walls", '[model]\ncell = "8 mm"\n', {"flow_time_s": 0.1}, 10.0),
    "inverted cone": ("inverted_cone", "walls", "", {"flow_time_s": 0.1}, 5.5),
}
SHARES = {"flow_time_s"}


def readings(tremie, folder, test, tau_0, mu, slides):
    apparatus, section, settings, errors, _ = TESTS[test]
    (folder / "scene.toml").write_text(
        f'apparatus = "{apparatus}"\n[mix]\nyield_stress = "{tau_0} Pa"\nplastic_viscosity = "{mu} Pa.s"\n'
        f'density = "2350 kg/m3"\n{settings}[output]\nframes = false\n' + (f"[{section}]\n{SLIDES}" if slides else ""))
    run = subprocess.run([tremie, "run", "scene.toml", "--out", "out", "--force", "--quiet", "--threads", "1"], cwd=folder, capture_output=True)
    if run.returncode not in (0, 3):
        raise SystemExit(run.stderr.decode())
    summary = json.loads((folder / "out/summary.json").read_text())
    values = {name: summary["results"].get(name) for name in errors}
    return {name: value for name, value in values.items() if value is not None}, summary["cost"]["cpu_s"], run.returncode


def information(tremie, folder, test, mix, slides):
    """The 2x2 information of ln tau_0 and ln mu; seconds of the run; readings and exit code at the mix."""
    tau_0, mu = mix
    here, seconds, code = readings(tremie, folder, test, tau_0, mu, slides)
    shifted = [[readings(tremie, folder, test, tau_0 * math.exp(a * s), mu * math.exp(b * s), slides)[0] for s in (-STEP, STEP)]
               for a, b in ((1, 0), (0, 1))]
    matrix = [[0.0, 0.0], [0.0, 0.0]]
    for name, value in here.items():
        error = TESTS[test][3][name] * (value if name in SHARES else 1.0)
        if not all(name in point for pair in shifted for point in pair):
            continue
        slope = [(pair[1][name] - pair[0][name]) / (2 * STEP * error) for pair in shifted]
        for i, j in itertools.product(range(2), range(2)):
            matrix[i][j] += slope[i] * slope[j]
    return matrix, seconds, here, code


def errors(*matrices):
    """Standard errors of ln tau_0 and ln mu, in per cent."""
    a, b, d = (sum(m[i][j] for m in matrices) + (PRIOR**-2 if i == j else 0.0) for i, j in ((0, 0), (0, 1), (1, 1)))
    determinant = a * d - b * b
    return 100 * math.sqrt(d / determinant), 100 * math.sqrt(a / determinant)


LETTERS = dict(zip(TESTS, "SLUBVC"))


def panel(rows, mix, left):
    """Errors of a mix by single tests (rings) and by pairs (dots), with walls that hold; the best five pairs have their letters."""
    side, low, high = 230.0, 3.0, 300.0
    place = lambda error: side * math.log(min(max(error, low), high) / low) / math.log(high / low)
    both = lambda r: (float(r["error_tau_0_percent"]), float(r["error_mu_percent"]))
    mine = sorted((r for r in rows if r["mix"] == mix and r["walls"] == "hold"), key=lambda r: ("+" not in r["tests"], math.hypot(*both(r))))
    svg = [f'<rect x="{left}" y="40" width="{side}" height="{side}" fill="none" stroke="#999"/>',
           f'<text x="{left + side / 2}" y="28" text-anchor="middle" font-weight="bold">{mix}</text>']
    for tick in (3, 10, 30, 100, 300):
        svg.append(f'<text x="{left + place(tick):.0f}" y="286" text-anchor="middle">{tick}</text>')
        if left < 100:
            svg.append(f'<text x="{left - 6}" y="{274 - place(tick):.0f}" text-anchor="end">{tick}</text>')
    dots = [(left + place(both(r)[0]), 270.0 - place(both(r)[1])) for r in mine]
    around = [(reach * math.sin(k * math.pi / 6), reach * math.cos(k * math.pi / 6)) for reach in (13, 20, 28, 38, 50) for k in range(12)]
    names, labels = [], []
    for rank, (r, (x, y)) in enumerate(zip(mine, dots)):
        pair = "+" in r["tests"]
        svg.append(f'<circle cx="{x:.0f}" cy="{y:.0f}" r="4" fill="{"#0067a5" if pair else "#fff"}" stroke="#0067a5"/>')
        if pair and rank >= 5:
            continue
        name = "".join(LETTERS[test] for test in r["tests"].split(" + "))
        free = lambda at: left + 8 < at[0] < left + side - 8 and 48 < at[1] < 262 and all(
            abs(at[0] - a) > 8 + half or abs(at[1] - b) > 9 for points, half in ((dots, 3), (names, 8)) for a, b in points)
        at = next((at for at in ((x + dx, y + dy) for dx, dy in around) if free(at)), (x, y + 13))
        names.append(at)
        labels.append(f'<path d="M{x:.0f} {y:.0f} L{at[0]:.0f} {at[1]:.0f}" stroke="#999" stroke-width="0.6"/>'
                      f'<text x="{at[0]:.0f}" y="{at[1] + 3.5:.0f}" text-anchor="middle" stroke="#fff" stroke-width="3" '
                      f'paint-order="stroke">{name}</text>')
    svg += labels
    svg.append(f'<text x="{left + side / 2}" y="304" text-anchor="middle">error of the yield stress (%)</text>')
    return svg


def chart(table, path):
    rows = list(csv.DictReader(table.read_text().splitlines()))
    parts = [line for i, mix in enumerate(MIXES) for line in panel(rows, mix, 60 + 250 * i)]
    path.write_text('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 800 330" font-family="sans-serif" font-size="10">\n'
                    '<rect width="800" height="330" fill="#fff"/>\n'
                    '<text x="18" y="155" text-anchor="middle" transform="rotate(-90 18 155)">error of the viscosity (%)</text>\n'
                    f'<text x="60" y="324">{", ".join(f"{letter} {test}" for test, letter in LETTERS.items())}; two letters: a pair</text>\n'
                    + "\n".join(parts) + "\n</svg>\n")


def main():
    if sys.argv[1] == "--chart":
        return chart(pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]))
    tremie = str(pathlib.Path(sys.argv[1]).resolve())
    folder = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else tempfile.mkdtemp())
    folder.mkdir(parents=True, exist_ok=True)
    print("mix,walls,tests,error_tau_0_percent,error_mu_percent,litres,cpu_s,readings,exit_codes", flush=True)
    for (mix, values), slides in itertools.product(MIXES.items(), (False, True)):
        known = {}
        for test in TESTS:
            known[test] = information(tremie, folder, test, values, slides)
            print(row(mix, slides, [test], known), flush=True)
        for pair in itertools.combinations(TESTS, 2):
            print(row(mix, slides, pair, known), flush=True)


def row(mix, slides, tests, known):
    tau_0, mu = errors(*(known[test][0] for test in tests))
    told = "; ".join(f"{name} {value:.3g}" for test in tests for name, value in known[test][2].items()) if len(tests) == 1 else ""
    return (f'{mix},{"slide" if slides else "hold"},{" + ".join(tests)},{tau_0:.1f},{mu:.1f},{sum(TESTS[t][4] for t in tests):g},'
            f'{sum(known[t][1] for t in tests):.1f},{told},{" ".join(str(known[t][3]) for t in tests)}')


if __name__ == "__main__":
    main()
