#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Draws the pictures of README.md and occlusion.md, the paper's figures, and error against time:
# figures.sh OUT DATA writes them into OUT and keeps the sweeps in DATA, from which a second run
# resumes.
#
# Environment: HR2D_PROGRAM, the program; HR2D_SCENES, the example scenes; HR2D_SRCDIR,
# the top of the sources; HR2D_COST_SECONDS, how long each scene of cost.md may take (60).
set -eu
hr2d=${HR2D_PROGRAM:?names the program}
scenes=${HR2D_SCENES:?names the folder of scenes}
screened=${HR2D_SRCDIR:?names the source directory}/examples/scenes/screened-room.geojson
crowded=$HR2D_SRCDIR/bench/scenes
cost_seconds=${HR2D_COST_SECONDS:-60}
out=${1:?names the folder for the figures}
data=${2:?names the folder for the sweeps}
steps=200
mkdir -p "$out" "$data"
command -v gnuplot >/dev/null || { echo "figures.sh: gnuplot is not installed" >&2; exit 1; }

# draw NAME SCENE OPTIONS...: a scene as SVG and PNG; in SVG a hundredth of a point will do
draw() {
  name=$1
  scene=$2
  shift 2
  "$hr2d" solve "$scenes/$scene.geojson" --quiet --draw "$out/$name.png" "$@"
  "$hr2d" solve "$scenes/$scene.geojson" --quiet --draw "$data/$name.svg" "$@"
  sed 's/\(\.[0-9][0-9]\)[0-9]*/\1/g' "$data/$name.svg" >"$out/$name.svg"
}

# tile NAME SCENE OPTIONS...: the links of a scene as tiles
tile() {
  name=$1
  scene=$2
  shift 2
  "$hr2d" solve "$scene" --quiet --no-error --tiles "$out/$name.png" "$@"
}

