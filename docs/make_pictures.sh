#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the pictures of scenes: a small one of each in docs/images/scenes/, those of the README in docs/images/. Scenes of
# the size of a record stand there with fewer bodies. Usage: docs/make_pictures.sh [SCENE]...; on two cores without a GPU
# all take about ten minutes. The picture of the window is the test's (docs/viewer.md says how).
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."

# scene, its parameters, steps
scenes() {
    cat <<'END'
stack height=10 60
pool boxes=600 240
extreme_stack height=14 120
pyramid base=20 60
wall width=40,height=20 60
columns side=20,height=10 30
grid stacks=200 30
pile boxes=1500 300
rubble boxes=4000,ratio=8 100
card_house levels=5 120
dominoes count=100 220
slope angle=30 200
plate boxes=200 60
heavy_on_light ratio=1000 60
brick_ring courses=8,radius=20 100
brick_gables across=4,rows=6,base=20 110
many_pyramids side=5,base=10 30
million boxes=4000 240
worlds count=36 60
END
}

# the same, of the README
large_scenes() {
    cat <<'END'
pool boxes=600 240
extreme_stack height=14 120
END
}

# make_pictures FOLDER WIDTH HEIGHT [SCENE]... < table
make_pictures() {
    local folder=$1 width=$2 height=$3 scene parameters steps
    shift 3
    mkdir -p "$folder"
    while read -r scene parameters steps; do
        if (($# > 0)) && [[ " $* " != *" $scene "* ]]; then continue; fi
        ./talus run "$scene:$parameters" --steps "$steps" --quiet --width "$width" --height "$height" \
            --image "$folder/$scene.png" </dev/null
        echo "$folder/$scene.png"
    done
}

make_pictures docs/images/scenes 480 270 "$@" < <(scenes)
make_pictures docs/images 960 540 "$@" < <(large_scenes)
