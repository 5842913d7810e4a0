# SPDX-License-Identifier: MIT
# Draws the file of `talus bench --solver-curves`: how far bodies drift over the passes that the solver makes in a step.
#   gnuplot -e "csv='curves.csv'; png='curves.png'" bench/solver_drift.gp
# over='time' in front of the rest draws it over the milliseconds of a step instead. For gnuplot 5.4 (Debian:
# gnuplot-nox).
if (!exists("csv")) csv = "docs/images/solver-drift.csv"
if (!exists("png")) png = "docs/images/solver-drift.png"
if (!exists("over")) over = "passes"

set datafile separator comma
set terminal pngcairo size 1200,460 font "DejaVu Sans,10"
set output png
set logscale xy
set xrange [:over eq "time" ? 100 : 200]
set format y "10^{%T}"
set grid linecolor rgb "#d8d8d8"
set key below maxrows 2 samplen 2
set xlabel over eq "time" ? "ms a step" : "iterations or sub-steps a step"
x = over eq "time" ? 12 : 4

# The boxes of the pool fall: how far tells nothing there, but how deep they lie in each other does.
scenes = "stack:height=10 extreme_stack:height=14 pool:boxes=200" # gnuplot reads a name up to its comma
columns = "6 6 8"
titles = "'stack: largest drift (m)' 'extreme\\_stack: largest drift (m)' 'pool: largest overlap (m)'"

figure(curve) = strcol(1) eq word(scenes, i) && strcol(2)."-".strcol(3) eq curve ? column(y) : NaN
curves = "baumgarte-coloured baumgarte-sequential soft-coloured soft-sequential"
is_soft(curve) = curve[1:4] eq "soft"
is_coloured(curve) = strstrt(curve, "-coloured") > 0
set multiplot layout 1,3
do for [i = 1:3] {
    set title word(titles, i)
    y = int(word(columns, i))
    set yrange [(i == 3 ? 1e-6 : 1e-5):(i == 3 ? 1 : 100)]
    plot for [curve in curves] csv skip 1 using x:(figure(curve)) with linespoints \
        pointtype (is_coloured(curve) ? 7 : 6) pointsize 0.5 linewidth 2 dashtype 2 - is_coloured(curve) \
        linecolor rgb (is_soft(curve) ? "#1668a8" : "#c8581c") \
        title (is_soft(curve) ? "soft, sub-steps" : "Baumgarte, iterations").(is_coloured(curve) ? "" : "; sequential")
}
unset multiplot
