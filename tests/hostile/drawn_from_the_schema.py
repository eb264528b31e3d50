"""Random scenes drawn from what `tremie new` prints, and nothing else of the program: every quantity log-uniformly around its
default in any of its units, every choice among its words, cells that a user would take. Each run is judged: right (within
5 % of the same on cells of two thirds, or 10 % for a time), told (code 3), refused (code 2), slow (stopped), or silent.

    python3 drawn_from_the_schema.py TREMIE SEED SECONDS [APPARATUS ...]
"""

import json
import math
import pathlib
import random
import re
import subprocess
import sys
import tempfile
import time

LINE = re.compile(r'^(?P<off># )?(?P<key>\w+) = (?P<value>"[^"]*"|[\d.eE+-]+|true|false)\s+# (?P<says>.*)$')
SI = {"Pa": 1, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "Pa.s": 1, "Pa·s": 1, "Pa s": 1, "mPa.s": 1e-3, "mPa·s": 1e-3,
      "kg/m3": 1, "kg/m³": 1, "kg/m^3": 1, "g/cm3": 1e3, "t/m3": 1e3, "m": 1, "cm": 0.01, "mm": 1e-3, "s": 1, "ms": 1e-3,
      "min": 60, "h": 3600, "m/s": 1, "cm/s": 0.01, "mm/s": 1e-3, "1/s": 1, "/s": 1, "s^-1": 1, "1/min": 1 / 60,
      "Pa/s": 1, "Pa/min": 1 / 60, "kPa/s": 1e3, "Pa.s/m": 1, "Pa·s/m": 1, "Pa s/m": 1}
# How far from its default a key is drawn, in decades; all others half of one.
REACH = {"mix.yield_stress": 2.0, "mix.plastic_viscosity": 2.0, "test.lift_speed": 1.5, "test.gate_speed": 2.5,
         "test.rest": 1.5, "test.duration": 0.7, "mix.density": 0.1, "mix.bulk_modulus": 1.0}
KEPT = {"model.scheme", "model.precision", "model.shape", "model.pressure", "test.bars", "output.frames",
        "output.frame_interval", "output.checkpoint_interval", "model.time_step", "model.method"}
SPACES = {"slump_flow": ["axisymmetric"], "l_box": ["plane", "plane_with_side_walls"]}
READ = {"slump_flow": ["spread_mm"], "l_box": ["h1_mm", "h2_mm"]}
CELL = {"slump_flow": 0.1, "l_box": 0.1}  # the body's own length: cells are a tenth to a third of it [m]


def keys_of(tremie, apparatus):
    text = subprocess.run([tremie, "new", apparatus], capture_output=True, text=True, check=True).stdout
    section, keys = "", []
    for line in text.splitlines():
        if line.startswith("["):
            section = line.strip("[]") + "."
        elif (found := LINE.match(line)) and section:
            keys.append((section + found["key"], found["off"] is not None, found["value"].strip('"'), found["says"]))
    return keys


def quantity(rng, name, value, says):
    """A number with a unit, or without one, near the default; none where the default is a word."""
    parts = value.split(" ", 1)
    if not re.fullmatch(r"[\d.eE+-]+", parts[0]) or float(parts[0]) == 0.0:
        return None
    drawn = float(parts[0]) * 10.0 ** (
        REACH.get(name, 0.5) * rng.uniform(-1, 1))
    if len(parts) == 1:
        return f"{drawn:.4g}" if "." in value or drawn != round(drawn) else value
    if parts[1] not in SI:
        return f'"{drawn:.4g} {parts[1]}"'
    units = [u.strip() for u in says.rsplit(", in ", 1)[-1].split(", with ")[0].split(",")]
    unit = rng.choice([u for u in units if u in SI] or [parts[1]])
    return f'"{drawn * SI[parts[1]] / SI[unit]:.6g} {unit}"'


