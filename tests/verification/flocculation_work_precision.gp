# gnuplot flocculation_work_precision.gp, in this folder
set terminal svg size 1200,800 font 'sans,13' background 'white'
set output 'flocculation_work_precision.svg'
set datafile separator ','
set logscale xy
set format x '10^{%L}'
set format y '10^{%L}'
set xrange [1e-8:1]
set yrange [1e-23:10]
set xtics 100
set ytics 1e4
set grid lc '#dddddd'
set xlabel 'CPU time in s'
set ylabel 'error of lambda over its largest value'
set key bottom left samplen 2
set multiplot layout 2,3
f(c,m) = sprintf('< grep "^%s,%s," flocculation_work_precision.csv', c, m)
set title 'constant rate, 12.43 1/s' noenhanced
plot f('constant','update') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 7 ps 0.6 lc '#0072b2' title 'update', f('constant','update along') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 13 ps 0.8 lc '#e69f00' title 'update along', f('constant','euler') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 5 ps 0.6 lc '#d55e00' title 'euler', f('constant','cvode') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 9 ps 0.7 lc '#009e73' title 'cvode', f('constant','arkode') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 11 ps 0.7 lc '#cc79a7' title 'arkode'
set title 'ramp 0 to 12 1/s in 10 s' noenhanced
plot f('ramp','update') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 7 ps 0.6 lc '#0072b2' title 'update', f('ramp','update along') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 13 ps 0.8 lc '#e69f00' title 'update along', f('ramp','euler') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 5 ps 0.6 lc '#d55e00' title 'euler', f('ramp','cvode') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 9 ps 0.7 lc '#009e73' title 'cvode', f('ramp','arkode') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 11 ps 0.7 lc '#cc79a7' title 'arkode'
set title 'pulse 12 1/s, 1 s wide' noenhanced
plot f('pulse','update') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 7 ps 0.6 lc '#0072b2' title 'update', f('pulse','update along') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 13 ps 0.8 lc '#e69f00' title 'update along', f('pulse','euler') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 5 ps 0.6 lc '#d55e00' title 'euler', f('pulse','cvode') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 9 ps 0.7 lc '#009e73' title 'cvode', f('pulse','arkode') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 11 ps 0.7 lc '#cc79a7' title 'arkode'
set title 'rest, flow, rest; gated, linear ramps' noenhanced
plot f('rest_flow_rest','update') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 7 ps 0.6 lc '#0072b2' title 'update', f('rest_flow_rest','update along') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 13 ps 0.8 lc '#e69f00' title 'update along', f('rest_flow_rest','euler') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 5 ps 0.6 lc '#d55e00' title 'euler', f('rest_flow_rest','cvode') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 9 ps 0.7 lc '#009e73' title 'cvode', f('rest_flow_rest','arkode') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 11 ps 0.7 lc '#cc79a7' title 'arkode', f('rest_flow_rest','update without split') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 1 dt 2 pt 6 ps 0.6 lc '#56b4e9' title 'update without split'
set title '2 - 2 cos(1.3 t) 1/s; gated' noenhanced
plot f('waves_gated','update') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 7 ps 0.6 lc '#0072b2' title 'update', f('waves_gated','update along') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 13 ps 0.8 lc '#e69f00' title 'update along', f('waves_gated','euler') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 5 ps 0.6 lc '#d55e00' title 'euler', f('waves_gated','cvode') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 9 ps 0.7 lc '#009e73' title 'cvode', f('waves_gated','arkode') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 11 ps 0.7 lc '#cc79a7' title 'arkode', f('waves_gated','update without split') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 1 dt 2 pt 6 ps 0.6 lc '#56b4e9' title 'update without split'
set title 'stiff: alpha gamma_dot 5e5 to 1.5e6 1/s' noenhanced
plot f('stiff','update') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 7 ps 0.6 lc '#0072b2' title 'update', f('stiff','update along') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 13 ps 0.8 lc '#e69f00' title 'update along', f('stiff','euler') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 5 ps 0.6 lc '#d55e00' title 'euler', f('stiff','cvode') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 9 ps 0.7 lc '#009e73' title 'cvode', f('stiff','arkode') using 5:($4 < 1e-16 ? 1e-16 : $4) with linespoints lw 2 pt 11 ps 0.7 lc '#cc79a7' title 'arkode'
unset multiplot
