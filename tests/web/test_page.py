#!/usr/bin/env python3
"""tremie.html in a real headless Chromium against the native program: test_page.py PAGE PROGRAM OUT.

The same numbers to 1e-9 relative: both do the same arithmetic in double precision; what differs is the order in
which compilers contract products and the last digit of exp and log, 1e-14 on the spread. Leaves screenshots in OUT.
Exit 77, a skipped test, where there is no Chromium or no native program."""
import concurrent.futures, json, pathlib, subprocess, sys, tempfile, time

sys.dont_write_bytecode = True
sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "apparatus/web"))
import make_opening
from browser import Browser, is_there

SCENES = {
    "Mix A": 'apparatus = "slump_flow"\nmix = "mix_a"\n',
    "Mix C": 'apparatus = "slump_flow"\nmix = "mix_c"\n',
    "Mix A rested": 'apparatus = "slump_flow"\nmix = "mix_a"\n[test]\nrest = "240 s"\n',
}
failures, began = [], time.time()


def check(holds, message):
    print(("ok      " if holds else "FAILED  ") + f"{time.time() - began:4.0f} s  {message}", flush=True)
    if not holds:
        failures.append(message)


def native(program, toml, *settings):
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(folder) / "scene.toml"
        scene.write_text(toml)
        ran = subprocess.run([program, "run", scene, "--out", f"{folder}/out", "--quiet", *settings], capture_output=True, text=True)
        if ran.returncode:
            raise RuntimeError(f"the program ended with code {ran.returncode}: {ran.stderr}\n{toml}")
        return json.loads((pathlib.Path(folder) / "out/summary.json").read_text())


def difference(a, b, place=""):
    """The largest relative difference of two results; infinite where their keys or kinds differ."""
    if isinstance(a, dict):
        if not isinstance(b, dict) or list(a) != list(b):
            return float("inf"), place
        return max((difference(a[key], b[key], key) for key in a), default=(0.0, place))
    if isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        return max((difference(x, y, place) for x, y in zip(a, b)), default=(0.0, place))
    if isinstance(a, (int, float)) and not isinstance(a, bool) and isinstance(b, (int, float)):
        return abs(a - b) / max(abs(a), abs(b), 1e-300), place
    return (0.0 if a == b else float("inf")), place


def run_in_page(browser, scene, **options):
    """As text, which keeps the order of the keys."""
    return json.loads(browser.wait_for("return JSON.stringify(await window.tremie.run(args[0], args[1]))", scene, options))


def compare_with_native(browser, program):
    ratio = []
    for name, toml in SCENES.items():
        here, there = native(program, toml), run_in_page(browser, toml)
        check(list(here) == list(there), f"{name}: the keys of summary.json")
        worst, where = difference(here["results"], there["results"])
        check(worst < 1e-9, f"{name}: results within {worst:.1e} of the native program's ({where})")
        shown = browser.run("return document.getElementById('result-spread').textContent")
        check(shown == f"{here['results']['spread_mm']:.0f}", f"{name}: the page shows {shown} mm")
        ratio.append(there["cost"]["wall_s"] / here["cost"]["wall_s"])
        print(f"        {there['cost']['wall_s']:.2f} s in the page, {here['cost']['wall_s']:.2f} s native")
    print(f"time over the native program's: {', '.join(f'{r:.1f}' for r in ratio)}")


def ask_in_other_ways(browser, program):
    keys = {"apparatus": "slump_flow", "mix": "mix_c", "mix.density": "2350 kg/m3", "test": {"duration": "2 s"}}
    there = run_in_page(browser, keys)
    here = native(program, SCENES["Mix C"], "--set", "mix.density=2350 kg/m3", "--set", "test.duration=2 s")
    worst, where = difference(here["results"], there["results"])
    check(worst < 1e-9, f"an object of keys: results within {worst:.1e} ({where})")
    there = run_in_page(browser, SCENES["Mix C"], withError=True)
    here = native(program, SCENES["Mix C"], "--with-error")
    worst, where = difference(here["error"]["spread_mm"], there["error"]["spread_mm"])
    check(worst < 1e-6, f"the error bar, {there['error']['spread_mm']:.2f} mm, within {worst:.1e}")
    try:
        run_in_page(browser, 'apparatus = "slump_flow"\n[mix]\nyield_stres = "5 Pa"\n')
        check(False, "a wrong key is an error")
    except RuntimeError as error:
        check("yield_stress" in str(error) and "scene.toml:3" in str(error), f"a wrong key is an error: {error}")


