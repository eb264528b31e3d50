#!/usr/bin/env python3
"""Puts tremie.html together: assemble.py PAGE_FOLDER WASM_FOLDER MIX_FOLDER VERSION OUT.

{{name}} in page.html stands for the file of that name, and for: wasm, the library in base64; worker, its
JavaScript with worker.js; scripts, all others; mixes and moulds, those of MIX_FOLDER and of the folder cones beside
it, as JSON; version."""
import base64, json, pathlib, re, sys, tomllib

SCRIPTS = ["numbers.js", "scene.js", "solver.js", "colours.js", "section.js", "plate.js", "chart.js", "answer.js",
           "controls.js", "estimate.js", "player.js", "take_away.js", "main.js"]  # in the order in which they are read


def mix_values(file):
    """The values of a mix in the units of the page's fields."""
    mix = tomllib.loads(file.read_text())["mix"]
    number = lambda text: float(text.split()[0]) if isinstance(text, str) else float(text)
    flat = {**mix, **mix["thixotropy"]}
    return {key: flat[key] if key in ("name", "source") else number(flat[key]) for key in flat if key != "thixotropy"}


def mould_values(file):
    """Name, and lengths in m."""
    mould = tomllib.loads(file.read_text())["cone"]
    length = lambda text: float(text.split()[0]) * {"mm": 1e-3, "cm": 1e-2, "m": 1.0}[text.split()[1]]
    return {"name": mould["name"], **{key: length(mould[key]) for key in ("top_radius", "bottom_radius", "height")}}


def main():
    page, wasm, mixes = (pathlib.Path(a) for a in sys.argv[1:4])
    read = lambda name: (page / name).read_text()
    parts = {
        "page.css": read("page.css"),
        "worker": (wasm / "tremie_page.js").read_text() + "\n" + read("worker.js"),
        "wasm": base64.b64encode((wasm / "tremie_page.wasm").read_bytes()).decode(),
        "mixes": json.dumps({f.stem: mix_values(f) for f in sorted(mixes.glob("*.toml"))}),
        "moulds": json.dumps({f.stem: mould_values(f) for f in sorted((mixes.parent / "cones").glob("*.toml"))}),
        "opening.json": read("opening.json").strip(),
        "scripts": "\n".join(read(name) for name in SCRIPTS),
        "version": sys.argv[4],
    }
    assert all("</script" not in text for text in parts.values())
    pathlib.Path(sys.argv[5]).write_text(re.sub(r"{{([\w.]+)}}", lambda m: parts[m[1]], read("page.html")))


main()
