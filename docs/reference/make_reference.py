#!/usr/bin/env python3
"""The reference, from the program itself: make_reference.py PROGRAM [--check].

Writes scenes.md (what `tremie new` prints) and commands.md (every command's --help) beside this file. With --check nothing is
written: exit 1 where a stored page differs from what the program says. A command that is not in this build has no help and is left out of the check."""
import pathlib, subprocess, sys

program, check = sys.argv[1], "--check" in sys.argv[2:]
here = pathlib.Path(__file__).resolve().parent


def says(*arguments):
    done = subprocess.run([program, *arguments], capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else None


def section(title, language, text):
    lines = [line.rstrip() for line in text.splitlines()]
    return f"## {title}\n\n```{language}\n" + "\n".join(lines) + "\n```\n"


apparatus = ["slump_flow", "l_box", "icar_vane", "cell"]
listed = says("--commands")
commands = [line.split("\t")[0] for line in listed.splitlines()] if listed else []
pages = {
    "scenes.md": (
        "# Every key of a scene\n\nWhat `tremie new APPARATUS` prints: every key with its default, a comment and the words it takes. "
        "A value with a dimension is a string with a unit.\n",
        [section(f"`apparatus = \"{name}\"`", "toml", says("new", name) or "") for name in apparatus]),
    "commands.md": (
        "# Every command\n\nWhat `tremie COMMAND --help` prints.\n",
        [section("`tremie`", "text", says("--help") or "")]
        + [section(f"`tremie {name}`", "text", text) for name in commands if (text := says(name, "--help"))]),
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