def estimate(browser, program):
    """The page's estimate is the program's own, to the last digits of exp and log."""
    asked = {"spread_mm": 590, "t500_s": 2.5, "density_kg_m3": 2350, "spread_error_mm": 12, "t500_error_s": 0.3}
    options = ["--spread", "590 mm", "--t500", "2.5 s", "--density", "2350 kg/m3", "--spread-error", "12 mm", "--t500-error", "0.3 s"]
    for page_keys, line in ((asked, options), ({"spread_mm": 480}, ["--spread", "480 mm"])):
        here = json.loads(subprocess.run([program, "estimate", "--json", *line], check=True, capture_output=True).stdout)
        there = json.loads(browser.wait_for("return JSON.stringify(await window.tremie.estimate(args[0]))", page_keys))
        worst, where = max(difference(here["results"][key], there["results"][key], key) for key in here["results"])
        check(worst < 1e-9 and here["checks"] == there["checks"], f"estimate of {page_keys['spread_mm']} mm within {worst:.1e} ({where})")


def tab_to(browser, name):
    for _ in range(80):
        if browser.run("return document.activeElement.id") == name:
            return True
        browser.press("Tab")
    return False


def settled(browser):
    browser.until("document.querySelector('#result-error').textContent && !document.body.classList.contains('busy')", 120)


def use_the_keyboard(browser):
    settled(browser)
    browser.run("document.activeElement.blur()")
    check(tab_to(browser, "field-yield_stress"), "the yield stress is reached by Tab")
    browser.press("Control+a", *"61,5", "Tab")
    browser.until("location.hash.includes('yield_stress=61.5')")
    settled(browser)
    check(tab_to(browser, "scrubber"), "the time is reached by Tab")
    browser.press("Right", "Right")
    browser.run("document.querySelector('#estimate summary').focus()")
    browser.press("Enter")
    check(tab_to(browser, "estimate-run"), "the estimate is reached by Tab")
    browser.press("Enter")
    browser.until("document.querySelector('#estimate-answer li')")
    check("Yield stress" in browser.run("return document.querySelector('#estimate-answer').textContent"), "the estimate is answered")


def whole_file(folder, ending, limit=20):
    """The one file of a download, once it is complete: its name may be there before its bytes."""
    end, before = time.time() + limit, -1
    while time.time() < end:
        files = list(folder.glob(f"*.{ending}"))
        size = files[0].stat().st_size if files else 0
        if size and size == before and not list(folder.glob("*.crdownload")):
            return files[0]
        before = size
        time.sleep(0.1)
    raise RuntimeError(f"no complete *.{ending} in {limit} s")


def take_away(browser, program):
    """What is saved: a picture, the series, and a scene that the program runs to the page's spread."""
    with tempfile.TemporaryDirectory() as folder:
        browser.save_into(folder)
        for button, ending in (("save-png", "png"), ("save-csv", "csv"), ("save-toml", "toml")):
            browser.run(f"document.getElementById('{button}').click()")
            whole_file(pathlib.Path(folder), ending)
        files = {f.suffix: f for f in pathlib.Path(folder).iterdir()}
        check(set(files) == {".png", ".csv", ".toml"}, f"saved: {', '.join(sorted(f.name for f in files.values()))}")
        check(files[".png"].read_bytes()[:8] == b"\x89PNG\r\n\x1a\n" and files[".png"].stat().st_size > 20000, "the picture is a PNG")
        shown = float(browser.run("return document.getElementById('result-spread').dataset.value"))
        rows = files[".csv"].read_text().strip().split("\n")
        check(rows[0].startswith("time") and abs(float(rows[-1].split(",")[1]) - shown) < 1e-3, f"the series ends at {shown:.2f} mm")
        spread = native(program, files[".toml"].read_text())["results"]["spread_mm"]
        check(abs(spread - shown) < 1e-9 * shown, f"the saved scene spreads to {spread:.2f} mm in the program")


