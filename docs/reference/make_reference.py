#!/usr/bin/env python3
"""The reference, from the program itself: make_reference.py PROGRAM [--check].

Writes scenes.md (what `tremie new` prints), commands.md (every command's --help) and results.md (`tremie --readings` and `--columns`: names, units and words of what
every apparatus reads and of its files' columns) beside this file. With --check nothing is
written: exit 1 where a stored page differs from what the program says. A command that is not in this build has no help: its stored section is kept, unchecked."""
import pathlib, re, subprocess, sys

program, check = sys.argv[1], "--check" in sys.argv[2:]
here = pathlib.Path(__file__).resolve().parent


def says(*arguments):
    done = subprocess.run([program, *arguments], capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else None


def help_of(command):
    """Its help; none of a command that is not in this build, which takes nothing but --help."""
    text = says(command, "--help")
    return text if text and re.search(r"--(?!help\b)\w|^Positionals", text, re.M) else None


def section(title, language, text):
    lines = [line.rstrip() for line in text.splitlines()]
    return f"## {title}\n\n```{language}\n" + "\n".join(lines) + "\n```\n"


def stored_section(name):
    """What commands.md has of a command that is not in this build."""
    found = re.search(rf"^## `tremie {re.escape(name)}`\n.*?^```\n(?=\n|\Z)", (here / "commands.md").read_text(), re.M | re.S)
    if not found:
        return []
    print(f"tremie {name} is not in this build: its section of commands.md is kept as it is")
    return [found[0]]


def command_section(name):
    text = help_of(name)
    return [section(f"`tremie {name}`", "text", text)] if text else stored_section(name)


def listed_readings():
    """Every apparatus with its words and its readings, (name, unit, words) each, in the program's order."""
    apparatus = {}
    for line in (says("--readings") or "").splitlines():
        name, reading, unit, words = line.split("\t")
        if reading:
            apparatus[name][1].append((reading, "" if unit == "1" else unit, words))
        else:
            apparatus[name] = (words, [])
    return apparatus


def listed_columns():
    """Of every apparatus the columns of its files, (name, unit, words) by file."""
    columns = {}
    for line in (says("--columns") or "").splitlines():
        name, file, column, unit, words = line.split("\t")
        columns.setdefault(name, {}).setdefault(file, []).append((column, "" if unit == "1" else unit, words))
    return columns


def shared_columns(columns):
    """Those that most apparatus have in their series, in the same words."""
    series = [files.get("timeseries.csv", []) for files in columns.values()]
    return [column for column in max(series, key=len, default=[]) if 2 * sum(column in other for other in series) > len(series)]


def rows(head, readings):
    return f"| {head} | unit | what |\n|---|---|---|\n" + "\n".join(f"| `{name}` | {unit} | {what} |" for name, unit, what in readings) + "\n"


def table(words, readings, files):
    parts = [f"## `results`: {words}\n", rows("key", readings)]
    for file, columns in files.items():
        parts.append(rows(f"column of `{file}`", [column for column in columns if column not in shared]))
    return "\n".join(parts)


results_head = """# Every field of a result

A run fills a folder ([which files](../guide/slump_flow.md#what-a-run-leaves)); `summary.json` is the result in one object. Keys end in their unit; what does not apply is null, never 0.

| part | fields |
|---|---|
| `schema` | version of this layout, 1 |
| `tremie` | `version`, `commit`, `compiler`, `instructions` (the level of x86-64 that the program is compiled for) |
| `apparatus`, `status` | which test; `completed`, `interrupted` or `failed` |
| `results` | the readings, below |
| `checks` | `volume_change` (ΣV/V0 − 1), `mass_error`, `unconverged_steps`, `points_lost`, `max_speed_end_m_per_s`, `stability_limit_exceeded`, `stood_still`, `reasons` |
| `cost` | `wall_s`, `cpu_s`, `steps`, `points`, `cells_active`, `bytes_per_point`, `peak_rss_bytes`, `threads`, `simulated_s` |
| `error` | with `--with-error` or `--accuracy`: half-widths by reading, `basis` (how they were found), `cpu_s` |

`checks.reasons` is a list of sentences; where it is not empty the result is not to be trusted, and the exit code is 3.

`results.h5` holds the series of `timeseries.csv`, the points over time, and where the numbers come from: attributes of its root are `scene`, `schema`, `apparatus`, `status`, `tremie_version`, `tremie_commit`, `compiler` and `instructions`. Every data set has the attributes `unit` and `description`.

| in `results.h5` | shape | what |
|---|---|---|
| `results`, its attribute `KEY` | one number or word | the readings below; NaN where there is none |
| `errors`, its attribute `KEY` | one number | half-widths, with `--with-error` or `--accuracy` |
| `series/NAME` | samples | the columns of `timeseries.csv`; `series/time_s` is their scale |
| `frames/00000`, its attribute `time_s` | one number | [s] |
| `frames/00000/position`, `velocity` | points, 3 | [m], [m/s] |
| `frames/00000/volume`, `pressure`, `shear_rate`, `flocculation` | points | [m³], [Pa], [1/s], [1]; what a scene does not have is left out |
| `frames/00000/age`, `load`, of a pile | points | [s] since batching, number of the load |
| `profile/NAME`, `torque/NAME`, `flow_curve/NAME`, `wall/NAME` | rows | the columns of that `.csv`; the first is their scale |

Numbers are IEEE doubles. In three dimensions z is up. A section of a body of revolution is (radius, 0, height), a plane section (along, height, 0), a vane's section (x, y, 0). A point keeps its place in the order from frame to frame, but for concrete that enters or leaves; where a run chooses its frames by itself, every k-th point is written. `frames/*.vtp` have the same fields under the same names.

`estimate`, `study` and `calibrate` leave files of their own: what is in them is on their pages of the guide. A run that was cut short keeps its state in `.NAME.part/checkpoint` beside its folder, for the very build that wrote it: points, time, step, grid, the solver's stresses and rates, friction, bars' drag, and the apparatus' own series. The last step of a test is cut to end at `test.duration`. A finished result keeps the state before that step in `.for_longer`, from which `tremie resume DIR --until` goes on with whole steps. A run that was interrupted and resumed leaves the same bytes as one that was not.
"""
fit_section = """## `results`: `tremie fit`

Each parameter is an object with `value` and `ci95`, the ends of its 95 % interval, or null where the record does not tell it.

| key | unit | what |
|---|---|---|
| `kind` |  | `flow_curve`, `torque_decay`, `tribometer`, `protocol`, `replicates` or `protocol_replicates` |
| `yield_stress_Pa`, `plastic_viscosity_Pa_s` | Pa, Pa s | dynamic yield stress, plastic viscosity |
| `consistency_Pa_s_n`, `flow_index` | Pa s^n | Herschel-Bulkley |
| `static_yield_stress_Pa` | Pa | (1 + λ) τ0 at the start of a decay |
| `flocculation_start` |  | λ at the start of a decay |
| `structuration_rate_Pa_per_s` | Pa/s | A_thix |
| `alpha`, `exponent` |  | breakdown by strain, exponent of λ |
| `breakdown_rate_per_s` | 1/s | k γ̇^a at this speed; of a protocol k |
| `rate_exponent` |  | a |
| `interface_yield_stress_Pa`, `interface_viscosity_Pa_s_per_m` | Pa, Pa s/m | τ_i, k_i of a smooth wall |
| `model`, `models`, `choice` |  | the law or kinetics chosen, all that were fitted with their scatter, and why |
| `alpha_apparent`, `alpha_apparent_basis` |  | exponent of the decay over a nominal shear rate, and by which |
| `plug`, `plug_below_rev_per_s`, `sheared_radius_mm` |  | whether a plug remains, below which speed; how far concrete shears |
| `relative_scatter`, `residual_correlation`, `effective_readings` |  | of the readings about the fit |
| `points_used`, `points_dropped`, `points_dropped_count` |  | readings, and those left out |
| `notes`, `understood` |  | what to know; how the file was read |
| `geometry`, `ends`, `blades` |  | geometry, and corrections with what they move |

`fit.csv` holds the readings beside the fitted torques; of a protocol `sections.csv` has a row for each section, with `fit_PARAMETER`, `…_low` and `…_high`.

`--protocol` has besides:

| key | unit | what |
|---|---|---|
| `sections[]` |  | of each: `kind`, lines, `start_s`, `duration_s`, `speed_rev_per_s` or `shear_rate_per_s`, `rest_before_s`, `start_up`, `decay`, `loop_area_…`, `fit` (as above), `notes`, `reasons` |
| `flow_curve_section` |  | number of the flow curve that counts for the others |
| `static_yield_stress_without_rest_Pa` | Pa | where the line of the peaks begins |
| `structuration.rest_s`, `structuration.static_yield_stress_Pa` | s, Pa | rests and their static yield stresses |
| `structuration.rate_by_flow_curve_Pa_per_s` | Pa/s | A_thix without the viscous part of the peaks |
| `structuration.saturation` |  | `static_yield_stress_end_Pa`, `time_s`: growth that ends |
| `structuration.forecasts[]` |  | each rest forecast by the shorter ones |
| `breakdown.half_times[]`, `breakdown.modes`, `breakdown.models[]`, `breakdown.choice` |  | half times by section, modes for a scene, laws compared |
| `mean`, `mean_of_sections` |  | of replicates |
"""


def scene_sections(names):
    """What `tremie new` prints of each, a table that stood before in the same words named alone."""
    first, sections = {}, []
    for name in names:
        blocks = []
        for block in (says("new", name) or "").split("\n\n"):
            header = re.search(r"^(\[+[\w.]+\]+)$", block, re.M)
            before = first.setdefault(block, name) if header else name
            blocks.append(block if before == name else f"# {header[1]}: as for \"{before}\"")
        sections.append(section(f"`apparatus = \"{name}\"`", "toml", "\n\n".join(blocks)))
    return sections


apparatus, columns = listed_readings(), listed_columns()
shared = shared_columns(columns)
series_section = ("## Columns that most `timeseries.csv` have\n\nThe tables below leave them out; a file has those that apply to its test.\n\n"
                  + rows("column", shared))
listed = says("--commands")
commands = [line.split("\t")[0] for line in listed.splitlines()] if listed else []
pages = {
    "scenes.md": (
        "# Every key of a scene\n\nWhat `tremie new APPARATUS` prints: every key with its default, a comment and the words it takes. "
        "A value with a dimension is a string with a unit. A table that stood before in the same words is named alone.\n",
        scene_sections(apparatus)),
    "commands.md": (
        "# Every command\n\nWhat `tremie COMMAND --help` prints.\n",
        [section("`tremie`", "text", says("--help") or "")]
        + [text for name in commands for text in command_section(name)]),
    "results.md": (results_head, [series_section] + [table(*found, columns.get(name, {})) for name, found in apparatus.items()] + [fit_section]),
}

differ = False
for name, (head, sections) in pages.items():
    file = here / name
    if check:
        stored = file.read_text()
        for s in sections:
            if s not in stored:
                differ = True
                print(f"docs/reference/{name}: not what the program says:", s.splitlines()[0][3:])
    else:
        file.write_text(head + "\n" + "\n".join(sections))
if differ:
    print("To mend it: python3 docs/reference/make_reference.py build/release/tremie")
sys.exit(differ)
