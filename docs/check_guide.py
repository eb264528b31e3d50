#!/usr/bin/env python3
"""The guide's commands and scenes, held against the program: check_guide.py PROGRAM. Run in the repository's root.

Every `tremie …` line of a guide page must name a command and options that its --help has; what it runs must be a scene that `tremie check`
takes with the same --set. A scene that a page shows must check, too. Nothing is computed. And every test that docs/extremes.md names
must stand in tests/."""
import pathlib, re, shlex, subprocess, sys, tempfile

program = str(pathlib.Path(sys.argv[1]).resolve())
folder = tempfile.TemporaryDirectory()
scratch = pathlib.Path(folder.name)
wrong, lines = [], 0


def tremie(*arguments):
    return subprocess.run([program, *arguments], capture_output=True, text=True)


def judge(page, line, words):
    command, arguments = words[1], words[2:]
    help_text = tremie(command, "--help")
    if help_text.returncode != 0 or not re.search(r"--(?!help\b)\w|^Positionals", help_text.stdout, re.M):
        return  # not in this build: it takes nothing but --help
    for option in (w for w in arguments if w.startswith("--")):
        if not re.search(rf"{option}\b", help_text.stdout):
            wrong.append(f"{page}: {line}: tremie {command} has no {option}")
    if command != "run":
        return
    scene = pathlib.Path(arguments[0]) if arguments[0].startswith("apparatus/") else scratch / arguments[0]
    settings = [w for i, w in enumerate(arguments) if w == "--set" or i and arguments[i - 1] == "--set"]
    answer = tremie("check", str(scene), *settings)
    if answer.returncode != 0:
        wrong.append(f"{page}: {line}: {answer.stderr.strip()}")


for page in sorted(pathlib.Path("docs/guide").glob("*.md")):
    text = page.read_text()
    for block in re.findall(r"```toml\n(.*?)```", text, re.S):
        if block.startswith("apparatus ="):
            (scratch / "mine.toml").write_text(block)
            answer = tremie("check", str(scratch / "mine.toml"))
            if answer.returncode != 0:
                wrong.append(f"{page}: its scene: {answer.stderr.strip()}")
    for block in re.findall(r"```sh\n(.*?)```", text, re.S):
        for line in block.splitlines():
            if line.startswith("tremie "):
                lines += 1
                judge(page, line.split("  #")[0], shlex.split(line, comments=True))
tests = {f"{suite}.{case}" for file in pathlib.Path("tests").rglob("*.cpp")
         for suite, case in re.findall(r"^TEST(?:_[PF])?\((\w+),\s*(\w+)\)", file.read_text(), re.M)}
rows = [line.split("|")[1] for line in pathlib.Path("docs/extremes.md").read_text().splitlines() if line.startswith("| `")]
named = [name for row in rows for name in re.findall(r"`([\w.]+)`", row)]
wrong += [f"docs/extremes.md: there is no test {name}" for name in named if name not in tests]
if len(named) < 30:
    wrong.append(f"docs/extremes.md: {len(named)} tests, fewer than the table has")
print("\n".join(wrong) or f"{lines} commands as the program has them")
sys.exit(bool(wrong) or lines == 0)
