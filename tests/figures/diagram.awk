# Draws a chromaticity diagram as an SVG picture. Files: first the colour-matching functions (spd(5),
# columns x y z), then lines
#   triangle NAME rx ry gx gy bx by     of a display's primaries
#   point NAME x y
# Inside the spectrum locus a cell has the colour of sRGB (IEC 61966-2-1:1999) of its chromaticity, as
# bright as sRGB can, and desaturated where it cannot: what is there is a guide, not the colour.
BEGIN {
  scale = 580; left = 60; foot = 610; cell = 0.01
  split("#ffffff #000000 #8e1b1b #1b2f8e #6b4a00 #00594f", colour, " ")
}
function px(x) { return left + scale * x }
function py(y) { return foot - scale * y }

function locus(i, points) {
  for (i = 1; i <= n; i++) points = points sprintf("%.2f,%.2f ", px(lx[i]), py(ly[i]))
  return points
}

# Whether a chromaticity lies within the locus and the line of purples: rays to the right that cross.
function inside(x, y, i, j, crossings) {
  for (i = 1; i <= n; i++) {
    j = i % n + 1
    if ((ly[i] > y) != (ly[j] > y) && x < lx[i] + (y - ly[i]) * (lx[j] - lx[i]) / (ly[j] - ly[i])) crossings++
  }
  return crossings % 2
}

function code(v) {
  v = v <= 0.0031308 ? 12.92 * v : 1.055 * exp(log(v) / 2.4) - 0.055
  return v <= 0 ? 0 : v >= 1 ? 255 : int(255 * v + 0.5)
}

function shade(x, y, X, Z, r, g, b, low, high) {
  X = x / y; Z = (1 - x - y) / y
  r = 3.2409699419 * X - 1.5373831776 - 0.4986107603 * Z
  g = -0.9692436363 * X + 1.8759675015 + 0.0415550574 * Z
  b = 0.0556300797 * X - 0.2039769589 + 1.0569715142 * Z
  low = r < g ? r : g; low = b < low ? b : low
  if (low < 0) { r -= low; g -= low; b -= low }
  high = r > g ? r : g; high = b > high ? b : high
  return sprintf("#%02x%02x%02x", code(r / high), code(g / high), code(b / high))
}

FNR == NR && /^[0-9]/ && $1 >= 380 && $1 <= 700 {
  n++
  nm[n] = $1; lx[n] = $2 / ($2 + $3 + $4); ly[n] = $3 / ($2 + $3 + $4)
}
FNR != NR && $1 == "triangle" { triangle[++triangles] = $0 }
FNR != NR && $1 == "point" { point[++points] = $0 }

END {
  if (n < 3 || !triangles || !points) exit 1
  printf "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"560\" height=\"680\" font-family=\"sans-serif\" font-size=\"11\">\n"
  printf "<rect width=\"560\" height=\"680\" fill=\"#9a9a9a\"/>\n"
  printf "<clipPath id=\"locus\"><polygon points=\"%s\"/></clipPath>\n", locus()
  printf "<g shape-rendering=\"crispEdges\" clip-path=\"url(#locus)\">\n"
  for (y = cell / 2; y < 0.9; y += cell)
    for (x = cell / 2; x < 0.8; x += cell)
      if (inside(x, y) || inside(x - cell, y) || inside(x + cell, y) || inside(x, y - cell) || inside(x, y + cell)) printf "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"%s\"/>\n", \
        px(x - cell / 2), py(y + cell / 2), scale * cell, scale * cell, shade(x, y)
  print "</g>"
  for (t = 0; t <= 0.8001; t += 0.1) {
    printf "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%.1f</text>\n", px(t), foot + 16, t
    printf "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%.1f</text>\n", left - 6, py(t) + 4, t
    printf "<path d=\"M%.1f %d V%d M%d %.1f H%d\" stroke=\"#ffffff\" stroke-opacity=\"0.3\"/>\n", \
      px(t), foot, py(0.9), left, py(t), px(0.8)
  }
  printf "<text x=\"%.1f\" y=\"%d\">x</text><text x=\"8\" y=\"%.1f\">y</text>\n", px(0.4), foot + 34, py(0.45)
  printf "<polygon fill=\"none\" stroke=\"#000000\" points=\"%s\"/>\n", locus()
  for (i = 1; i <= n; i++) if (nm[i] % 20 == 0 && nm[i] >= 460 && nm[i] <= 620)
    printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"2\"/><text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">%d</text>\n", px(lx[i]), py(ly[i]), \
      px(lx[i]) + (nm[i] < 520 ? -6 : 6), py(ly[i]) - 3, nm[i] < 520 ? "end" : "start", nm[i]
  for (k = 1; k <= triangles; k++) {
    split(triangle[k], f, " ")
    printf "<polygon fill=\"none\" stroke=\"%s\" stroke-width=\"1.8\" points=\"%.2f,%.2f %.2f,%.2f %.2f,%.2f\"/>\n", \
      colour[k], px(f[3]), py(f[4]), px(f[5]), py(f[6]), px(f[7]), py(f[8])
    printf "<text x=\"%d\" y=\"%d\" font-size=\"13\" fill=\"%s\">%s</text>\n", px(0.58), py(0.9) + 17 * k, colour[k], f[2]
  }
  for (k = 1; k <= points; k++) {
    split(point[k], f, " ")
    printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"2.5\" fill=\"#ffffff\" stroke=\"#000000\"/><text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">%s</text>\n", \
      px(f[3]), py(f[4]), px(f[3]) + (f[3] < 0.32 ? -5 : 5), py(f[4]) + (f[3] < 0.32 && f[4] > 0.32 ? -2 : 12), \
      f[3] < 0.32 ? "end" : "start", f[2]
  }
  print "</svg>"
}