# sweep SCENE ORACLE VARIANT FROM TO: rows without seconds, which differ each time, and
# a line of fits.csv, at its end the range of L/N² for N ≥ 250
sweep() {
  name=$1-$2-$3
  "$hr2d" study "$scenes/$1.geojson" --oracle "$2" --variant "$3" --from "$4" --to "$5" \
    --steps "$steps" --quiet --resume --csv "$data/$name.csv" --json "$data/$name.json"
  cut -d, -f1-5 "$data/$name.csv" >"$out/$name.csv"
  awk -v name="$1,$2,$3" '
    $1 ~ /^"(a|b|c|r2|slope)":$/ { gsub(/[":,]/, ""); fit[$1] = $2 }
    $1 ~ /^"(epsilon|elements|links)":$/ {
      gsub(/[":,]/, ""); if (!($1 in first)) first[$1] = $2; last[$1] = $2 }
    $1 == "links" && last["elements"] >= 250 {
      ratio = $2 / last["elements"] ^ 2
      if (!least || ratio < least) least = ratio
      if (ratio > most) most = ratio }
    $1 == "\"epsilon\":" || $1 == "epsilon" { rows++ }
    END { printf "%s,%d,%s,%s,%d,%d,%d,%d", name, rows, first["epsilon"], last["epsilon"],
            first["elements"], last["elements"], first["links"], last["links"]
          printf ",%.6g,%.6g,%.6g,%.6f,%.4f", fit["a"], fit["b"], fit["c"], fit["r2"],
            fit["slope"]
          printf ",%.4f,%.4f\n", least, most }
  ' "$data/$name.json" >>"$out/fits.csv"
}

# field SCENE ORACLE VARIANT COLUMN: from fits.csv
field() {
  awk -F, -v s="$1" -v o="$2" -v v="$3" -v c="$4" '
    NR == 1 { for (k = 1; k <= NF; k++) if ($k == c) at = k }
    $1 == s && $2 == o && $3 == v { print $at }' "$out/fits.csv"
}

# equation SCENE ORACLE VARIANT: the fit in gnuplot's enhanced text
equation() {
  for c in a b c; do field "$1" "$2" "$3" $c; done | awk '
    function text(x,    m, e) {
      m = x < 0 ? -x : x
      e = m > 0 ? int(log(m) / log(10) + 100) - 100 : 0
      return e < -3 || e > 3 ? sprintf("%.2f·10^{%d}", m / 10 ^ e, e) : sprintf("%.4g", m) }
    { x[NR] = $1 }
    END { printf "L = %s%s %s %s N %s %s N^2\n", x[1] < 0 ? "−" : "", text(x[1]),
            x[2] < 0 ? "−" : "+", text(x[2]), x[3] < 0 ? "−" : "+", text(x[3]) }'
}

# what NAME: a scene in words
what() {
  case $1 in
  par-near) echo "parallel patches, d = 0.1" ;;
  par-far) echo "parallel patches, d = 1" ;;
  orth-near) echo "orthogonal patches, 0.1 from the corner" ;;
  orth-far) echo "orthogonal patches, 1 from the corner" ;;
  esac
}

style="set encoding utf8
set datafile separator ','
set border 3 linecolor rgb '#404040'
set tics nomirror
set grid linecolor rgb '#d0d0d0'
set samples 400"

# plot NAME WIDTH HEIGHT: a gnuplot script on standard input, as SVG and PNG
plot() {
  script=$(cat)
  gnuplot --default-settings >"$out/$1.svg" <<END
set terminal svg size $2,$3 font 'sans-serif,13' background 'white'
$style
$script
END
  gnuplot --default-settings >"$out/$1.png" <<END
set terminal pngcairo size $((5 * $2 / 4)),$((5 * $3 / 4)) font 'sans-serif,13' fontscale 1.25 linewidth 1.25
$style
$script
END
}

# diagram SCENE: the dots and the fitted quadratic of the paper's Figures 7 and 8; the
# key stands above the dots
diagram() {
  l=$(field "$1" l1 original links_to)
  if [ "$l" -ge 1000000 ]; then unit=1000000 word=millions; else unit=1000 word=thousands; fi
  cat <<END
set title "$(what "$1")"
set xlabel 'elements N'
set ylabel 'links L ($word)'
set xrange [0:1.05*$(field "$1" l1 original elements_to)]
set yrange [0:1.3*$l/$unit.]
set key top left reverse Left spacing 1.3
f(x) = ($(field "$1" l1 original a) + x*($(field "$1" l1 original b) + x*$(field "$1" l1 original c)))/$unit.
plot f(x) with lines linewidth 1.5 linecolor rgb '#21918c' title "$(equation "$1" l1 original)", \
  '$out/$1-l1-original.csv' using 2:(\$4/$unit.) every ::1 with points pointtype 7 pointsize 0.35 \
  linecolor rgb '#440154' title "$steps values of ε,  R^2 = $(field "$1" l1 original r2)"
END
}

# series SCENE ORACLE VARIANT COLOUR POINTTYPE: one ε in five is enough for the eye
series() {
  cat <<END
'$out/$1-$2-$3.csv' using 2:(\$4/\$2**2) every 5::1 with points pointtype $5 pointsize 0.9 \
  linewidth 1.2 linecolor rgb '$4' title '$2, $3', \\
END
}

# slopes SCENE: the least and the greatest slope of the oracles and variants in the diagram
slopes() {
  for oracle in l1 size bf; do
    for variant in original modified; do field "$1" "$oracle" "$variant" slope; done
  done | sort -n | awk 'NR == 1 { least = $1 } { most = $1 }
    END { printf "slopes of log L: %.2f to %.2f", least, most }'
}

# comparison SCENE KEY: L/N², which stays between two bounds where L = Θ(N²)
comparison() {
  cat <<END
set title "$(what "$1")" font ',15'
set xlabel 'elements N' font ',15'
set ylabel 'L/N^2' font ',15'
set tics font ',13'
set logscale x
set format x '10^{%T}'
set xrange [20:50000]
set yrange [0:0.08]
set ytics 0.02
set label 1 "$(slopes "$1")" at graph 0.97, graph 0.94 right font ',13'
$2
plot $(series "$1" l1 original '#440154' 7)
$(series "$1" l1 modified '#b070c8' 6)
$(series "$1" size original '#21918c' 5)
$(series "$1" size modified '#60c0a0' 4)
$(series "$1" bf original '#c05800' 9)
$(series "$1" bf modified '#f0a040' 8)
1/0 notitle
END
}

# power K: 2 to the K
power() {
  awk -v k="$1" 'BEGIN { printf "%.17g", 2 ^ k }'
}

# The pictures of README.md: a room full of light, and the algorithm at work.
"$hr2d" solve "$scenes/partition.geojson" --target-error 1e-4 --quiet \
  --draw "$out/partition.png"
"$hr2d" solve "$screened" --eps 0.7 --multigrid 4:0.646765 --no-error --quiet \
  --watch "$out/watch.png"

# What a point sees, for occlusion.md.
"$hr2d" solve "$scenes/partition.geojson" --eps 1 --quiet \
  --draw "$out/beams.png" --beams-of window:0.5

# The rectangle of theorem.md, and the square of a room with shadows.
tile tiles "$scenes/par-near.geojson" --eps 0.25 --variant modified
tile tiles-shadows "$screened" --eps 0.25 --variant modified

# Figures 1 to 4: the paper's analysis, with its oracle and its modification.
draw figure-1 par-near --eps 16 --variant modified --no-fill
draw figure-2 par-near --eps 0.25 --variant modified --links-of bottom:0.3
draw figure-3 par-near --eps 0.25 --variant modified --links-of bottom:0.49 --link-level 5
draw figure-4 par-far --eps 0.5 --variant modified --links-of bottom:0.3 --link-level 1 \
  --link-parents

# Figures 5 and 6: the scenes of the experiments.
draw figure-5-near par-near --eps 0.25 --no-fill
draw figure-5-far par-far --eps 0.0625 --no-fill
draw figure-6-near orth-near --eps 0.125 --no-fill
draw figure-6-far orth-far --eps 0.0625 --no-fill

# Ranges of ε that take N from some dozens to some thousands; elements are as long as
# their distance times ε, so that distant patches need a smaller one.
header=scene,oracle,variant,rows,epsilon_from,epsilon_to,elements_from,elements_to
echo "$header,links_from,links_to,a,b,c,r2,slope,ratio_from,ratio_to" >"$out/fits.csv"
for scene in par-near par-far orth-near orth-far; do
  case $scene in
  *-near) size=0 bf=-2 l1=-6 grid=-22 ;;
  *-far) size=-3 bf=-5 l1=-12 grid=-26 ;;
  esac
  for variant in original modified; do
    sweep $scene l1 $variant "$(power $l1)" "$(power $((l1 - 24)))"
    sweep $scene size $variant "$(power $size)" "$(power $((size - 8)))"
    sweep $scene bf $variant "$(power $bf)" "$(power $((bf - 8)))"
  done
  sweep $scene size2 original "$(power $((2 * size)))" "$(power $((2 * (size - 8))))"
  sweep $scene l1-grid original "$(power $l1)" "$(power $grid)"
