"""Python's values as the program reads them: TOML, --set arguments, quantities with units."""

from __future__ import annotations

import json
import math
import os
from typing import Any, Mapping, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _tremie

#: A number in the SI unit that the argument's description names, or text with any unit: 0.0635 or "63.5 mm".
Quantity = Union[float, str]


def bare(name: str, value: float, kind: str = "number") -> float:
    """A finite number; raises InputError that names the argument."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise _tremie.InputError(f"{name}: {value!r} is no {kind}") from None
    if not math.isfinite(number):
        raise _tremie.InputError(f"{name}: {number} is no finite number")
    return number


def si(name: str, value: Quantity, unit: str) -> float:
    """The value in `unit`; raises InputError that names the argument."""
    if isinstance(value, str):
        return _tremie.quantity(name, value, unit)
    return bare(name, value, "number, nor text with a unit")


def numbers(name: str, values: ArrayLike, unit: str) -> np.ndarray:
    """An array of numbers in `unit`, or of texts with units; as si(), element by element."""
    if isinstance(values, str):
        raise _tremie.InputError(f"{name}: {values!r} is one value; it takes several, [\"…\", \"…\"]")
    try:
        array = np.asarray(values)
        if array.dtype.kind in "biuf":
            return array.astype(float)
        flat = [si(f"{name}[{i}]", value, unit) for i, value in enumerate(np.asarray(values, dtype=object).ravel())]
        return np.array(flat, dtype=float).reshape(array.shape)
    except (TypeError, ValueError) as error:
        if isinstance(error, _tremie.InputError):
            raise
        raise _tremie.InputError(f"{name}: takes numbers, or texts with units: {error}") from None


def positive(name: str, value: Quantity, unit: str) -> float:
    """As si(), greater than 0."""
    number = si(name, value, unit)
    if not number > 0.0:
        raise _tremie.InputError(f"{name}: {value!r} is not greater than 0")
    return number


def nested(flat: Mapping[str, Any]) -> dict[str, Any]:
    """A scene as tables in tables: a dotted key stands for them."""
    root: dict[str, Any] = {}
    for key, value in flat.items():
        if isinstance(value, Mapping):
            value = nested(value)
        *above, last = str(key).split(".")
        table = root
        for part in above:
            table = table.setdefault(part, {})
            if not isinstance(table, dict):
                raise _tremie.InputError(f"{key}: {part} is a value and a table")
        if isinstance(value, dict) and isinstance(table.get(last), dict):
            table[last].update(value)
        else:
            table[last] = value
    return root


def toml_value(value: Any) -> str:
    """One value, on one line."""
    if hasattr(value, "item") and getattr(value, "ndim", None) == 0:  # NumPy's scalars
        value = value.item()
    elif hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (str, os.PathLike)):
        return json.dumps(os.fspath(value), ensure_ascii=False)
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{json.dumps(str(k))} = {toml_value(v)}" for k, v in value.items()) + "}"
    if isinstance(value, Sequence):
        return "[" + ", ".join(toml_value(v) for v in value) + "]"
    raise _tremie.InputError(f"{value!r}: a {type(value).__name__} is no value of a scene")


def _is_list_of_tables(value: Any) -> bool:
    return isinstance(value, Sequence) and not isinstance(value, str) and len(value) > 0 and all(
        isinstance(v, Mapping) for v in value)


def _lines(table: Mapping[str, Any], path: str) -> list[str]:
    lines = []
    below = []
    for key, value in table.items():
        name = key if key.replace("_", "").replace("-", "").isalnum() and key.isascii() else json.dumps(key)
        if isinstance(value, Mapping):
            below += [f"[{path}{name}]", *_lines(value, f"{path}{name}.")]
        elif _is_list_of_tables(value):
            for entry in value:
                below += [f"[[{path}{name}]]", *_lines(entry, f"{path}{name}.")]
        else:
            lines.append(f"{name} = {toml_value(value)}")
    return lines + below


def toml(scene: Mapping[str, Any], *, dotted: bool = True) -> str:
    """The scene as TOML text. `dotted`: a dot in a key stands for a table."""
    return "\n".join(_lines(nested(scene) if dotted else scene, "")) + "\n"


def set_arguments(overrides: Mapping[str, Any]) -> list[str]:
    """mix__yield_stress="60 Pa", or the key with a dot, as `--set` has it."""
    arguments = []
    for key, value in overrides.items():
        key = key.replace("__", ".")
        if isinstance(value, Mapping):
            arguments += set_arguments({f"{key}.{below}": v for below, v in value.items()})
        else:
            arguments.append(f"{key}={toml_value(value)}")
    return arguments