def open_on_a_result(browser, page, program):
    """Before anything is computed the page shows the stored result, which is the program's."""
    browser.open("about:blank")
    browser.open(page)
    shown, lines = text_of(browser, "result-spread"), verdict_lines(browser)
    stored = json.loads(browser.run("return document.getElementById('opening').textContent"))
    here = make_opening.opening(program)
    worst, where = difference(here["summary"]["results"], stored["summary"]["results"])
    check(worst < 1e-9 and here["lines"] == stored["lines"], f"the stored result is the program's within {worst:.1e} ({where}); else make_opening.py makes it anew")
    check(shown == f"{here['summary']['results']['spread_mm']:.0f}" and len(lines) > 3, f"the page opens on {shown} mm: {lines[0]}")
    check(text_of(browser, "result-error").startswith("±"), "the page opens with its error bar")
    browser.until("!document.body.classList.contains('busy')", 120)
    after = browser.run("return Number(document.getElementById('result-spread').dataset.value)")
    check(abs(after - stored["summary"]["results"]["spread_mm"]) < 1e-9 * after, "computed here, it is the same")


def choose_by_word(browser, page, program, folder):
    """Moulds, kinetics and floors give the program's own results."""
    cases = {"mould=haegermann&yield_stress=20&plastic_viscosity=1&structuration_rate=0&duration=2": ['cone = "haegermann"'],
             "floor=interface&interface_yield_stress=20&interface_viscosity=500&duration=1": ['contact = "interface"', 'interface_viscosity = "500 Pa.s/m"'],
             "floor=friction&coefficient=0.3&duration=1": ['contact = "friction"', "coefficient = 0.3"],
             "kinetics=gated&destructuration=0.3&rest=60&duration=1": ['kinetics           = "gated"', "destructuration    = 0.3"],
             "kinetics=roussel&destructuration=1&rest=60&duration=1": ['kinetics           = "roussel"']}
    for fragment, lines in cases.items():
        open_link(browser, page, fragment)
        browser.until("!document.getElementById('save-csv').disabled", 120)
        toml = saved_toml(browser, folder)
        shown = float(browser.run("return document.getElementById('result-spread').dataset.value"))
        spread = native(program, toml)["results"]["spread_mm"]
        check(all(line in toml for line in lines) and abs(spread - shown) < 1e-9 * shown, f"#{fragment}: {shown:.2f} mm, {spread:.2f} in the program")
        check(text_of(browser, "unread") == "", "the link is read")
    hidden = browser.run("return [...document.querySelectorAll('.field[hidden]')].map((field) => field.id)")
    check(hidden == ["of-breakdown_rate", "of-rate_exponent", "of-interface_yield_stress", "of-interface_viscosity", "of-coefficient"], f"fields that do not count are hidden: {hidden}")
    open_link(browser, page, "mould=haegermann&duration=1&yield_stress=20")
    check(not any("tremie concrete" in line or "t500" in line for line in verdict_lines(browser)), "a small mould has no class and no t500")
    open_link(browser, page, "mould=bucket&duration=1")
    check("mould=bucket (allowed: " in text_of(browser, "unread"), text_of(browser, "unread"))


def text_of(browser, name):
    return browser.run(f"return document.getElementById('{name}').textContent")


def answered(browser):
    browser.until("document.querySelector('.outcome .verdicts li')", 120)


def open_link(browser, page, fragment):
    """A link opened anew, and its result."""
    browser.open("about:blank")
    browser.open(f"{page}#{fragment}")
    answered(browser)


def write_into(browser, key, text):
    browser.run(f"const field = document.getElementById('field-{key}'); field.value = '{text}'; field.dispatchEvent(new Event('change'))")


def verdict_lines(browser):
    return browser.run("return [...document.querySelectorAll('.outcome .verdicts li')].map((line) => line.textContent)")


def read_links(browser, page):
    """What of a link cannot be read is told, with what stands in its place; the rest is taken."""
    cases = {"yield_stress=-5&plastic_viscosity=abc&lift=0&duration=2": [("yield_stress=-5", "54 Pa"), ("plastic_viscosity=abc", "35.8 Pa·s"), ("lift=0", "15 cm/s")],
             "yield_stress=80&rest=abc&colour=red&duration=2": [("rest=abc", "0 s"), ("colour=red", "no field has this name")]}
    for fragment, told in cases.items():
        open_link(browser, page, fragment)
        entries = text_of(browser, "unread").split("), ")
        check(len(entries) == len(told) and all(any(entry in e and place in e for e in entries) for entry, place in told),
              f"#{fragment}: {text_of(browser, 'unread')}")
    check(browser.run("return document.getElementById('field-yield_stress').value") == "80", "what can be read of a link is taken")
    check(browser.run("return document.getElementById('unread').role") == "status", "the line on a link is a status")
    write_into(browser, "rest", "240")
    check(text_of(browser, "unread") == "", "a change clears the line on the link")


