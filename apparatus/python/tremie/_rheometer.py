"""The rheometer: parameters from torques and back, the flocculation state, a mix from its slump flow.

Every quantity is a number in SI units, or text with a unit."""

from __future__ import annotations

import inspect
import json
import os
from dataclasses import dataclass
from typing import Any, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _tremie
from ._result import Result, checked, columns
from ._values import Quantity, bare, numbers, positive, si


def _instrument(vane_radius: Quantity, vane_height: Quantity, container_radius: Quantity) -> Any:
    return _tremie.Instrument(
        vane_radius=positive("vane_radius", vane_radius, "m"),
        vane_height=positive("vane_height", vane_height, "m"),
        container_radius=positive("container_radius", container_radius, "m"),
    )


def _readings(name: str, values: ArrayLike, torque: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    x, T = numbers(name, values, "s" if name == "t" else "rad/s"), numbers("torque", torque, "N.m")
    if x.ndim != 1 or x.shape != T.shape:
        raise _tremie.InputError(f"{name} and torque: two arrays of one length; these have the shapes {x.shape}, {T.shape}")
    for what, array in ((name, x), ("torque", T)):
        if not (np.isfinite(array).all() and (array >= 0.0).all()):
            raise _tremie.InputError(f"{what}: every value must be finite and not negative")
    if name == "t" and (np.diff(x) < 0.0).any():
        raise _tremie.InputError("t: the times must not run backwards")
    return x, T


def _optional(name: str, value: Optional[Quantity], unit: str) -> Optional[float]:
    return None if value is None else positive(name, value, unit)


def _option(name: str, value: Any) -> Any:
    """As C++ takes it: text, a flag or a number."""
    return value if value is None or isinstance(value, (str, bool)) else bare(name, value, "number, nor text with a unit")


def _records(t: Any) -> Optional[list[str]]:
    """Files, where `t` is one or several."""
    several = t if isinstance(t, (list, tuple)) else [t]
    return [os.fspath(name) for name in several] if several and all(isinstance(n, (str, os.PathLike)) for n in several) else None


def fit(
    t: Union[ArrayLike, str, os.PathLike, Sequence[Union[str, os.PathLike]], None] = None,
    torque: Optional[ArrayLike] = None,
    *,
    speeds: Optional[ArrayLike] = None,
    **options: Any,
) -> Result:
    """Material parameters, each with its 95 % interval, from a torque record.

    fit(t, torque, speed=…)         a decay at constant speed: times [s], torques [N m]
    fit(speeds=…, torque=…)         a flow curve: speeds [rad/s], torques [N m]
    fit("record.csv")               a file, as the program `tremie fit` reads it; several files are replicates

    It takes what `tremie fit` takes, a quantity as text with a unit or as a number in the unit in brackets:

{options}
    `.results` has the keys of the program's summary.json (yield_stress_Pa: value and ci95, or None where it is not
    identifiable), `.tables["fit.csv"]` the readings beside the fitted torques ("fit_1.csv", … of replicates, "sections.csv"
    of a protocol, "sections_1.csv", … of several)."""
    unknown = [name for name in options if name not in _OPTIONS]
    if unknown:
        raise TypeError(f"fit() got an unexpected keyword argument {unknown[0]!r}; it takes {', '.join(_OPTIONS)}")
    given = {name: _option(name, value) for name, value in options.items()}
    files = _records(t) if torque is None and speeds is None else None
    if files:
        answer = _tremie.fit_files(files, given)
    elif (t is None) == (speeds is None) or torque is None:
        raise _tremie.InputError("fit: takes (t, torque), (speeds=…, torque=…) or files")
    elif given.get("protocol"):
        raise _tremie.InputError("protocol: reads a file with time, speed and torque")
    elif t is not None:
        answer = _tremie.fit(True, *_readings("t", t, torque), given)
    else:
        answer = _tremie.fit(False, *_readings("speeds", speeds, torque), given)
    results, curves = json.loads(answer["results"]), answer["curves"]
    tables = {f"fit_{i}.csv" if len(curves) > 1 else "fit.csv": curve for i, curve in enumerate(curves, 1)}
    sections = answer["sections"]
    for i, text in enumerate(sections, 1):
        tables[f"sections_{i}.csv" if len(sections) > 1 else "sections.csv"] = columns(text.splitlines())
    summary = {"apparatus": "fit", "status": "completed", "results": results, "checks": {"reasons": answer["reasons"]}}
    return checked(Result(summary, tables=tables, notes=results.get("notes", [])))


#: The rows of the program's table of options, by name.
_OPTIONS = {row["name"]: row for row in _tremie.fit_options()}


def _line(row: dict[str, Any]) -> str:
    kind = f"[{row['unit']}]" if row["unit"] else ", ".join(f'"{word}"' for word in row["words"]) or ("True or False" if row["flag"] else "text")
    return f"    {row['name']:<22}{row['help']}; {kind}\n"


fit.__doc__ = (fit.__doc__ or "").replace("{options}\n", "".join(map(_line, _OPTIONS.values())) + "\n")
fit.__signature__ = inspect.Signature(
    [p for p in inspect.signature(fit).parameters.values() if p.name != "options"]
    + [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None) for name in _OPTIONS]
)


@dataclass
class CouetteFlow:
    """Torque [N m] at each speed, and how far from the axis the material is sheared [m]."""

    torque: np.ndarray
    sheared_radius: np.ndarray


