# SPDX-License-Identifier: MIT
# Draws the file of `talus bench --broad-phases`: the time of each broad phase over the number of bodies.
#   gnuplot -e "csv='broad.csv'; png='broad.png'" bench/broad_phases.gp
# For gnuplot 5.4 (Debian: gnuplot-nox).
if (!exists("csv")) csv = "broad-phases.csv"
if (!exists("png")) png = "broad-phases.png"

set datafile separator comma
set datafile missing NaN # the lines of other scenes do not break a curve
set terminal pngcairo size 1200,460 font "DejaVu Sans,10"
set output png
set logscale xy
set format xy "10^{%T}"
set grid linecolor rgb "#d8d8d8"
set key top left samplen 2
set xlabel "bodies"
set ylabel "ms a step in the broad phase"

scenes = "grid pile rubble"
titles = "'grid: a field of stacks' 'pile: a heap, edges of 0.5 to 1.5 m' 'rubble: edges of 1/8 to 4 m'"
kinds = "sap bvh brute"
names = "'sweep and prune' 'tree' 'every pair'"
colours = "#c8581c #1668a8 #808080"
# gnuplot reads a name up to its comma, so the scene's parameters do not matter.
took(scene, kind) = strcol(1)[1:strlen(scene)] eq scene && strcol(4) eq kind ? column(7) : NaN
set multiplot layout 1,3
do for [i = 1:3] {
    set title word(titles, i)
    plot for [k = 1:3] csv skip 1 using 3:(took(word(scenes, i), word(kinds, k))) with linespoints pointtype 7 \
        pointsize 0.6 linewidth 2 linecolor rgb word(colours, k) title word(names, k)
}
unset multiplot
