# plot.awk - curves as an SVG picture
# usage: awk -f plot.awk [title=TEXT] FILE.spd...   (several columns are several lines)
# Each column is drawn over its own greatest value, named by the file and the column; from 0 up.
BEGIN {
  width = 640; height = 320; left = 40; right = 10; top = 10; bottom = 40
  split("#1b6ca8 #c0392b #2e8b57 #8e44ad #d68910 #555555", colour, " ")
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
    if ($i + 0 > most[line]) most[line] = $i + 0
  }
}
END {
  if (!lines || !(high > low)) exit 1
  printf "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" font-family=\"sans-serif\" font-size=\"12\">\n", width, height
  printf "<rect width=\"%d\" height=\"%d\" fill=\"white\"/>\n", width, height
  w = width - left - right; h = height - top - bottom
  step = high - low > 900 ? 200 : high - low > 200 ? 50 : high - low > 40 ? 10 : 1
  for (nm = int((low + step - 0.001) / step) * step; nm <= high; nm += step) {
    at = left + w * (nm - low) / (high - low)
    printf "<line x1=\"%.1f\" y1=\"%d\" x2=\"%.1f\" y2=\"%d\" stroke=\"#ddd\"/>\n", at, top, at, top + h
    printf "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%g</text>\n", at, top + h + 16, nm
  }
  printf "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">nm</text>\n", left + w / 2, height - 6
  for (line = 1; line <= lines; line++) {
    printf "<polyline fill=\"none\" stroke=\"%s\" stroke-width=\"1.5\" points=\"", colour[(line - 1) % 6 + 1]
    for (i = 1; i <= count[line]; i++)
      printf "%.2f,%.2f ", left + w * (x[line, i] - low) / (high - low), \
        top + h * (1 - y[line, i] / (most[line] > 0 ? most[line] : 1))
    printf "\"/>\n<text x=\"%d\" y=\"%d\" fill=\"%s\">%s %s, to %.3g</text>\n", left + 8, top + 16 * line, \
      colour[(line - 1) % 6 + 1], of[line], named[line], most[line]
  }
  printf "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" fill=\"none\" stroke=\"black\"/>\n</svg>\n", left, top, w, h
}
