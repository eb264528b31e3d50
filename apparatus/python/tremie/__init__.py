"""Tremie: virtual rheometry and test apparatus for fresh, thixotropic concrete.

    import tremie
    result = tremie.run({"apparatus": "slump_flow", "mix": "mix_a"}, test__rest="240 s")
    result["spread_mm"], result.timeseries["time_s"], result.reasons

The functions are those of the program `tremie`, with its keys, its messages and its digits. Quantities are text with
a unit ("54 Pa") or, where a function's argument says so, numbers in SI units; the names of results bear their units."""

from pathlib import Path as _Path

from ._levels import best_core as _best_core

if _core := _best_core(_Path(__file__).parent):
    __path__.insert(0, _core)  # _tremie is looked for there first

from ._programs import calibrate, study
from ._result import Result, UntrustedWarning, read
from ._rheometer import CouetteFlow, estimate, fit, flocculation, reiner_riwlin, reiner_riwlin_speed
from ._scenes import cell, mixes, run
from ._tremie import InputError
from ._tremie import commit as __commit__
from ._tremie import version as __version__

__all__ = [
    "CouetteFlow",
    "InputError",
    "Result",
    "UntrustedWarning",
    "calibrate",
    "cell",
    "estimate",
    "fit",
    "flocculation",
    "mixes",
    "read",
    "reiner_riwlin",
    "reiner_riwlin_speed",
    "run",
    "study",
]
