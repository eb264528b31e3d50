#!/bin/sh
# Figures 2 and 3 of docs/paper_page.md: make_figures.sh PROGRAM computes what they show anew (some 40 s of one core) and draws them;
# without a program it draws them from the tables that lie here. Needs python3 and gnuplot.
set -eu
[ $# -eq 0 ] || python3 "$(dirname "$0")/compute.py" "$1"
cd "$(dirname "$0")"
gnuplot figures.gp