def reiner_riwlin(
    speed: ArrayLike,
    *,
    yield_stress: Quantity,
    plastic_viscosity: Quantity,
    vane_radius: Quantity = "63.5 mm",
    vane_height: Quantity = "127 mm",
    container_radius: Quantity = "143 mm",
) -> CouetteFlow:
    """Torques of a Bingham material (yield_stress [Pa], plastic_viscosity [Pa s]) between vane and container at the
    speeds [rad/s], the plug solved for."""
    instrument = _instrument(vane_radius, vane_height, container_radius)
    omega = numbers("speed", speed, "rad/s")
    torque, radius = _tremie.torques(
        si("yield_stress", yield_stress, "Pa"), si("plastic_viscosity", plastic_viscosity, "Pa.s"), omega.ravel(), instrument
    )
    return CouetteFlow(torque.reshape(omega.shape), radius.reshape(omega.shape))


def reiner_riwlin_speed(
    torque: ArrayLike,
    *,
    yield_stress: Quantity,
    plastic_viscosity: Quantity,
    vane_radius: Quantity = "63.5 mm",
    vane_height: Quantity = "127 mm",
    container_radius: Quantity = "143 mm",
) -> np.ndarray:
    """The inverse of reiner_riwlin(): speeds [rad/s] that the torques [N m] drive; 0 where nothing yields."""
    instrument = _instrument(vane_radius, vane_height, container_radius)
    T = numbers("torque", torque, "N.m")
    tau_0, mu = si("yield_stress", yield_stress, "Pa"), si("plastic_viscosity", plastic_viscosity, "Pa.s")
    return _tremie.speeds(tau_0, mu, T.ravel(), instrument).reshape(T.shape)


def _segments(history: Sequence[Sequence[Quantity]]) -> list[list[float]]:
    segments = []
    for number, piece in enumerate(history):
        if len(piece) not in (2, 3):
            raise _tremie.InputError(f"history[{number}]: (duration, shear rate) or (duration, from, to)")
        duration, *rates = piece
        rates = [si(f"history[{number}]", rate, "1/s") for rate in rates]
        segments.append([si(f"history[{number}]", duration, "s"), rates[0], rates[-1]])
    return segments


def flocculation(
    times: ArrayLike,
    history: Sequence[Sequence[Quantity]],
    *,
    yield_stress: Quantity,
    structuration_rate: Quantity,
    destructuration: float,
    kinetics: str = "gated",
    critical_shear_rate: Quantity = "0.1 1/s",
    initial: float = 0.0,
    exponent: float = 1.0,
    saturation: Optional[float] = None,
) -> np.ndarray:
    """The flocculation state lambda at `times` [s], ascending, by CVODE to 1e-13.

    history             pieces (duration [s], shear rate [1/s]) or (duration, from, to), linear in between
    yield_stress        dynamic, tau_0 [Pa]
    structuration_rate  A_thix [Pa/s];  destructuration: alpha;  initial: lambda at time 0
    kinetics            "gated", "roussel" or "power" (then exponent n, saturation lambda_max or None for none)"""
    thixotropy = _tremie.Thixotropy(
        A_thix=si("structuration_rate", structuration_rate, "Pa/s"),
        alpha=bare("destructuration", destructuration),
        kinetics=kinetics,
        gamma_c=si("critical_shear_rate", critical_shear_rate, "1/s"),
        exponent=bare("exponent", exponent),
        saturation=None if saturation is None else bare("saturation", saturation),
    )
    at = np.atleast_1d(numbers("times", times, "s"))
    return _tremie.flocculation(at, _segments(history), thixotropy, positive("yield_stress", yield_stress, "Pa"), bare("initial", initial))


def estimate(
    spread: Optional[Quantity] = None,
    t500: Optional[Quantity] = None,
    *,
    slump: Optional[Quantity] = None,
    plastic_viscosity: Optional[Quantity] = None,
    cone: str = "abrams",
    density: Quantity = "2400 kg/m3",
    spread_error: Quantity = "15 mm",
    slump_error: Quantity = "10 mm",
    t500_error: Quantity = "0.2 s",
) -> Result:
    """Yield stress and plastic viscosity from a spread at rest [m], a slump [m] or both, and t500 [s], by a table of direct
    runs for each mould (a name from reference_data/cones). A `plastic_viscosity` [Pa s] that is known narrows the yield stress.

    The errors are one standard error each. `.results` has yield_stress_Pa and plastic_viscosity_Pa_s (value, ci95;
    None where the table does not reach, and the viscosity without t500) and two closed forms by the spread."""
    for name, value in (("spread", spread), ("slump", slump)):
        if value is not None and not 0.0 < positive(name, value, "m") < 2.0:
            raise _tremie.InputError(
                f'{name}: {positive(name, value, "m"):g} m; must be less than 2 m (a number is in metres: 0.59, or "590 mm")'
            )
    measured = _tremie.Measured(
        spread=_optional("spread", spread, "m"),
        spread_error=positive("spread_error", spread_error, "m"),
        slump=_optional("slump", slump, "m"),
        slump_error=positive("slump_error", slump_error, "m"),
        t500=_optional("t500", t500, "s"),
        t500_error=positive("t500_error", t500_error, "s"),
        mu=_optional("plastic_viscosity", plastic_viscosity, "Pa.s"),
        density=positive("density", density, "kg/m3"),
    )
    results = _tremie.estimate(measured, cone)
    summary = {"apparatus": "estimate", "status": "completed", "checks": {"reasons": results.pop("reasons")}}
    return checked(Result({**summary, "results": results}))
