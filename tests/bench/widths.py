"""Explicit steps compiled for each width of registers that this machine has, by g++ and clang: points a second and core, and
the bound that the arithmetic sets.

    tests/bench/widths.py [--levels x86-64-v3,...] [--compilers g++,clang++] [--least-ratio 0.65]

`--least-ratio`: exit code 1 where g++'s points a second are less than so many times clang's."""
import argparse
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
SOURCES = ["tests/bench/points_per_second.cpp", "libmpm/explicit/step.cpp", "libmpm/grid/active_grid.cpp"]
OPTIONS = ["-std=c++20", "-O3", "-DNDEBUG", "-fno-math-errno", "-Wno-psabi", "-fopenmp", "-DEIGEN_DONT_PARALLELIZE", f"-I{ROOT}",
           "-isystem", "/usr/include/eigen3", "-w"]
NEEDS = {"x86-64-v2": {"sse4_2"}, "x86-64-v3": {"avx2", "fma"}, "x86-64-v4": {"avx512f", "avx512vl"}}


def processor():
    lines = Path("/proc/cpuinfo").read_text().splitlines()
    of = {line.split(":")[0].strip(): line.split(":")[1].strip() for line in lines if ":" in line}
    return of.get("model name", "unknown"), set(of.get("flags", "").split())


def build(compiler, level, folder):
    program = Path(folder) / f"{compiler}-{level}"
    subprocess.run([compiler, *OPTIONS, f"-march={level}", *(str(ROOT / s) for s in SOURCES), "-o", program], check=True)
    return program


def measure(programs, rounds=2):
    """Best of rounds, one program after the other in each: what else the machine does meets all of them."""
    best = {}
    for _ in range(rounds):
        for key, program in programs.items():
            for line in subprocess.run([program], capture_output=True, text=True, check=True).stdout.splitlines():
                name, *values = line.split("\t")
                old = best.setdefault(name, {}).setdefault(key, (0.0, 0.0))
                best[name][key] = tuple(max(a, float(b)) for a, b in zip(old, values))
    return best


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    model, flags = processor()
    options.add_argument("--levels", default=",".join(level for level, needs in NEEDS.items() if needs <= flags))
    options.add_argument("--compilers", default="g++,clang++")
    options.add_argument("--least-ratio", type=float, default=0.0)
    given = options.parse_args()
    compilers = given.compilers.split(",")
    with tempfile.TemporaryDirectory() as folder:
        keys = [(level, compiler) for level in given.levels.split(",") for compiler in compilers]
        with ThreadPoolExecutor(2) as pool:
            programs = dict(zip(keys, pool.map(lambda key: build(key[1], key[0], folder), keys)))
        table = measure(programs)
    print(f"{model}; million points a second and core, and the share of the bound\n")
    print("| | " + " | ".join(f"{level}, {compiler}" for level, compiler in programs) + " |")
    print("|---" * (len(programs) + 1) + "|")
    for name, row in table.items():
        cells = (f"{row[key][0] / 1e6:.1f} ({100 * row[key][0] / row[key][1]:.0f} %)" for key in programs)
        print(f"| {name} | " + " | ".join(cells) + " |")
    if given.least_ratio and len(compilers) == 2:
        worst, name = min((row[level, compilers[0]][0] / row[level, compilers[1]][0], name)
                          for name, row in table.items() for level in given.levels.split(","))
        print(f"\n{compilers[0]} has at least {worst:.2f} of {compilers[1]}'s ({name})")
        sys.exit(worst < given.least_ratio)


if __name__ == "__main__":
    main()
