#!/usr/bin/env python3
"""Figures of a code against the expected ones of this kit: check.py CASE.toml MINE.csv.

MINE.csv has the columns case, quantity, at, value: those of the expected figures, in any order and number. Prints a line for
each expected figure; exit 0 where all that are given lie within what is allowed, 1 where one does not or where none is
given, 2 where the file cannot be read. Needs Python 3.11 alone."""
import csv
import pathlib
import sys
import tomllib


def key_of(row):
    return row["case"].strip(), row["quantity"].strip(), float(row["at"])


def read(file, value_columns):
    with open(file, newline="") as stream:
        return {key_of(row): {name: float(row[name]) for name in value_columns} for row in csv.DictReader(stream)}


def compare(expected, given):
    """(key, given or None, expected row, within) for each expected figure."""
    for key, row in expected.items():
        value = given.get(key, {}).get("value")
        yield key, value, row, value is not None and abs(value - row["value"]) <= row["allowed"]


def main():
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    case = pathlib.Path(sys.argv[1])
    try:
        setting = tomllib.loads(case.read_text())
        expected = read(case.parent / setting["expected"], ("value", "uncertainty", "allowed"))
        given = read(sys.argv[2], ("value",))
    except (OSError, KeyError, ValueError, TypeError, AttributeError) as error:
        print(f"cannot be read: {error!r}", file=sys.stderr)
        return 2
    unknown = [key for key in given if key not in expected]
    print(setting["title"])
    met = missing = 0
    for (name, quantity, at), value, row, within in compare(expected, given):
        told = f"{name:>8} {quantity:>21} at {at:<6g} expected {row['value']:8.2f} ± {row['uncertainty']:<5.2f}"
        if value is None:
            missing += 1
            print(f"{told} not given")
            continue
        met += within
        away = f"{100 * (value / row['value'] - 1):+6.2f} %" if row["value"] else f"{value:+6.2f}"
        print(f"{told} given {value:8.2f} {away}  {'ok' if within else 'OUTSIDE: ± %g allowed' % row['allowed']}")
    for key in unknown:
        print("not a figure of this kit:", *key)
    compared = len(expected) - missing
    print(f"{met} of {compared} figures are met; {missing} were not given")
    return 0 if compared and met == compared and not unknown else 1


sys.exit(main())