def draw(rng, apparatus, keys):
    chosen = {"model.space": f'"{rng.choice(SPACES[apparatus])}"'}
    thixotropic = rng.random() < 0.3
    for name, off, value, says in keys:
        if off or name in KEPT or name == "model.space" or name.startswith("measured."):
            continue
        if name.startswith("mix.thixotropy.") and (not thixotropic or "kinetics = " in says or "by the keys" in says):
            continue
        needed = "needed" in says and (thixotropic or not name.startswith("mix.thixotropy."))
        if not needed and rng.random() < 0.6:
            continue
        words = re.findall(r'"([\w]+)"', says)
        if words and (number := quantity(rng, name, value, says)) is None:
            chosen[name] = f'"{rng.choice(words)}"'
        elif words and rng.random() < 0.2:
            chosen[name] = f'"{rng.choice(words)}"'
        elif number := quantity(rng, name, value, says):
            chosen[name] = number
    cell = [CELL[apparatus] * 10.0 ** rng.uniform(-1.0, -0.5), CELL[apparatus] * 10.0 ** rng.uniform(-1.0, -0.5)]
    return chosen, cell


def run(tremie, apparatus, chosen, cell, folder, limit):
    sets = [f"--set={k}={v}" for k, v in chosen.items()] + [f"--set=model.cell={json.dumps([f'{c:.5g} m' for c in cell])}"]
    scene = folder / "scene.toml"
    scene.write_text(f'apparatus = "{apparatus}"\nmix = {{yield_stress = "54 Pa", plastic_viscosity = "35.8 Pa.s"}}\n')
    command = [tremie, "run", str(scene), "--quiet", "--force", "--threads", "1", "--out", str(folder / "out")] + sets
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return "slow", {}, ""
    if done.returncode == 2:
        return "refused", {}, done.stderr.strip().splitlines()[0]
    if done.returncode not in (0, 3):
        return "crashed", {}, f"{done.returncode}: {done.stderr[-200:]}"
    summary = json.loads((folder / "out/summary.json").read_text())
    return ("told" if done.returncode == 3 else "right"), summary["results"], "; ".join(summary["checks"]["reasons"])


def judged(tremie, apparatus, chosen, cell, folder):
    verdict, results, why = run(tremie, apparatus, chosen, cell, folder, 60)
    if verdict != "right":
        return verdict, why
    finer_verdict, finer, why = run(tremie, apparatus, chosen, [c / 1.5 for c in cell], folder, 120)
    if finer_verdict not in ("right", "told"):
        return "right", f"finer cells: {finer_verdict}"
    for key in READ[apparatus]:
        a, b = results.get(key), finer.get(key)
        if a is None or b is None or not (math.isfinite(a) and math.isfinite(b)):
            continue
        if abs(a - b) > max(0.05 * abs(b), 3.0):
            if finer_verdict == "told":  # finer cells are no judge
                return "unclear", f"{key} {a:.4g}, on finer cells {b:.4g}, which say: {why}"
            return "silent", f"{key} {a:.4g}, on cells of two thirds {b:.4g}"
    return "right", ""


def main():
    tremie, seed, seconds = sys.argv[1], int(sys.argv[2]), float(sys.argv[3])
    rng, counts, end = random.Random(seed), {}, time.time() + seconds
    names = sys.argv[4:] or list(READ)
    keys = {name: keys_of(tremie, name) for name in names}
    with tempfile.TemporaryDirectory() as folder:
        while time.time() < end:
            apparatus = rng.choice(names)
            chosen, cell = draw(rng, apparatus, keys[apparatus])
            verdict, why = judged(tremie, apparatus, chosen, cell, pathlib.Path(folder))
            counts[verdict] = counts.get(verdict, 0) + 1
            if verdict not in ("right", "told", "slow"):
                print(verdict, apparatus, chosen, [f"{1e3 * c:.3g} mm" for c in cell], why, flush=True)
    print(counts)
    return 1 if counts.get("silent") or counts.get("crashed") else 0


if __name__ == "__main__":
    sys.exit(main())
