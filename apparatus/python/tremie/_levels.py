"""The compiled core for this processor, where the installation has it for several levels of x86-64."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Optional

#: What tells a level from the one below, the best first.
LEVELS = {
    "x86-64-v4": {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"},
    "x86-64-v3": {"avx2", "bmi2", "fma"},
}


def _processor() -> set[str]:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return set()
    return next((set(line.split(":")[1].split()) for line in lines if line.startswith("flags")), set())


def best_core(package: Path) -> Optional[str]:
    """The folder with the core for the best level that this processor has ($TREMIE_LEVEL names the best), if there is one."""
    wanted, has = os.environ.get("TREMIE_LEVEL"), _processor()
    names = [*LEVELS, "x86-64-v2", "x86-64"]
    if wanted is not None and wanted not in names:
        raise ImportError(f'TREMIE_LEVEL names an unknown level "{wanted}"; allowed: {" ".join(names)}')
    allowed = wanted is None
    for level, instructions in LEVELS.items():
        allowed = allowed or level == wanted
        if allowed and instructions | LEVELS["x86-64-v3"] <= has and (package / level).is_dir():
            return str(package / level)
    return None
