"""The same scenes by two programs: every number of their results agrees to 1e-6, which is what sums in another order may
change. tests/two_compilers.py PROGRAM PROGRAM"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

SCENES = Path(__file__).parent.parent / "apparatus/scenes"
SHORT = {
    "slump flow, section": ("slump_flow_mix_c.toml", ["model.cell=20 mm", "test.duration=3 s"]),
    "slump flow, quarter": ("slump_flow_mix_a_quarter.toml", ["model.cell=30 mm", "test.duration=0.5 s"]),
    "slump flow, explicit": ("paper_mix_a.toml", ["model.cell=40 mm", "test.duration=0.02 s"]),
    "L-box with side walls": ("l_box_mix_a.toml", ["model.cell=20 mm", "test.duration=1 s", "model.space=plane_with_side_walls"]),
    "L-box with bars": ("l_box.toml", ["model.cell=30 mm", "test.duration=0.2 s", "model.space=half", "test.bars=2"]),
    "LCPC box": ("lcpc_box.toml", ["model.cell=25 mm", "test.duration=2 s", "test.pour_time=1 s"]),
    "vane, plane": ("icar_vane_mix_a.toml", ["model.cell=10 mm", "test.duration=0.5 s"]),
    "vane with ends": ("icar_vane_mix_a.toml", ["model.cell=20 mm", "model.space=cylindrical", "mix.thixotropy=false"]),
    "cell": ("cell_hysteresis_loop.toml", []),
}


def results(program, scene, settings, folder):
    options = [part for one in settings for part in ("--set", one)]
    command = "cell" if scene.startswith("cell") else "run"
    run = subprocess.run([program, command, SCENES / scene, "--out", folder, "--quiet", *options], capture_output=True, text=True)
    if run.returncode not in (0, 3):  # 3: coarse cells, which the program says
        sys.exit(f"{program} {scene}: exit {run.returncode}\n{run.stderr[-4000:]}")
    return json.loads((folder / "summary.json").read_text())["results"]


def numbers(value, name=""):
    if isinstance(value, dict):
        for key, one in value.items():
            yield from numbers(one, f"{name}.{key}")
    elif isinstance(value, list):
        for i, one in enumerate(value):
            yield from numbers(one, f"{name}[{i}]")
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield name, float(value)


def main(programs):
    worst = 0.0
    for title, (scene, settings) in SHORT.items():
        with tempfile.TemporaryDirectory() as folder:
            a, b = (dict(numbers(results(p, scene, settings, Path(folder) / str(i)))) for i, p in enumerate(programs))
        if a.keys() != b.keys() or not a:
            sys.exit(f"{title}: results differ: {sorted(a.keys() ^ b.keys())}")
        difference, name = max((abs(a[k] - b[k]) / max(abs(a[k]), abs(b[k]), 1e-6), k) for k in a)
        worst = max(worst, difference)
        print(f"{title}: {len(a)} numbers, largest difference {difference:.1e} ({name[1:]})")
    sys.exit(worst > 1e-6)


if __name__ == "__main__":
    main(sys.argv[1:3])
