"""Studies and calibrations, by the program beside the module: they run many scenes in processes of their own."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import tempfile
from pathlib import Path
from typing import Any, Mapping, Optional, Union

from . import _tremie
from ._result import Result, checked, read
from ._values import toml

Definition = Union[str, os.PathLike, Mapping[str, Any]]


def program() -> Path:
    """The program `tremie`: $TREMIE_PROGRAM, the one installed or built with this module, or the one in the path."""
    if named := os.environ.get("TREMIE_PROGRAM"):
        return Path(named)
    for folder in list(Path(_tremie.__file__).absolute().parents)[:6]:
        for file in (folder / "bin" / "tremie", folder / "tremie"):
            if file.is_file() and os.access(file, os.X_OK):
                return file
    if found := shutil.which("tremie"):
        return Path(found)
    raise RuntimeError("the program tremie is not beside this module nor in the path; $TREMIE_PROGRAM names it")


def _call(arguments: list[str]) -> None:
    """Runs the program; an interrupt goes on to it, and it ends first."""
    process = subprocess.Popen([str(program()), *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    try:
        _, message = process.communicate()
    except BaseException:
        process.send_signal(signal.SIGINT)
        process.wait()
        raise
    if process.returncode == 2:
        raise _tremie.InputError(message.strip())
    if process.returncode in (130, -signal.SIGINT):
        raise KeyboardInterrupt
    if process.returncode not in (0, 3):
        raise RuntimeError(message.strip() or f"tremie {arguments[0]} ended with {process.returncode}")


def _file_of(definition: Definition, name: str, folder: Path) -> Path:
    if not isinstance(definition, Mapping):
        return Path(definition)
    file = folder / name
    file.write_text(toml(definition, dotted=False), encoding="utf-8")
    return file


def _run(command: str, definition: Definition, out: Union[str, os.PathLike, None], options: list[str]) -> Result:
    with tempfile.TemporaryDirectory(prefix="tremie-") as scratch:
        file = _file_of(definition, f"{command}.toml", Path(scratch))
        folder = Path(scratch) / "out" if out is None else Path(out)
        _call([command, str(file), "--out", str(folder), "--quiet", *options])
        result = read(folder)
    if out is None:
        result.folder = None
    return checked(result, stacklevel=4)


def _options(jobs: Optional[int], force: bool) -> list[str]:
    return ([] if jobs is None else ["--jobs", str(jobs)]) + (["--force"] if force else [])


def study(
    study: Definition,
    out: Union[str, os.PathLike, None] = None,
    *,
    jobs: Optional[int] = None,
    resume: bool = False,
    force: bool = False,
) -> Result:
    """Runs a scene many times, its keys changed by a design (`tremie study`).

    study   a TOML file, or a dictionary with its keys; `base` in a dictionary is a file or a scene itself
    out     folder for what the program writes; None: a temporary one
    jobs    runs at a time; None: the machine's cores
    resume  go on with a study that was stopped in `out`

    `.rows` has an array a column: the factors as mix.yield_stress_Pa, the results, status, exit_code, reasons. Raises
    InputError as run() does; the warnings are the study's own, a row's reasons stand in its row."""
    with tempfile.TemporaryDirectory(prefix="tremie-") as scratch:
        if isinstance(study, Mapping):
            base = study.get("base")
            study = {**study}
            if isinstance(base, Mapping):
                study["base"] = Path(scratch) / "base.toml"
                study["base"].write_text(toml(base), encoding="utf-8")
            elif base is not None:
                study["base"] = os.path.abspath(base)
        return _run("study", study, out, _options(jobs, force) + (["--resume"] if resume else []))


def calibrate(
    lab: Definition,
    out: Union[str, os.PathLike, None] = None,
    *,
    jobs: Optional[int] = None,
    force: bool = False,
) -> Result:
    """From measurements to the mix (`tremie calibrate`): parameters and forecasts with intervals.

    lab    a TOML file, or a dictionary with its keys; files that a dictionary names are to have absolute paths
    out, jobs, force   as for study()

    `.results["parameters"]` has for each unknown its value, ci95, unit and what the data told ("identified", "bound",
    "not_told"), `.results["forecast"]` the readings asked for."""
    return _run("calibrate", lab, out, _options(jobs, force))