done
awk -F, 'NR == 1 { print "| scene | oracle | variant | ε | N | L | a | b | c | R² | slope | L/N² |"
                   print "|---|---|---|---|---|---|---|---|---|---|---|---|"; next }
         { printf "| %s | %s | %s | %.3g … %.3g | %d … %d | %d … %d | %s | %s | %s | %s | %s | %s … %s |\n",
             $1, $2, $3, $5, $6, $7, $8, $9, $10, $11, $12, $13, $14, $15, $16, $17 }' "$out/fits.csv" \
  >"$out/fits.md"

# Figures 7 and 8, and all oracles side by side.
plot figure-7 640 900 <<END
set multiplot layout 2,1
$(diagram par-near)
$(diagram par-far)
END
plot figure-8 640 900 <<END
set multiplot layout 2,1
$(diagram orth-near)
$(diagram orth-far)
END
plot oracles 1000 900 <<END
set multiplot layout 2,2 margins 0.11,0.98,0.17,0.94 spacing 0.13,0.16
$(comparison par-near "set key at screen 0.53, screen 0.045 center center maxrows 2 reverse Left samplen 1 font ',15' width 2")
$(comparison par-far "unset key")
$(comparison orth-near "unset key")
$(comparison orth-far "unset key")
END

# The law beside dots and fit, with the oracle of the analysis.
"$hr2d" study "$scenes/par-near.geojson" --law --to 0.00390625 --steps "$steps" --quiet \
  --plot "$out/law.png"