def doubt_t500(browser, page, program):
    """The page doubts a t500 in the program's own words."""
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(folder) / "scene.toml"
        scene.write_text(SCENES["Mix A"])
        said = subprocess.run([program, "run", scene, "--out", f"{folder}/out", "--set", "mix.yield_stress=80 Pa"],
                              check=True, capture_output=True, text=True).stdout
    line = next(line for line in said.splitlines() if line.startswith("t500"))
    doubt = line[line.index("not to be relied on"):]
    open_link(browser, page, "yield_stress=80")
    check(any("t500" in shown and doubt in shown for shown in verdict_lines(browser)), f"80 Pa: {doubt}")
    open_link(browser, page, "yield_stress=54")
    check(not any("relied on" in shown for shown in verdict_lines(browser)), "54 Pa: t500 is not doubted")


def refuse_unreadable(browser, page, folder):
    """Nothing is run or taken away while a field cannot be read."""
    open_link(browser, page, "yield_stress=54&duration=2")
    address, before = browser.run("return location.href"), set(folder.iterdir())
    write_into(browser, "yield_stress", "-5")
    invalid = browser.run("return [...document.querySelectorAll('[aria-invalid]')].map((f) => [f.id, f.getAttribute('aria-invalid')])")
    check(invalid == [["field-yield_stress", "true"]], f"aria-invalid: {invalid}")
    told = set()
    for button in ("run", "save-toml", "save-csv", "save-png", "copy-link"):
        browser.run(f"document.getElementById('trouble').textContent = ''; document.getElementById('{button}').click()")
        told.add(text_of(browser, "trouble"))
    check(len(told) == 1 and "yield stress" in min(told), f"refused: {told}")
    check(text_of(browser, "said") == "" and browser.run("return location.href") == address, "no link of an unreadable field")
    write_into(browser, "density", "2300")
    check("yield stress" in text_of(browser, "trouble") and browser.run("return document.getElementById('field-yield_stress').value") == "-5",
          "another field's change keeps the unreadable one")
    time.sleep(1)
    check(set(folder.iterdir()) == before, "no file of an unreadable field")
    write_into(browser, "yield_stress", "60")
    check(browser.run("return document.querySelector('[aria-invalid]') === null") and "density=2300" in browser.run("return location.hash"), "a mended field is run")


def save_mixes(browser, page, program, folder):
    """A bundled mix keeps its name and what was measured on it; a changed one has its values."""
    measured = {"mix_a": 590, "mix_b": 550, "mix_c": 500}
    for mix, value in measured.items():
        open_link(browser, page, "rest=0&duration=3")
        browser.run(f"const mix = document.getElementById('mix'); mix.value = '{mix}'; mix.dispatchEvent(new Event('change'))")
        answered(browser)
        toml = saved_toml(browser, folder)
        shown = float(browser.run("return document.getElementById('result-spread').dataset.value"))
        results = native(program, toml)["results"]
        check(f'mix = "{mix}"' in toml and "[mix]" not in toml and 'duration   = "3 s"' in toml, f"{mix}: saved by its name")
        check(results["measured"]["spread_mm"] == value, f"{mix}: measured {value} mm in the program")
        check(abs(results["spread_mm"] - shown) < 1e-9 * shown, f"{mix}: the saved scene spreads to {shown:.2f} mm in the program")
    open_link(browser, page, "yield_stress=61.5&duration=2")
    check("[mix]" in saved_toml(browser, folder), "a changed mix is saved with its values")


def saved_toml(browser, folder):
    for file in folder.glob("*.toml"):
        file.unlink()
    browser.run("document.getElementById('save-toml').click()")
    return whole_file(folder, "toml").read_text()


def still_moving(browser, page):
    """Without rest there is no class; more time helps a concrete, and no time a fluid."""
    for fragment, advice in (("duration=1", "More time may be given"), ("yield_stress=0&structuration_rate=0&duration=1", "never comes to rest")):
        open_link(browser, page, fragment)
        shown = verdict_lines(browser)
        check(any("Still moving" in line and advice in line for line in shown) and not any("Measured" in line for line in shown) and text_of(browser, "unread") == "", f"#{fragment}: {shown[0]}")
    write_into(browser, "structuration_rate", "1.3")
    check("structuration rate of 0" in text_of(browser, "trouble"), f"a fluid builds up nothing: {text_of(browser, 'trouble')}")


