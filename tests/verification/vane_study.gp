set terminal svg size 1000,420 font 'sans,13' background 'white'
set output 'vane_study.svg'
set datafile separator ','
set grid lc '#dddddd'
set multiplot layout 1,2
set xlabel 'time in s'
set ylabel 'torque in N m'
set yrange [0:2.5]
plot 'vane_decay.csv' using 1:2 skip 1 with lines title '10 mm', '' using 1:3 skip 1 with lines title '5 mm', '' using 1:4 skip 1 with lines title '2.5 mm'
set xrange [0:0.3]
set title 'the start, 5 mm'
plot 'vane_decay.csv' using 1:3 skip 1 with lines title 'blades', '' using 1:5 skip 1 with lines title 'container', '' using 1:($5+$7) skip 1 with points pt 6 ps 0.5 title 'container + rate of angular momentum', '' using 1:6 skip 1 with lines title 'power / speed'
unset multiplot
