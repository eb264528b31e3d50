"""The module against the program: the same digits, the same messages. test_module.py PROGRAM"""

import inspect
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings
from pathlib import Path

import numpy as np

import tremie

PROGRAM = sys.argv.pop(1)
COARSE = {"apparatus": "slump_flow", "mix": "mix_c", "model": {"cell": ["20 mm", "10 mm"]}}
COARSE_TOML = 'apparatus = "slump_flow"\nmix = "mix_c"\n[model]\ncell = ["20 mm", "10 mm"]\n'
# many cells: takes much longer than the test lets it
LONG = {"apparatus": "slump_flow", "mix": "mix_a", "model": {"cell": ["4 mm", "2 mm"]}}
CELL = """apparatus = "cell"
[mix]
yield_stress = "54 Pa"
plastic_viscosity = "35.8 Pa.s"
thixotropy = {structuration_rate = "1.3 Pa/s", destructuration = 0.01}
[[history]]
duration = "10 s"
from = "5 1/s"
to = "5 1/s"
"""


def program(*arguments, code=0):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == code, (done.returncode, done.stderr)
    return done


class Folder(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    def file(self, name, text):
        (self.folder / name).write_text(text)
        return self.folder / name


class Scenes(Folder):
    def test_same_digits_as_the_program(self):
        scene = self.file("coarse.toml", COARSE_TOML)
        program("run", scene, "--set", "mix.yield_stress=60 Pa", "--out", self.folder / "out", "--quiet")
        written = tremie.read(self.folder / "out")
        for result in (tremie.run(COARSE, mix__yield_stress="60 Pa"), tremie.run(scene, **{"mix.yield_stress": "60 Pa"})):
            self.assertEqual(result.results, written.results)
            self.assertEqual(list(result.timeseries), list(written.timeseries))
            for name, column in result.timeseries.items():
                np.testing.assert_array_equal(column, written.timeseries[name])
            self.assertEqual(result.scene, written.scene)

    def test_a_folder_as_the_program_leaves_it(self):
        result = tremie.run(COARSE, out=self.folder / "out")
        read = tremie.read(self.folder / "out")
        self.assertEqual(result.results, read.results)
        names = {path.name for path in (self.folder / "out").iterdir()}
        self.assertLessEqual({"scene.toml", "summary.json", "timeseries.csv", "results.h5", "report.html"}, names)
        with self.assertRaisesRegex(tremie.InputError, "holds an earlier result"):
            tremie.run(COARSE, out=self.folder / "out")

    def test_arrays_are_the_buffers_of_the_run(self):
        result = tremie.run(COARSE, frames=True)
        column, position = result.timeseries["spread_mm"], result.frames[-1]["position_m"]
        for array in (column, position):
            self.assertIn("PyCapsule", type(array.base).__name__)
        self.assertEqual(position.shape, (result.frames[-1]["volume_m3"].size, 3))
        # the cone holds 5.498 litres: pi h (R^2 + R r + r^2)/3; weakly compressible, 0.5 % at most
        volumes = result.frames[-1]["volume_m3"].sum()
        self.assertAlmostEqual(volumes / 5.498e-3, 1.0, delta=5e-3)
        last = column[-1]
        del result
        self.assertEqual(column[-1], last)

    def test_bad_input_has_the_program_s_message(self):
        scene = self.file("bad.toml", COARSE_TOML.replace("cell =", "cel ="))
        said = program("run", scene, code=2).stderr.strip()
        with self.assertRaises(tremie.InputError) as raised:
            tremie.run(scene)
        self.assertEqual(str(raised.exception), said)
        with self.assertRaisesRegex(ValueError, 'mix.yield_stress.*60.*Pa'):
            tremie.run(COARSE, mix__yield_stress=60)

    def test_untrusted(self):
        # one step over a ramp that builds up and breaks down at once
        ramp = CELL.replace('from = "5', 'from = "0').replace("0.01}", '0.1, kinetics = "roussel"}')
        scene = self.file("cell.toml", ramp + '[model]\ntime_step = "10 s"\n')
        program("cell", scene, "--out", self.folder / "out", "--quiet", code=3)
        with self.assertWarns(tremie.UntrustedWarning):
            result = tremie.cell(scene)
        self.assertEqual(result.reasons, tremie.read(self.folder / "out").reasons)

    def test_cell(self):
        scene = self.file("cell.toml", CELL)
        program("cell", scene, "--out", self.folder / "out", "--quiet")
        result, read = tremie.cell(scene), tremie.read(self.folder / "out")
        self.assertEqual(result.results, read.results)
        np.testing.assert_array_equal(result.timeseries["shear_stress_Pa"], read.timeseries["shear_stress_Pa"])

    def test_interrupt_ends_a_run_between_steps(self):
        threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            tremie.run(LONG, out=self.folder / "out")
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_progress_and_its_errors(self):
        class Enough(Exception):
            pass

        seen = []

        def progress(t, duration, step, reading):
            seen.append((t, duration, step, reading))
            if len(seen) == 3:
                raise Enough

        with self.assertRaises(Enough):
            tremie.run(LONG, progress=progress)
        self.assertTrue(0.0 < seen[0][0] < seen[2][0] < seen[0][1])
        self.assertIn("spread", seen[0][3])

    def test_python_goes_on_during_a_run(self):
        worker = threading.Thread(target=tremie.run, args=(COARSE,))
        worker.start()
        turns = 0
        while worker.is_alive():
            time.sleep(0.001)
            turns += 1
        # a run that kept the lock would let this thread see its start and its end alone
        self.assertGreater(turns, 5)


class Rheometer(Folder):
    instrument = dict(vane_radius=0.0635, vane_height=0.127, container_radius=0.143)

    @staticmethod
    def rows(torque):
        return "speed_rev_per_s,torque_N_m\n" + "".join(f"{n},{T}\n" for n, T in zip([0.5, 0.4, 0.3, 0.2, 0.1], torque))

    def test_fit_has_the_program_s_digits(self):
        revolutions = np.array([0.5, 0.4, 0.3, 0.2, 0.1])
        torque = np.array([3.0, 2.55, 2.2, 1.7, 1.2])
        rows = "\n".join(f"{n!r},{T!r}" for n, T in zip(revolutions.tolist(), torque.tolist()))
        record = self.file("curve.csv", f"speed_rev_per_s,torque_N_m\n{rows}\n")
        program("fit", record, "--out", self.folder / "out", "--quiet")
        read = tremie.read(self.folder / "out")
        from_file = tremie.fit(record)
        self.assertEqual(from_file.results, read.results)
        from_arrays = tremie.fit(speeds=2.0 * np.pi * revolutions, torque=torque, vane_radius=0.0635)
        self.assertEqual(from_arrays["yield_stress_Pa"], read["yield_stress_Pa"])
        np.testing.assert_array_equal(from_file.tables["fit.csv"]["torque_fit_N_m"], read.tables["fit.csv"]["torque_fit_N_m"])

    def test_fit_takes_the_options_of_the_command(self):
        said = re.findall(r"^\s+(?:-\w,)?--([a-z-]+)", program("fit", "--help").stdout, re.MULTILINE)
        of_the_command = {name.replace("-", "_") for name in said} - {"help", "json", "out", "quiet", "force", "crate"}
        of_python = set(inspect.signature(tremie.fit).parameters) - {"t", "torque", "speeds"}
        self.assertGreater(len(of_python), 15)
        self.assertEqual(of_python, of_the_command)
        for name in of_python:
            self.assertIn(f" {name} ", tremie.fit.__doc__)
        with self.assertRaisesRegex(TypeError, "vane_radus.*vane_radius"):
            tremie.fit("curve.csv", vane_radus=0.06)
        with self.assertRaisesRegex(tremie.InputError, '^law: "casson" is not allowed; allowed: "auto", "bingham"'):
            tremie.fit("curve.csv", law="casson")

    def test_fit_has_the_program_s_digits_with_each_option(self):
        first = self.file("first.csv", self.rows([3.0, 2.55, 2.2, 1.7, 1.2]))
        second = self.file("second.csv", self.rows([3.1, 2.5, 2.25, 1.68, 1.25]))
        whole, again = (self.file(name, "time_s,speed_rpm,torque_N_m\n" + "".join(
            f"{0.5 * i},{speed},{factor * torque}\n" for i, (speed, torque) in enumerate(
                [(15, 2.0 + 1.5 * np.exp(-0.05 * k)) for k in range(120)] + [(0, 0.0)] * 120
                + [(0.3, min(k / 6, 0.7 + 0.3 * np.exp(-0.1 * (k - 6)))) for k in range(40)])))
            for name, factor in (("whole.csv", 1.0), ("again.csv", 1.05)))
        for records, options, text in (
            ([first], dict(ends="computed", blades="computed"), ["--ends", "computed", "--blades", "computed"]),
            ([first], dict(law="auto", torque_offset="-50 mN.m"), ["--law", "auto", "--torque-offset", "-50 mN.m"]),
            ([first], dict(ends="textbook", max_aggregate=0.016), ["--ends", "textbook", "--max-aggregate", "16 mm"]),
            ([first, second], dict(vane_height=0.1), ["--vane-height", "10 cm"]),
            ([whole], dict(protocol=True, instrument_compliance=0.02), ["--protocol", "--instrument-compliance", "0.02 rad/(N.m)"]),
            ([whole, again], dict(protocol=True, kinetics="roussel", yield_stress=20.0, plastic_viscosity="5 Pa.s"),
             ["--protocol", "--kinetics", "roussel", "--yield-stress", "20 Pa", "--plastic-viscosity", "5 Pa.s"]),
        ):
            with self.subTest(text), warnings.catch_warnings():
                warnings.simplefilter("ignore", tremie.UntrustedWarning)
                subprocess.run([PROGRAM, "fit", *map(str, records), *text, "--out", self.folder / "out", "--quiet", "--force"])
                read, result = tremie.read(self.folder / "out"), tremie.fit(records if len(records) > 1 else records[0], **options)
                self.assertEqual(result.results, read.results)
                self.assertEqual(result.reasons, read.reasons)
                self.assertEqual(set(result.tables), set(read.tables))

    def test_arrays_take_text_with_units(self):
        torque = ["3 N.m", "2.55 N.m", "2200 mN.m", "1.7 N.m", "1.2 N.m"]
        texts = tremie.fit(speeds=["0.5 rev/s", "0.4 rev/s", "0.3 rev/s", "12 rpm", "0.1 rev/s"], torque=torque)
        revolutions = np.array([0.5, 0.4, 0.3, 0.2, 0.1])
        plain = tremie.fit(speeds=2.0 * np.pi * revolutions, torque=[3.0, 2.55, 2.2, 1.7, 1.2])
        self.assertAlmostEqual(texts["yield_stress_Pa"]["value"], plain["yield_stress_Pa"]["value"], places=6)
        flow = tremie.reiner_riwlin(["0.25 rev/s"], yield_stress=54, plastic_viscosity=35.8)
        self.assertEqual(flow.torque.shape, (1,))
        with self.assertRaisesRegex(tremie.InputError, r"speeds\[1\]: .*wrong unit.*rev/s"):
            tremie.fit(speeds=["0.5 rev/s", "0.4 Pa"], torque=[2, 1])
        with self.assertRaisesRegex(tremie.InputError, r"torque\[0\]: .*no unit"):
            tremie.fit(speeds=[0.5, 0.4], torque=["2", "1"])
        for bad in ([None, None], object(), [[1], [1, 2]], "0.5 rev/s"):
            with self.assertRaises(tremie.InputError):
                tremie.fit(speeds=bad, torque=[2, 1])
        with self.assertRaisesRegex(tremie.InputError, "rest"):
            tremie.fit(t=[0, 1, 2], torque=[3, 2, 1], speed="0.25 rev/s", rest=[1])

    def test_reiner_riwlin(self):
        # fully sheared: T = 4 pi h [Omega mu + tau_0 ln(R_o/R_i)]/(R_i^-2 - R_o^-2)
        omega, tau_0, mu = np.array([2.0, 3.0]), 54.0, 35.8
        R_i, h, R_o = self.instrument.values()
        expected = 4 * np.pi * h * (omega * mu + tau_0 * np.log(R_o / R_i)) / (R_i**-2 - R_o**-2)
        flow = tremie.reiner_riwlin(omega, yield_stress="54 Pa", plastic_viscosity=mu, vane_radius="6.35 cm")
        np.testing.assert_allclose(flow.torque, expected, rtol=1e-12)
        back = tremie.reiner_riwlin_speed(flow.torque, yield_stress=tau_0, plastic_viscosity=mu)
        np.testing.assert_allclose(back, omega, rtol=1e-10)

    def test_flocculation(self):
        # rest builds A_thix t/tau_0, then flow above the gate leaves exp(-alpha gamma_dot t) of it
        state = tremie.flocculation([0, 240, 250], [(240, 0), ("10 s", "5 1/s")], yield_stress="54 Pa",
                                    structuration_rate="1.3 Pa/s", destructuration=0.01)
        rested = 1.3 * 240 / 54
        np.testing.assert_allclose(state, [0.0, rested, rested * np.exp(-0.01 * 5 * 10)], rtol=1e-11)
        for kinetics in ("gated", "roussel", "power"):  # also where the kinetics have no exponent
            with self.assertRaisesRegex(tremie.InputError, "the exponent must be at least 1"):
                tremie.flocculation([0, 1], [(1, 0)], yield_stress=54, structuration_rate=1.3, destructuration=0.01,
                                    kinetics=kinetics, exponent=0.5)

    def test_estimate(self):
        said = json.loads(program("estimate", "--spread", "590 mm", "--t500", "2.5 s", "--json").stdout)["results"]
        result = tremie.estimate("590 mm", t500=2.5)
        for name in ("yield_stress_Pa", "plastic_viscosity_Pa_s"):
            self.assertEqual(result[name]["value"], said[name]["value"])
            self.assertEqual(list(result[name]["ci95"]), said[name]["ci95"])
        with self.assertRaisesRegex(tremie.InputError, "spread: .*units"):
            tremie.estimate("590 bar")
        said = json.loads(program("estimate", "--slump", "120 mm", "--slump-error", "8 mm", "--json").stdout)["results"]
        result = tremie.estimate(slump=0.12, slump_error="8 mm")
        self.assertEqual(list(result["yield_stress_Pa"]["ci95"]), said["yield_stress_Pa"]["ci95"])
        self.assertIsNone(result["plastic_viscosity_Pa_s"])
        for wrong, message in (({"cone": "marsh", "spread": 0.2}, "marsh.*has no table; allowed: abrams"), ({}, "is missing"),
                               ({"slump": "310 mm"}, "slump: must be less than the cone's height")):
            with self.assertRaisesRegex(tremie.InputError, message):
                tremie.estimate(**wrong)


class Messages(Folder):
    def test_a_spread_in_millimetres_is_told_as_such(self):
        with self.assertRaisesRegex(tremie.InputError, "590 mm"):
            tremie.estimate(590)

    def test_they_speak_of_arguments(self):
        out = self.folder / "twice"
        tremie.run(COARSE, out)
        with self.assertRaisesRegex(tremie.InputError, "force=True replaces it, out=DIR writes elsewhere"):
            tremie.run(COARSE, out)
        with self.assertRaisesRegex(tremie.InputError, "^mix.yield_stress"):
            tremie.run(COARSE, mix__yield_stress="-5 Pa")

    def test_a_result_that_is_not_there(self):
        with self.assertRaisesRegex(KeyError, "spread_m'; there are:.*spread_mm"):
            tremie.run(COARSE)["spread_m"]


class Programs(Folder):
    definition = {
        "base": COARSE,
        "factor": [{"key": "mix.yield_stress", "values": ["100 Pa", "150 Pa"]}],
        "design": {"method": "grid"},
        "read": {"results": ["spread_mm"]},
    }

    def test_study(self):
        rows = tremie.study(self.definition, jobs=1).rows
        np.testing.assert_array_equal(rows["mix.yield_stress_Pa"], [100.0, 150.0])
        self.assertEqual(rows["spread_mm"][1], tremie.run(COARSE, mix__yield_stress="150 Pa")["spread_mm"])

    def test_study_bad_input(self):
        with self.assertRaisesRegex(tremie.InputError, "yield_stres.*nearest|did you mean"):
            tremie.study({**self.definition, "factor": [{"key": "mix.yield_stres", "values": ["1 Pa"]}]})


if __name__ == "__main__":
    unittest.main()
