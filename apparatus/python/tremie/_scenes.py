"""Scenes, run in process."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, Callable, Mapping, Optional, Union

from . import _tremie
from ._result import Result, checked
from ._values import set_arguments, toml

#: A scene's file, or the scene itself: {"apparatus": "slump_flow", "mix": "mix_a", "test": {"rest": "240 s"}}.
Scene = Union[str, os.PathLike, Mapping[str, Any]]

#: Called some twenty times a second with the simulated time [s], the duration at most [s], the time step [s] and a
#: reading in words ("spread 412 mm").
Progress = Callable[[float, float, float, str], Any]


def _source(scene: Scene) -> tuple[str, Optional[str]]:
    """The name for messages, and the text where the scene is no file."""
    if isinstance(scene, Mapping):
        return "scene", toml(scene)
    return os.fspath(scene), None


def _result(answer: dict[str, Any], folder: Optional[Path] = None) -> Result:
    return Result(
        json.loads(answer["summary"]),
        timeseries=answer["timeseries"],
        tables=answer["tables"],
        frames=answer["frames"],
        scene=answer["scene"],
        lines=answer["lines"],
        notes=answer["notes"],
        folder=folder,
    )


def run(
    scene: Scene,
    out: Union[str, os.PathLike, None] = None,
    progress: Optional[Progress] = None,
    *,
    threads: Optional[int] = None,
    frames: bool = False,
    force: bool = False,
    **overrides: Any,
) -> Result:
    """Runs a scene: a slump flow, an L-box or a vane.

    scene      a TOML file, or a dictionary with the same keys; quantities are text with units ("54 Pa")
    out        folder for what `tremie run` writes; None: the result stays in memory
    progress   called while the run goes on
    threads    None: as many as pay for the scene's size
    frames     keep the points over time in `.frames`
    force      replace an earlier result in `out`
    overrides  values over the scene's, as `--set` has them, two underscores for a dot: mix__yield_stress="60 Pa"

    Raises InputError for a scene that is not right. A result that is not to be trusted comes with an
    UntrustedWarning. Ctrl-C ends the run between two steps, with nothing written. Other threads of Python go on
    meanwhile."""
    name, text = _source(scene)
    arguments = set_arguments(overrides)
    command = " ".join([f"tremie run {name if text is None else 'scene.toml'}", *(f"--set '{a}'" for a in arguments)])
    answer = _tremie.run(
        name=name,
        text=text,
        overrides=arguments,
        threads=threads or 0,
        frames=frames,
        out="" if out is None else os.fspath(out),
        force=force,
        command=command,
        progress=progress,
    )
    return checked(_result(answer, None if out is None else Path(out)))


def cell(scene: Scene, **overrides: Any) -> Result:
    """The law alone: one material cell at a prescribed shear rate (`apparatus = "cell"`).

    Arguments and errors as for run(). `.timeseries` has time_s, shear_rate_per_s, shear_stress_Pa, flocculation (the
    points' update) and flocculation_reference (CVODE)."""
    name, text = _source(scene)
    return checked(_result(_tremie.cell(name=name, text=text, overrides=set_arguments(overrides))))


def mixes() -> list[str]:
    """The names that `mix = "…"` takes."""
    return _tremie.mixes()