all_methods=size,size2,bf,l1,l1-grid,bounds,multigrid,order-2,order-4,order-8,order-16,auto,auto-solve,factors
few_methods=size,multigrid,order-4,auto,auto-solve,factors
# cost NAME SCENE [METHODS]: seconds and links against error, with the rows; for each method a row of
# cost-table.md: of the runs that come to an error the quickest, its seconds and links
cost() {
  [ -s "$data/cost-$1.json" ] ||
    "$hr2d" cost "$2" --max-seconds "$cost_seconds" --quiet --against seconds,links \
      --methods "${3:-$all_methods}" \
      --plot "$out/cost-$1.svg" --csv "$out/cost-$1.csv" --json "$data/cost-$1.json"
  awk -F, -v scene="$1" -v wanted="1e-2 1e-3 1e-4 1e-6 1e-9 1e-12" '
    function say(s) {
      if (s >= 1) return sprintf("%.2g s", s)
      return s < 0.01 ? sprintf("%.2g ms", 1e3 * s) : sprintf("%.0f ms", 1e3 * s) }
    BEGIN { n = split(wanted, target, " ") }
    NR > 1 { if (!($1 in known)) { known[$1] = 1; method[++methods] = $1 }
             for (k = 1; k <= n; k++)
               if ($8 <= target[k] && (!(($1, k) in links) || $7 < time[$1, k])) {
                 links[$1, k] = $5; time[$1, k] = $7 } }
    END { for (m = 1; m <= methods; m++) {
            printf "| %s | %s |", scene, method[m]
            for (k = 1; k <= n; k++)
              if ((method[m], k) in links)
                printf " %s, %d |", say(time[method[m], k]), links[method[m], k]
              else printf " |"
            print "" } }' "$out/cost-$1.csv" >>"$out/cost-table.md"
}
# exponents NAME SCENE: the powers of L in 1/error, into a column of exponents.md
names=
exponents() {
  names="$names $1"
  [ -s "$data/exponents-$1.txt" ] || "$hr2d" cost "$2" --exponents >"$data/exponents-$1.txt"
}
# exponent_table: a row for each oracle, variant, order and closure, a column for each scene
exponent_table() {
  for name in $names; do sed "s/^/$name /" "$data/exponents-$name.txt"; done | awk -v names="$names" '
    BEGIN { scenes = split(names, scene, " ") }
    $2 ~ /^(size|size2|bf|l1|bounds)$/ && $4 ~ /^[0-9]+$/ {
      row = $2 " | " $3 " | " $4 " | " $5
      if (!(row in known)) { known[row] = 1; order[++rows] = row }
      if (/error\^-/) { sub(/.*\^-/, "", $8)
                       cell[row, $1] = sprintf("%.2f ± %.2f", $8, ($11 - $9) / 2) } }
    END { printf "| oracle | variant | order | closure |"
          for (k = 1; k <= scenes; k++) printf " %s |", scene[k]
          printf "\n|---|---|---|---|"
          for (k = 1; k <= scenes; k++) printf "---|"
          print ""
          for (m = 1; m <= rows; m++) {
            printf "| %s |", order[m]
            for (k = 1; k <= scenes; k++) printf " %s |", cell[order[m], scene[k]]
            print "" } }' >"$out/exponents.md"
}
{
  echo "| scene | method | 1e-2 | 1e-3 | 1e-4 | 1e-6 | 1e-9 | 1e-12 |"
  echo "|---|---|---|---|---|---|---|---|"
} >"$out/cost-table.md"
cost par-near "$scenes/par-near.geojson"
cost par-far "$scenes/par-far.geojson"
cost orth-near "$scenes/orth-near.geojson"
cost corner "$scenes/corner.geojson"
cost square-room "$scenes/square-room.geojson"
cost screened-room "$screened"
cost boxes-3 "$crowded/boxes-3.geojson"
cost fibres-30 "$crowded/fibres-30.geojson" "$few_methods"

# oracles NAME SCENE: links of four oracles against error
oracles() {
  "$hr2d" cost "$2" --methods size,l1,bf,bounds --max-seconds 12 --quiet --against links \
    --plot "$out/cost-oracles-$1.svg" --csv "$out/cost-oracles-$1.csv"
}
oracles par-near "$scenes/par-near.geojson"
oracles corner "$scenes/corner.geojson"
oracles square-room "$scenes/square-room.geojson"
oracles screened-room "$screened"

exponents par-near "$scenes/par-near.geojson"
exponents par-far "$scenes/par-far.geojson"
exponents orth-near "$scenes/orth-near.geojson"
exponents corner "$scenes/corner.geojson"
exponents square-room "$scenes/square-room.geojson"
exponents screened-room "$screened"
exponents boxes-3 "$crowded/boxes-3.geojson"
exponent_table
