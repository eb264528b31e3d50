# The figures of docs/paper_page.md from the tables beside this file; run in this folder by make_figures.sh.
set datafile separator ","
set terminal svg size 900,480 font "sans,13" background "white"
set grid lc "#dddddd"
rows(program, mix) = sprintf("< grep '^%s,%s,' errors.csv", program, mix)

set output "errors.svg"
set logscale xy
set xlabel "CPU time / s, one core"
set ylabel "error of the spread after 20 s / %"
set xrange [0.1:60000]
set yrange [0.05:50]
set key outside right
set arrow from 5040, 0.05 to 5040, 50 nohead dt 2 lc 8
set arrow from 29160, 0.05 to 29160, 50 nohead dt 2 lc 8
set label "CB-GEO, linear: cost alone" at 3900, 0.06 rotate left tc lt 8
set label "CB-GEO, GIMP, the paper's grid: cost alone" at 22500, 0.06 rotate left tc lt 8
set object rectangle from 0.1, 0.05 to 60000, 0.5 behind fillcolor rgb "#eeeeee" fillstyle solid noborder
set label "the finite elements' own uncertainty, ± 0.5 %" at 0.12, 0.062
middle(a, b) = sqrt(a * b)
plot rows("section", "C") using 5:($4*100) with linespoints pt 7 lc 1 title "Tremie, section, Mix C", \
     rows("section", "A") using 5:($4*100) with linespoints pt 6 lc 1 dt 2 title "Tremie, section, Mix A", \
     rows("3D", "C") using 5:($4*100) with points pt 5 ps 1.3 lc 2 title "Tremie, 3D, Mix C", \
     rows("3D", "A") using 5:($4*100) with points pt 4 ps 1.3 lc 2 title "Tremie, 3D, Mix A", \
     rows("interFoam", "C") using (middle($5, $6)):($4*100):5:6 with xerrorlines pt 9 lc 7 title "interFoam, Mix C", \
     rows("interFoam", "A") using (middle($5, $6)):($4*100):5:6 with xerrorlines pt 8 lc 7 dt 2 title "interFoam, Mix A"

reset
set datafile separator ","
set terminal svg size 1000,720 font "sans,13" background "white"
set grid lc "#dddddd"
set output "validation.svg"
set multiplot layout 1,2
table(pattern) = sprintf("< grep '%s' ../../tests/verification/validation.csv | sed 's/\"[^\"]*\"/text/g'", pattern)
set key below vertical maxrows 10 reverse Left
set xlabel "measured / mm" offset 0, 0.6
set ylabel "predicted / mm"
set xrange [0:700]
set yrange [0:700]
plot x with lines lc 8 dt 2 title "predicted as measured", \
     table("fresh, no slip") using 4:6:5:7 with xyerrorbars pt 7 lc 1 title "spread, fresh, no slip", \
     table("rested, no slip.,") using 4:6:5:7 with xyerrorbars pt 5 lc 7 title "240 s of rest, no slip, α = 0.01", \
     table("rested, no slip, default") using 4:6:5:7 with xyerrorbars pt 13 lc 6 title "240 s of rest, no slip, a = 0.1 (default)", \
     table("fresh, friction") using 4:6:5:7 with xyerrorbars pt 6 lc 1 title "spread, fresh, friction", \
     table("rested, friction") using 4:6:5:7 with xyerrorbars pt 4 lc 7 title "240 s of rest, friction, α = 0.01", \
     table("^sliding.*fresh") using 4:6:5 with xerrorbars pt 9 lc 2 title "fresh, sliding floor of the other two", \
     table("^sliding.*rested") using 4:6:5 with xerrorbars pt 8 lc 2 title "240 s of rest, the same floor, a = 0.1", \
     table("^slump") using 4:6:5:7 with xyerrorbars pt 2 lc rgb "#888888" title "slump: a correlation, no measurement"
set xlabel "measured / Pa" offset 0, 0.6
set ylabel "predicted / Pa"
set xrange [0:2700]
set yrange [0:2700]
plot x with lines lc 8 dt 2 title "predicted as measured", \
     table("^torque,.paste.*line") using 4:6:5:7 with xyerrorbars pt 7 lc 4 title "paste, static yield stress: a line", \
     table("^torque,.paste.*saturating") using 4:6:5 with xerrorbars pt 6 lc 4 title "the same, saturating"
unset multiplot
