set terminal svg size 1000,420 font 'sans,13' background 'white'
set output 'couette_decay.svg'
set datafile separator ','
set grid lc '#dddddd'
set xlabel 'time in s'
set multiplot layout 1,2
set ylabel 'torque in N m'
set yrange [0:2.5]
$stated << EOD
0,2.36
5,1.63
10,1.38
20,1.24
EOD
plot 'couette_decay.csv' using 1:2 skip 1 with lines lw 2 lc '#0072b2' title 'gated', '' using 1:3 skip 1 with lines lw 2 dt 2 lc '#d55e00' title 'roussel', $stated using 1:2 with points pt 7 lc 'black' title 'published, gated', 0.801 with lines dt 3 lc 'black' title 'dynamic Reiner-Riwlin torque'
set ylabel 'sheared as far as, in mm'
set yrange [63.5:95]
plot 'couette_decay.csv' using 1:4 skip 1 with lines lw 2 lc '#0072b2' title 'gated', '' using 1:5 skip 1 with lines lw 2 dt 2 lc '#d55e00' title 'roussel'
unset multiplot
