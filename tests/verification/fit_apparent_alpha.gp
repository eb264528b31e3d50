set terminal svg size 800,520 font 'sans,13' background 'white'
set output 'fit_apparent_alpha.svg'
set datafile separator ','
set grid lc '#dddddd'
set xrange [0:22]
set yrange [0:0.06]
set xlabel 'window of the record in s'
set ylabel 'alpha'
set key top right
set title 'One concrete, one alpha (2 % noise; bars: 95 % of 200 records)'
low = 0.0344735; high = 0.0370103; fitted = 0.0358707
set object 1 rectangle from 0,low to 22,high fc '#009e73' fs solid 0.2 noborder behind
plot 0.0358 with lines lw 2 lc 'black' title 'truth, 0.0358', fitted with lines lw 2 dt 2 lc '#009e73' title 'fit of the thixotropic Couette model, whole record', 'fit_apparent_alpha.csv' using 1:2:3:4 skip 1 with yerrorlines lw 2 pt 7 lc '#0072b2' title 'apparent, Newtonian rate 3.91 1/s', '' using 1:5:6:7 skip 1 with yerrorlines lw 2 pt 5 lc '#d55e00' title 'apparent, rate at the vane 10.2 1/s'
