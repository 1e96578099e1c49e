# series.awk - columns of numbers as an SVG picture, lines over the first column
# usage: awk -f series.awk -v across=TEXT -v up=TEXT [-v bottom=B] [-v top=T] [-v step=S] [-v tick=S] FILE
# The file begins with "# columns: X NAME..."; "-" is where a line has a gap. across and up name the
# axes; the vertical one goes from bottom (0) to top (the greatest value), with ticks of step and tick.
BEGIN { width = 640; height = 320; left = 56; right = 10; head = 10; foot = 40; split("#c0392b #1b6ca8 #2e8b57 #8e44ad", colour, " ") }
/^# columns:/ { for (i = 4; i <= NF; i++) named[i - 3] = $i; lines = NF - 3 }
/^[0-9]/ {
  x[++count] = $1
  for (i = 1; i <= lines; i++) {
    y[i, count] = $(i + 1)
    if ($(i + 1) != "-" && $(i + 1) + 0 > most) most = $(i + 1) + 0
  }
}
END {
  if (!lines || count < 2) exit 1
  if (top == "") top = most
  if (!step) step = (top - bottom) / 5
  if (!tick) tick = (x[count] - x[1]) / 8
  w = width - left - right; h = height - head - foot
  printf "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" font-family=\"sans-serif\" font-size=\"12\">\n", width, height
  printf "<rect width=\"%d\" height=\"%d\" fill=\"white\"/>\n", width, height
  for (v = tick * int((x[1] + tick - 1e-9) / tick); v <= x[count] + 1e-9; v += tick) {
    at = left + w * (v - x[1]) / (x[count] - x[1])
    printf "<line x1=\"%.1f\" y1=\"%d\" x2=\"%.1f\" y2=\"%d\" stroke=\"#ddd\"/>\n", at, head, at, head + h
    printf "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%g</text>\n", at, head + h + 16, v
  }
  for (v = bottom; v <= top + 1e-9; v += step) {
    at = head + h * (top - v) / (top - bottom)
    printf "<line x1=\"%d\" y1=\"%.1f\" x2=\"%d\" y2=\"%.1f\" stroke=\"#ddd\"/>\n", left, at, left + w, at
    printf "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%g</text>\n", left - 5, at + 4, v
  }
  printf "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">%s</text>\n", left + w / 2, height - 6, across
  printf "<text x=\"14\" y=\"%d\" text-anchor=\"middle\" transform=\"rotate(-90 14 %d)\">%s</text>\n", head + h / 2, head + h / 2, up
  for (i = 1; i <= lines; i++) {
    open = 0
    for (k = 1; k <= count; k++) {
      inside = y[i, k] != "-" && y[i, k] >= bottom && y[i, k] <= top
      if (inside && !open) printf "<polyline fill=\"none\" stroke=\"%s\" stroke-width=\"1.5\" points=\"", colour[i]
      if (inside) printf "%.2f,%.2f ", left + w * (x[k] - x[1]) / (x[count] - x[1]), head + h * (top - y[i, k]) / (top - bottom)
      if (open && !inside) printf "\"/>\n"
      open = inside
    }
    if (open) printf "\"/>\n"
    printf "<text x=\"%d\" y=\"%d\" fill=\"%s\">%s</text>\n", left + w / 2 - 24, head + h - 8 - 16 * (lines - i), colour[i], named[i]
  }
  printf "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" fill=\"none\" stroke=\"black\"/>\n</svg>\n", left, head, w, h
}
