# Profiles at rest beside the closed form, and the error against run time.
set terminal svg size 900,760 enhanced background rgb "white"
set output "lbox_study.svg"
set datafile separator ","
set multiplot layout 2,1
set xlabel "distance from the gate / mm"
set ylabel "depth / mm"
set yrange [40:100]
set key top right
pick(mode, tau) = sprintf("< awk -F, '$1==\"%s\" && $2==%g && $3==10 && !seen[$4]++' lbox_profiles.csv", mode, tau)
plot pick("plane", 15) using 4:5 with points pt 6 ps 0.6 lc 1 title "15 Pa, plane", \
     pick("plane", 15) using 4:6 with lines lc 1 title "", \
     pick("plane", 50) using 4:5 with points pt 6 ps 0.6 lc 2 title "50 Pa, plane", \
     pick("plane", 50) using 4:6 with lines lc 2 title "", \
     pick("side walls", 50) using 4:5 with points pt 6 ps 0.6 lc 4 title "50 Pa, side walls", \
     pick("side walls", 50) using 4:6 with lines lc 4 title "closed form at the same volume"
set xlabel "CPU time / s"
set ylabel "error of the profile, rms / %"
set logscale xy
set yrange [0.5:10]
size(mode) = sprintf("< awk -F, '$1==\"%s\" && $2==50 && $4==180' lbox_study.csv", mode)
plot size("plane") using 11:(100*$7) with linespoints pt 7 lc 2 title "50 Pa, plane: 20, 10, 5 mm", \
     size("side walls") using 11:(100*$7) with linespoints pt 7 lc 4 title "50 Pa, side walls: 20, 10, 5 mm"
