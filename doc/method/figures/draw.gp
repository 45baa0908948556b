# SPDX-License-Identifier: BSD-3-Clause
# gnuplot -e "data='…'; out='…'" draw.gp: the figures of doc/method/degeneracy.md from the output of degeneracy.cpp.
set encoding utf8
set terminal svg size 760,340 font "sans-serif,13" background rgb "white"

# 1: how certain a line is over its angle to the plane of degenerate lines
set output out."/angle.svg"
set multiplot layout 1,2
set logscale xy
set xrange [0.5:60]
set xtics ("0.5" 0.5, "1" 1, "2" 2, "5" 5, "10" 10, "20" 20, "50" 50)
set grid lc rgb "#dddddd"
set key top right samplen 1.5
set xlabel "angle out of the plane of the motion [°]"
set title "direction"
set ylabel "standard deviation [rad]"
set yrange [0.02:100]
set format y "10^{%L}"
plot 0.1 lc rgb "#888888" dt 2 title "limit", \
     data index 0 using 1:2 with lines lw 2 lc rgb "#c44e52" title "0.2 m flown", \
     data index 1 using 1:2 with lines lw 2 lc rgb "#dd8452" title "0.5 m", \
     data index 2 using 1:2 with lines lw 2 lc rgb "#4c72b0" title "1 m"
set title "distance, line 5 m away"
set ylabel "standard deviation [m]"
plot 0.5 lc rgb "#888888" dt 2 title "limit", \
     data index 0 using 1:3 with lines lw 2 lc rgb "#c44e52" title "0.2 m flown", \
     data index 1 using 1:3 with lines lw 2 lc rgb "#dd8452" title "0.5 m", \
     data index 2 using 1:3 with lines lw 2 lc rgb "#4c72b0" title "1 m"
unset multiplot

# 2: what releases a degenerate line: motion out of its plane
set output out."/swing.svg"
set multiplot layout 1,2
set xrange [0.002:0.5]
set xtics ("2 mm" 0.002, "1 cm" 0.01, "5 cm" 0.05, "20 cm" 0.2)
set xlabel "how far the path swings out of the plane"
set title "direction"
set ylabel "standard deviation [rad]"
plot 0.1 lc rgb "#888888" dt 2 title "limit", \
     data index 3 using 1:2 with lines lw 2 lc rgb "#4c72b0" title "along the motion", \
     data index 4 using 1:2 with lines lw 2 lc rgb "#55a868" title "a strut, 40° to it"
set title "distance, line 5 m away"
set ylabel "standard deviation [m]"
plot 0.5 lc rgb "#888888" dt 2 title "limit", \
     data index 3 using 1:3 with lines lw 2 lc rgb "#4c72b0" title "along the motion", \
     data index 4 using 1:3 with lines lw 2 lc rgb "#55a868" title "a strut, 40° to it"
unset multiplot

# 3: two observation planes meet in the line, or coincide
reset
set output out."/planes.svg"
set multiplot layout 1,2 margins 0.02,0.98,0.02,0.88 spacing 0.04
unset border; unset tics; unset key
set view 62,28,2.4
set xrange [-1.6:1.6]; set yrange [-0.4:4.2]; set zrange [-1.3:1.6]
set view equal xyz
set style fill transparent solid 0.35 noborder
set label 1 "c_0" at -1,0,-0.25 center
set label 2 "c_1" at 1,0,-0.25 center
set arrow 1 from -1,0,0 to 1,0,0 head lw 2 lc rgb "#333333"
set title "across the motion: the planes meet in the line"
set object 1 polygon from -1,0,0 to -0.2,4,1.2 to 0.2,4,-1.2 to -1,0,0 fillcolor rgb "#c44e52"
set object 2 polygon from 1,0,0 to -0.2,4,1.2 to 0.2,4,-1.2 to 1,0,0 fillcolor rgb "#4c72b0"
set arrow 2 from -0.2,4,1.2 to 0.2,4,-1.2 nohead lw 4 lc rgb "#222222"
splot NaN
set title "in one plane with it: the same for all depths"
set object 1 polygon from -1,0,0 to -1.2,4,0.6 to 1.2,4,0.6 to -1,0,0 fillcolor rgb "#c44e52"
set object 2 polygon from 1,0,0 to -1.2,4,0.6 to 1.2,4,0.6 to 1,0,0 fillcolor rgb "#4c72b0"
set arrow 2 from -1.2,4,0.6 to 1.2,4,0.6 nohead lw 4 lc rgb "#222222"
set arrow 3 from -0.62,2.2,0.33 to 0.62,2.2,0.33 nohead lw 2 dt 2 lc rgb "#222222"
set arrow 4 from -0.35,1.5,0.22 to 0.75,3.4,0.51 nohead lw 2 dt 2 lc rgb "#222222"
splot NaN
unset multiplot
