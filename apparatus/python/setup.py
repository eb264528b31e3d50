"""A wheel by plain setuptools, from a clone of the repository: CMake builds and installs, setuptools packs.

    python3 -m pip wheel apparatus/python --no-deps --no-build-isolation

The programs and the reference data lie in the package. Shared libraries (HDF5, Ceres, SUNDIALS) are those of the machine:
the wheel is for Debian 12 and its like."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = Path(__file__).resolve().parent
SOURCES = HERE.parent.parent
VERSION = re.search(r"project\(tremie VERSION ([0-9.]+)", (SOURCES / "CMakeLists.txt").read_text()).group(1)

LEVELS = ("x86-64-v3", "x86-64-v4")  # of processors, beside any


class BuildByCMake(build_ext):
    def run(self):
        build, prefix = (Path(self.build_temp).resolve() / name for name in ("cmake", "prefix"))
        subprocess.run(
            ["cmake", "-S", SOURCES, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DTREMIE_NATIVE=OFF",
             "-DTREMIE_TESTS=OFF", "-DTREMIE_PICTURES=OFF", "-DTREMIE_PYTHON=ON", f"-DPython_EXECUTABLE={sys.executable}",
             "-DTREMIE_PYTHON_FOLDER=python", f"-DTREMIE_LEVELS={';'.join(LEVELS)}", *os.environ.get("CMAKE_ARGS", "").split()],
            check=True)
        jobs = str(os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", os.cpu_count() or 1))
        subprocess.run(["cmake", "--build", build, "-j", jobs, "--target", "tremie", "tremie_python",
                        *(f"tremie_{level}" for level in LEVELS)], check=True)
        # The rest of what the project installs (man pages, headers) is for a system, not for a wheel.
        subprocess.run(["cmake", "--install", build, "--prefix", prefix, "--component", "python", "--strip"], check=True)
        package = (HERE if self.inplace else Path(self.build_lib).resolve()) / "tremie"
        shutil.copytree(prefix / "python" / "tremie", package, dirs_exist_ok=True)
        (package / "bin").mkdir(exist_ok=True)
        for program in ("tremie", "tremie-study"):
            if (build / program).exists():
                shutil.copy(build / program, package / "bin")
            for level in LEVELS:
                if (build / "levels" / level / program).exists():
                    (package / "lib" / "tremie" / level).mkdir(parents=True, exist_ok=True)
                    shutil.copy(build / "levels" / level / program, package / "lib" / "tremie" / level)
        shutil.copytree(SOURCES / "reference_data", package / "share" / "tremie" / "reference_data", dirs_exist_ok=True)


setup(
    version=VERSION,
    packages=["tremie"],
    ext_modules=[Extension("tremie._tremie", [])],
    cmdclass={"build_ext": BuildByCMake},
)