def rest_without_structuration(browser, page):
    open_link(browser, page, "yield_stress=60&rest=240&structuration_rate=0&duration=1")
    check(any("rest changes nothing" in line for line in verdict_lines(browser)), "a rest that builds nothing up is told")


def scroll_to_result(browser, page):
    """On a telephone a run brings the result into view, and leaves the focus."""
    open_link(browser, page, "yield_stress=54&duration=2")
    browser.run("const run = document.getElementById('run'); run.focus(); run.scrollIntoView()")
    before = browser.run("return document.getElementById('result-spread').getBoundingClientRect().bottom")
    browser.run("document.getElementById('run').click()")
    top, bottom, focus = browser.run("const box = document.getElementById('result-spread').getBoundingClientRect();"
                                     "return [box.top, box.bottom, document.activeElement.id]")
    check(before < 0 <= top and bottom <= 844 and focus == "run", f"the result goes from {before:.0f} px to {top:.0f} px, the focus stays on {focus}")


def use_its_numbers(page, program):
    browser = Browser(1280, 900)
    try:
        browser.open(page)
        compare_with_native(browser, program)
        ask_in_other_ways(browser, program)
        estimate(browser, program)
        check(browser.console_errors() == [], "no console error")
    finally:
        browser.close()


def use_the_fields(page, program):
    browser = Browser(1280, 900)
    try:
        with tempfile.TemporaryDirectory() as folder:
            browser.save_into(folder)
            open_on_a_result(browser, page, program)
            choose_by_word(browser, page, program, pathlib.Path(folder))
            read_links(browser, page)
            doubt_t500(browser, page, program)
            refuse_unreadable(browser, page, pathlib.Path(folder))
            save_mixes(browser, page, program, pathlib.Path(folder))
            still_moving(browser, page)
            rest_without_structuration(browser, page)
        check(browser.console_errors() == [], "links and fields: no console error")
    finally:
        browser.close()


def use_the_page(page, program, out, width, dark):
    browser = Browser(width, 900 if width > 500 else 844, dark)
    try:
        # A layout does not ask for the flow's end.
        browser.open(page + "#yield_stress=54&rest=0&duration=2&yield_stress2=130&plastic_viscosity2=30.2&structuration_rate2=2.9&duration2=2")
        browser.until("document.querySelectorAll('.outcome .error')[1].textContent", 120)
        wide = browser.run("return document.documentElement.scrollWidth")
        check(wide <= width, f"{width} px: no sideways scrolling ({wide} px)")
        browser.screenshot(out / f"two_{width}_{'dark' if dark else 'light'}.png")
        browser.run("document.getElementById('second').click()")
        browser.until("document.querySelector('#result-error').textContent && !document.body.classList.contains('busy')", 120)
        check("tau" not in browser.run("return location.hash") and "yield_stress=54" in browser.run("return location.hash"), "the link holds the scene")
        browser.screenshot(out / f"one_{width}_{'dark' if dark else 'light'}.png")
        browser.run("const at = document.getElementById('scrubber'); at.value = arguments[0]; at.dispatchEvent(new Event('input'))", 150)
        check("0.3" in browser.run("return document.getElementById('time').textContent"), "the time can be chosen")
        browser.screenshot(out / f"moving_{width}_{'dark' if dark else 'light'}.png")
        if width > 500:
            use_the_keyboard(browser)
            browser.screenshot(out / "estimate_1280_light.png")
            take_away(browser, program)
        else:
            scroll_to_result(browser, page)
        check(browser.console_errors() == [], f"{width} px, {'dark' if dark else 'light'}: no console error")
    finally:
        browser.close()


def main():
    page, program, out = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    if not is_there() or not program.exists():
        print("skipped: needs chromium, chromedriver and", program)
        return 77
    out.mkdir(parents=True, exist_ok=True)
    check(page.stat().st_size < 2e6, f"one file of {page.stat().st_size / 1e6:.2f} MB")
    with concurrent.futures.ThreadPoolExecutor(2) as browsers:  # a browser keeps one core busy
        uses = [browsers.submit(use_its_numbers, page.as_uri(), program),
                browsers.submit(use_the_fields, page.as_uri(), program),
                browsers.submit(use_the_page, page.as_uri(), program, out, 1280, False),
                browsers.submit(use_the_page, page.as_uri(), program, out, 390, True)]
        for use in uses:
            use.result()
    return 1 if failures else 0


sys.exit(main())
