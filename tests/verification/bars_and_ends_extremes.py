"""Stiff and extreme cases of the L-box with bars and of the vane with ends: tests/verification/bars_and_ends_extremes.py
PROGRAM [FIRST] prints the tables of docs/extremes.md, the box's from row FIRST on; some ten minutes of one core."""
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

SCENES = Path(__file__).parents[2] / "apparatus/scenes"
BOX = ("l_box.toml", {"model.space": "half", "test.bars": 2, "test.duration": "4 s"})
ENDS = ("icar_vane_mix_a.toml", {"model.space": "cylindrical", "mix.thixotropy": "false", "test.duration": "1 s"})
# Name: what is changed.
CASES = {
    "as it is": {},
    "K = 2 GPa": {"mix.bulk_modulus": "2 GPa"},
    "τ0 = 0": {"mix.yield_stress": "0 Pa"},
    "τ0 = 5000 Pa": {"mix.yield_stress": "5000 Pa"},
    "μ = 0.01 Pa·s": {"mix.plastic_viscosity": "0.01 Pa.s"},
    "μ = 1000 Pa·s": {"mix.plastic_viscosity": "1000 Pa.s"},
    "τ0 = 0, μ = 0.01 Pa·s, K = 2 GPa, 1 s": {"mix.yield_stress": "0 Pa", "mix.plastic_viscosity": "0.01 Pa.s", "mix.bulk_modulus": "2 GPa", "test.duration": "1 s"},
    "τ0 = 5000 Pa, μ = 0.01 Pa·s": {"mix.yield_stress": "5000 Pa", "mix.plastic_viscosity": "0.01 Pa.s"},
    "τ0 = 5000 Pa, μ = 1000 Pa·s, K = 2 GPa": {"mix.yield_stress": "5000 Pa", "mix.plastic_viscosity": "1000 Pa.s", "mix.bulk_modulus": "2 GPa"},
}


def run(program, scene, settings):
    with tempfile.TemporaryDirectory() as folder:
        options = [part for key, value in settings.items() for part in ("--set", f"{key}={value}")]
        done = subprocess.run([program, "run", SCENES / scene, "--out", f"{folder}/o", "--quiet", "--threads", "1", "--set", "output.frames=false",
                               *options], capture_output=True, text=True)
        file = Path(folder) / "o/summary.json"
        return done.returncode, json.loads(file.read_text()) if file.exists() else None, done.stderr.strip()


def text(value, digits=4):
    return "" if value is None else f"{value:.{digits}g}" if isinstance(value, float) else str(value)


def rows(program, title, base, columns, first):
    scene, common = base
    print(f"\n{title}\n\n| case | exit | {' | '.join(columns)} | volume % | CPU s | reasons |\n|{'---|' * (len(columns) + 5)}")
    for name, changed in list(CASES.items())[first:]:
        code, summary, error = run(program, scene, common | changed)
        if summary is None:
            print(f"| {name} | {code} | {error} |", flush=True)
            continue
        results, checks = summary["results"], summary["checks"]
        cells = [text(results.get(c)) for c in columns]
        volume = checks.get("volume_change")
        print(f"| {name} | {code} | {' | '.join(cells)} | {text(None if volume is None else 100 * volume, 2)} "
              f"| {summary['cost']['cpu_s']:.0f} | {'; '.join(checks['reasons'])} |", flush=True)


def main(program, first=0):
    rows(program, "L-box, half, two bars, after 4 s", BOX, ["front_mm", "h1_mm", "t200_s", "t400_s"], first)
    rows(program, "Vane with ends", ENDS, ["torque_end_N_m", "end_factor"], 0)


if __name__ == "__main__":
    main(sys.argv[1], *map(int, sys.argv[2:3]))
