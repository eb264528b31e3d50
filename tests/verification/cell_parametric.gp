set terminal svg size 1200,760 font 'sans,13' background 'white'
set output 'cell_parametric.svg'
set datafile separator ','
set grid lc '#dddddd'
set xlabel 'time in s'
set ylabel 'shear stress in Pa' tc '#0b5394'
set y2label 'lambda' tc '#e07b00'
set ytics nomirror
set y2tics
set yrange [0:*]
set y2range [0:*]
set key top right samplen 1.5
set offsets 0, 0, graph 0.3, 0
set xtics 10
set multiplot layout 2,3
f(s,v) = sprintf('< grep "^%s,%s," cell_parametric.csv', s, v)
set title 'yield stress tau_0' noenhanced
plot f('yield stress tau_0','27 Pa') using 3:5 with lines lw 2 lc '#9fc5e8' title '27 Pa', f('yield stress tau_0','27 Pa') using 3:6 axes x1y2 with lines lw 2 lc '#f9cb9c' notitle, f('yield stress tau_0','54 Pa') using 3:5 with lines lw 2 lc '#3d85c6' title '54 Pa', f('yield stress tau_0','54 Pa') using 3:6 axes x1y2 with lines lw 2 lc '#e69138' notitle, f('yield stress tau_0','108 Pa') using 3:5 with lines lw 2 lc '#073763' title '108 Pa', f('yield stress tau_0','108 Pa') using 3:6 axes x1y2 with lines lw 2 lc '#783f04' notitle
set title 'plastic viscosity mu' noenhanced
plot f('plastic viscosity mu','18 Pa.s') using 3:5 with lines lw 2 lc '#9fc5e8' title '18 Pa.s', f('plastic viscosity mu','18 Pa.s') using 3:6 axes x1y2 with lines lw 2 lc '#f9cb9c' notitle, f('plastic viscosity mu','36 Pa.s') using 3:5 with lines lw 2 lc '#3d85c6' title '36 Pa.s', f('plastic viscosity mu','36 Pa.s') using 3:6 axes x1y2 with lines lw 2 lc '#e69138' notitle, f('plastic viscosity mu','72 Pa.s') using 3:5 with lines lw 2 lc '#073763' title '72 Pa.s', f('plastic viscosity mu','72 Pa.s') using 3:6 axes x1y2 with lines lw 2 lc '#783f04' notitle
set title 'alpha' noenhanced
plot f('alpha','0.005') using 3:5 with lines lw 2 lc '#9fc5e8' title '0.005', f('alpha','0.005') using 3:6 axes x1y2 with lines lw 2 lc '#f9cb9c' notitle, f('alpha','0.01') using 3:5 with lines lw 2 lc '#3d85c6' title '0.01', f('alpha','0.01') using 3:6 axes x1y2 with lines lw 2 lc '#e69138' notitle, f('alpha','0.03') using 3:5 with lines lw 2 lc '#073763' title '0.03', f('alpha','0.03') using 3:6 axes x1y2 with lines lw 2 lc '#783f04' notitle
set title 'A_thix' noenhanced
plot f('A_thix','0.6 Pa/s') using 3:5 with lines lw 2 lc '#9fc5e8' title '0.6 Pa/s', f('A_thix','0.6 Pa/s') using 3:6 axes x1y2 with lines lw 2 lc '#f9cb9c' notitle, f('A_thix','1.3 Pa/s') using 3:5 with lines lw 2 lc '#3d85c6' title '1.3 Pa/s', f('A_thix','1.3 Pa/s') using 3:6 axes x1y2 with lines lw 2 lc '#e69138' notitle, f('A_thix','2.6 Pa/s') using 3:5 with lines lw 2 lc '#073763' title '2.6 Pa/s', f('A_thix','2.6 Pa/s') using 3:6 axes x1y2 with lines lw 2 lc '#783f04' notitle
set title 'regularisation m' noenhanced
plot f('regularisation m','1 s') using 3:5 with lines lw 2 lc '#9fc5e8' title '1 s', f('regularisation m','1 s') using 3:6 axes x1y2 with lines lw 2 lc '#f9cb9c' notitle, f('regularisation m','5 s') using 3:5 with lines lw 2 lc '#3d85c6' title '5 s', f('regularisation m','5 s') using 3:6 axes x1y2 with lines lw 2 lc '#e69138' notitle, f('regularisation m','50 s') using 3:5 with lines lw 2 lc '#073763' title '50 s', f('regularisation m','50 s') using 3:6 axes x1y2 with lines lw 2 lc '#783f04' notitle
set title 'rest' noenhanced
plot f('rest','0 s') using 3:5 with lines lw 2 lc '#9fc5e8' title '0 s', f('rest','0 s') using 3:6 axes x1y2 with lines lw 2 lc '#f9cb9c' notitle, f('rest','100 s') using 3:5 with lines lw 2 lc '#3d85c6' title '100 s', f('rest','100 s') using 3:6 axes x1y2 with lines lw 2 lc '#e69138' notitle, f('rest','240 s') using 3:5 with lines lw 2 lc '#073763' title '240 s', f('rest','240 s') using 3:6 axes x1y2 with lines lw 2 lc '#783f04' notitle
unset multiplot
