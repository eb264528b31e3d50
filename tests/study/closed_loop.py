"""Closed loop of `tremie calibrate`: mixes drawn here, their slump flows run on finer cells than the calibration's, noise
added, calibrated on coarser ones. How many of the 95 % intervals hold the truth?

python3 closed_loop.py TREMIE [MIXES] [FOLDER] [three]       (default: 50 mixes; prints a CSV row a mix, then the coverage)

`three`: an L-box with side walls and an inverted cone besides the slump flow.
"""

import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

RANGES = {"mix.yield_stress": (30.0, 120.0, "Pa"), "mix.plastic_viscosity": (15.0, 80.0, "Pa.s")}
SPREAD_ERROR, T500_ERROR = 15.0, 0.3
TRUTH, CALIBRATION = ("10 mm", "5 mm"), ("15 mm", "7.5 mm")  # cells, across and up

# Further tests: scene, cells of the truth and of the calibration, reading in results and in [[measured]], error.
FURTHER = [
    ("l_box", '[model]\nspace = "plane_with_side_walls"\n', "20 mm", "25 mm", "passing_ratio", "passing_ratio", 0.03, ""),
    ("inverted_cone", "[model]\n", "4.5 mm", "6 mm", "flow_time_s", "flow_time", 0.08, " s"),
]


def cells(pair):
    return '["{}", "{}"]'.format(*pair)


def draw(random_numbers):
    return {
        key: low * (high / low) ** random_numbers.uniform(0.0, 1.0) for key, (low, high, _) in RANGES.items()
    }


def run_truth(tremie, folder, truth):
    settings = [f"--set={key}={truth[key]} {unit}" for key, (_, _, unit) in RANGES.items()]
    (folder / "truth.toml").write_text('apparatus = "slump_flow"\nmix = "mix_a"\n')
    subprocess.run(
        [tremie, "run", "truth.toml", "--out", "truth", "--force", "--quiet", "--threads", "1",
         "--set=mix.thixotropy=false", f"--set=model.cell={cells(TRUTH)}", *settings],
        cwd=folder, check=True)  # fmt: skip
    results = json.loads((folder / "truth/summary.json").read_text())["results"]
    return results["spread_mm"], results["t500_s"]


def run_further(tremie, folder, truth):
    """Readings of the further tests, or nothing where one has none."""
    readings = []
    for apparatus, model, cell, _, result, *_ in FURTHER:
        mix = f'yield_stress = "{truth["mix.yield_stress"]} Pa"\nplastic_viscosity = "{truth["mix.plastic_viscosity"]} Pa.s"\n'
        (folder / "truth.toml").write_text(
            f'apparatus = "{apparatus}"\n[mix]\ndensity = "2400 kg/m3"\n{mix}{model}cell = "{cell}"\n')
        subprocess.run([tremie, "run", "truth.toml", "--out", "truth", "--force", "--quiet", "--threads", "1"], cwd=folder)
        readings.append(json.loads((folder / "truth/summary.json").read_text())["results"][result])
    return readings


def measured_further(readings):
    lab = ""
    for (apparatus, model, _, cell, _, name, error, unit), value in zip(FURTHER, readings):
        if value is not None:
            space = '"model.space" = "plane_with_side_walls"\n' if "space" in model else ""
            number, half = (f'"{value}{unit}"', f'"{error}{unit}"') if unit else (value, error)
            lab += (f'[[measured]]\napparatus = "{apparatus}"\n{name} = {number}\n{name}_error = {half}\n'
                    f'"model.cell" = "{cell}"\n{space}')
    return lab


def calibrate(tremie, folder, spread, t500, further=""):
    lab = f'[[measured]]\napparatus = "slump_flow"\nspread = "{spread} mm"\nspread_error = "{SPREAD_ERROR} mm"\n'
    if t500:
        lab += f't500 = "{t500} s"\nt500_error = "{T500_ERROR} s"\n'
    if further:
        lab += f'"model.cell" = {cells(CALIBRATION)}\n' + further
    lab += "[unknown]\n"
    for key, (low, high, unit) in RANGES.items():
        lab += f'"{key}" = ["{low} {unit}", "{high} {unit}"]\n'
    lab += '[known]\n"mix.density" = "2400 kg/m3"\n' + ("" if further else f'"model.cell" = {cells(CALIBRATION)}\n')
    (folder / "lab.toml").write_text(lab)
    ended = subprocess.run(
        [tremie, "calibrate", "lab.toml", "--out", "cal", "--force", "--quiet", "--jobs", "1"],
        cwd=folder, capture_output=True)  # fmt: skip
    if ended.returncode not in (0, 3):
        raise RuntimeError(ended.stderr.decode())
    return ended.returncode, json.loads((folder / "cal/summary.json").read_text())["results"]["parameters"]


def loop(tremie, mixes, folder, three=False):
    folder.mkdir(parents=True, exist_ok=True)
    random_numbers = random.Random(11)
    held, told, untrusted = 0, 0, 0
    print("mix,key,truth,low,value,high,held,exit_code", flush=True)
    for mix in range(mixes):
        truth = draw(random_numbers)
        spread, t500 = run_truth(tremie, folder, truth)
        noise = random_numbers.gauss(0.0, SPREAD_ERROR), random_numbers.gauss(0.0, T500_ERROR)
        measured = spread + noise[0], t500 + noise[1] if t500 and t500 + noise[1] > 0.1 else None
        further = [value and value + random_numbers.gauss(0.0, test[6])
                   for test, value in zip(FURTHER, run_further(tremie, folder, truth))] if three else []
        code, parameters = calibrate(tremie, folder, *measured, measured_further(further))
        untrusted += code == 3
        for key, value in truth.items():
            low, high = parameters[key]["ci95"]
            held += low <= value <= high
            told += 1
            print(f"{mix},{key},{value:.2f},{low:.2f},{parameters[key]['value']:.2f},{high:.2f},"
                  f"{int(low <= value <= high)},{code}", flush=True)  # fmt: skip
    share = held / told
    error = math.sqrt(share * (1.0 - share) / told)
    print(f"# coverage {100 * share:.1f} % ± {100 * error:.1f} of {told} intervals; exit 3: {untrusted} of {mixes}")
    return share


if __name__ == "__main__":
    program = str(pathlib.Path(sys.argv[1]).resolve())
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 50
    with tempfile.TemporaryDirectory() as temporary:
        coverage = loop(program, count, pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else temporary), "three" in sys.argv)
    sys.exit(0 if 0.88 <= coverage <= 0.99 or count < 20 else 1)
