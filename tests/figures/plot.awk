# plot.awk - lines of numbers as an SVG picture
# usage: awk -f plot.awk [-v across=TEXT] [-v tick=S] [-v up=TEXT -v top=T [-v bottom=B] [-v step=S]] FILE...
# Each column of each file is a line over the first column; their names are in a line "# columns: X NAME...",
# and "-" is a gap. across (nm) names the horizontal axis, which has a tick every tick. With top, the vertical
# axis goes from bottom (0) to there, is called up, and has ticks every step; without it each line is drawn
# over its own greatest value, and named by that and its file, too.
BEGIN {
  width = 640; height = 320; right = 10; head = 10; foot = 40
  left = top == "" ? 40 : 56
  if (across == "") across = "nm"
  split((top == "" ? "#1b6ca8 #c0392b" : "#c0392b #1b6ca8") " #2e8b57 #8e44ad #d68910 #555555", colour, " ")
}
FNR == 1 { file = FILENAME; sub(/.*\//, "", file); sub(/\.spd$/, "", file); base = lines }
/^# columns:/ { for (i = 4; i <= NF; i++) named[base + i - 3] = $i }
/^[0-9]/ {
  if (low == "" || $1 + 0 < low) low = $1 + 0
  if ($1 + 0 > high) high = $1 + 0
  for (i = 2; i <= NF; i++) {
    line = base + i - 1
    if (line > lines) lines = line
    of[line] = file
    x[line, ++count[line]] = $1
    y[line, count[line]] = $i
    if ($i != "-" && $i + 0 > most[line]) most[line] = $i + 0
  }
}
function place_x(v) { return left + w * (v - low) / (high - low) }
function place_y(v, least, greatest) { return head + h * (greatest - v) / (greatest - least) }

# The pieces of a line between its gaps, and what is beyond the axis.
function draw(line, least, greatest, k, inside, open) {
  for (k = 1; k <= count[line]; k++) {
    inside = y[line, k] != "-" && (top == "" || (y[line, k] >= least && y[line, k] <= greatest))
    if (inside && !open) printf "<polyline fill=\"none\" stroke=\"%s\" stroke-width=\"1.5\" points=\"", colour[(line - 1) % 6 + 1]
    if (inside) printf "%.2f,%.2f ", place_x(x[line, k]), place_y(y[line, k], least, greatest)
    if (open && !inside) printf "\"/>\n"
    open = inside
  }
  if (open) printf "\"/>\n"
}
END {
  if (!lines || !(high > low)) exit 1
  head += 16 * lines; height += 16 * lines # names of lines stand above, where they cover none
  w = width - left - right; h = height - head - foot
  if (!tick) tick = high - low > 900 ? 200 : high - low > 200 ? 50 : high - low > 40 ? 10 : 1
  printf "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" font-family=\"sans-serif\" font-size=\"12\">\n", width, height
  printf "<rect width=\"%d\" height=\"%d\" fill=\"white\"/>\n", width, height
  for (v = tick * int((low + tick - 1e-9) / tick); v <= high + 1e-9; v += tick) {
    printf "<line x1=\"%.1f\" y1=\"%d\" x2=\"%.1f\" y2=\"%d\" stroke=\"#ddd\"/>\n", place_x(v), head, place_x(v), head + h
    printf "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%g</text>\n", place_x(v), head + h + 16, v
  }
  printf "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">%s</text>\n", left + w / 2, height - 6, across
  if (top != "") {
    if (!step) step = (top - bottom) / 5
    for (v = bottom + 0; v <= top + 1e-9; v += step) {
      at = place_y(v, bottom, top)
      printf "<line x1=\"%d\" y1=\"%.1f\" x2=\"%d\" y2=\"%.1f\" stroke=\"#ddd\"/>\n", left, at, left + w, at
      printf "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%g</text>\n", left - 5, at + 4, v
    }
    printf "<text x=\"14\" y=\"%d\" text-anchor=\"middle\" transform=\"rotate(-90 14 %d)\">%s</text>\n", head + h / 2, head + h / 2, up
  }
  for (line = 1; line <= lines; line++) {
    if (top == "") draw(line, 0, most[line] > 0 ? most[line] : 1)
    else draw(line, bottom, top)
    printf "<text x=\"%d\" y=\"%d\" fill=\"%s\">%s</text>\n", left + 8, 16 * line, colour[(line - 1) % 6 + 1], \
      top == "" ? of[line] " " named[line] ", to " sprintf("%.3g", most[line]) : named[line]
  }
  printf "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" fill=\"none\" stroke=\"black\"/>\n</svg>\n", left, head, w, h
}
