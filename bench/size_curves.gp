# SPDX-License-Identifier: MIT
# Draws the file of `talus bench --size-curves`: time, memory and dispatches of a step over the number of boxes.
#   gnuplot -e "csv='curves.csv'; png='curves.png'" bench/size_curves.gp
# For gnuplot 5.4 (Debian: gnuplot-nox).
if (!exists("csv")) csv = "curves.csv"
if (!exists("png")) png = "curves.png"

set datafile separator comma
set terminal pngcairo size 1200,460 font "DejaVu Sans,10"
set output png
set logscale xy
set format x "10^{%T}"
set grid linecolor rgb "#d8d8d8"
set key below maxrows 2 samplen 2
set xlabel "boxes"

families = "grid pile"
devices = "gpu hybrid cpu"
colours = "#1668a8 #3a9a48 #c8581c"
is_of(family, device) = strcol(1) eq family && strcol(3) eq device
titles = "'ms a step (median)' 'bytes on the device for each body' 'dispatches a step'"
columns = "8 12 13"
set multiplot layout 1,3
do for [i = 1:3] {
    set title word(titles, i)
    plot for [f = 1:2] for [d = 1:3] csv skip 1 \
        using 6:(is_of(word(families, f), word(devices, d)) ? column(int(word(columns, i))) : NaN) \
        with linespoints pointtype (f == 1 ? 7 : 6) pointsize 0.6 linewidth 2 dashtype f \
        linecolor rgb word(colours, d) title word(families, f).", ".word(devices, d)
}
unset multiplot
