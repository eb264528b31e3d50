"""A result: of a run, a fit, a study or a calibration, in memory or from its folder."""

from __future__ import annotations

import csv
import json
import os
import warnings
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Iterable, Optional, Union

import numpy as np

from ._tremie import InputError

Columns = dict[str, np.ndarray]


class UntrustedWarning(UserWarning):
    """A result that is not to be trusted, and why (the program's exit code 3)."""


@dataclass
class Result:
    """What a run left. Keys and columns bear their units: `result["spread_mm"]`, `result.timeseries["time_s"]`."""

    #: summary.json: "results", "checks", "cost"
    summary: dict[str, Any]
    #: the curves over time, a column each (a fit: empty)
    timeseries: Columns = field(default_factory=dict)
    #: other tables by file name: "profile.csv", "fit.csv", "study.csv"
    tables: dict[str, Columns] = field(default_factory=dict)
    #: the points over time where they were asked for: "time_s", "position_m" (n, 3), "velocity_m_per_s" (n, 3),
    #: "volume_m3", "pressure_Pa", "shear_rate_per_s", "flocculation" (None without thixotropy); of a pile "age_s" and "load"
    frames: list[dict[str, Any]] = field(default_factory=list)
    #: the resolved scene as TOML, every value in SI
    scene: str = ""
    #: the result for a person, a line each
    lines: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    #: the result's folder; None: in memory alone
    folder: Optional[Path] = None

    @property
    def results(self) -> dict[str, Any]:
        """The numbers, with units in their names; None for what does not apply."""
        return self.summary["results"]

    @property
    def reasons(self) -> list[str]:
        """Why the result is not to be trusted; empty: it is."""
        return self.summary.get("checks", {}).get("reasons", [])

    @property
    def rows(self) -> Columns:
        """The rows of a study, a column each."""
        return self.tables["study.csv"]

    @property
    def h5(self):
        """results.h5, opened to be read by h5py; the caller closes it."""
        if self.folder is None:
            raise InputError("results.h5 lies in a folder: run with out=…")
        try:
            import h5py
        except ImportError:
            raise InputError("results.h5 is read by h5py, which is not installed here (python3-h5py)") from None
        return h5py.File(self.folder / "results.h5", "r")

    def __getitem__(self, name: str) -> Any:
        try:
            return self.results[name]
        except KeyError:
            raise KeyError(f"there is no result {name!r}; there are: {', '.join(self.results)}") from None

    def __repr__(self) -> str:
        head = f"<tremie.Result of {self.summary.get('apparatus', '?')}: {self.summary.get('status', '?')}>"
        reasons = [f"not to be trusted: {reason}" for reason in self.reasons]
        return "\n".join([head, *reasons, *(self.lines or _told(self.results)), *self.notes])


def _told(results: dict[str, Any]) -> list[str]:
    """The values of a fit, an estimate or a calibration, a line each, with their 95 % intervals."""
    lines = []
    for name, told in results.items():
        if not isinstance(told, dict):
            continue
        if isinstance(told.get("value"), (int, float)):
            interval = told.get("ci95")
            line = f"{name} {told['value']:.4g}" + (f" [{interval[0]:.4g}, {interval[1]:.4g}]" if interval else "")
            lines.append(f"{line} {told['unit']}" if told.get("unit") else line)
        else:
            lines += _told(told)
    return lines


def checked(result: Result, stacklevel: int = 3) -> Result:
    """The result, with a warning where it is not to be trusted."""
    for reason in result.reasons:
        warnings.warn(reason, UntrustedWarning, stacklevel=stacklevel)
    return result


def _number(text: str) -> float:
    return float(text) if text else float("nan")


def columns(lines: Iterable[str]) -> Columns:
    """The columns of CSV text: numbers as floats (an empty field is not-a-number), a column with words as strings."""
    header, *rows = list(csv.reader(line for line in lines if not line.startswith("#"))) or [[]]
    found = {}
    for name, values in zip(header, zip(*rows) if rows else [()] * len(header)):
        try:
            found[name] = np.array([_number(v) for v in values])
        except ValueError:
            found[name] = np.array(values, dtype=str)
    return found


def read_columns(file: Path) -> Columns:
    """A CSV file, as columns()."""
    with open(file, newline="", encoding="utf-8") as stream:
        return columns(stream)


def read(folder: Union[str, os.PathLike]) -> Result:
    """A result folder of any command of the program.

    Series and tables come as arrays; `read(DIR).h5` opens results.h5. Raises InputError where the folder holds no
    result. A result that is not to be trusted says so in `.reasons`, without a warning."""
    folder = Path(folder)
    try:
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    except (OSError, json.JSONDecodeError) as error:
        raise InputError(f"{folder}: holds no result of tremie: {error}") from None
    if summary.get("schema", 1) != 1:
        raise InputError(f"{folder}: summary.json has schema {summary['schema']}; this module reads 1")
    tables = {file.name: read_columns(file) for file in sorted(folder.glob("*.csv"))}
    scene = folder / "scene.toml"
    return Result(
        summary,
        timeseries=tables.pop("timeseries.csv", {}),
        tables=tables,
        scene=scene.read_text(encoding="utf-8") if scene.exists() else "",
        folder=folder,
    )
