# Draws curves as a picture, a PPM in text. Variables: low and high, the wavelengths at the ends of the
# horizontal axis; bottom and top, the values at those of the vertical one; step_nm and step, of
# ticks and numbers; width and height, in pixels; colours, one for each file, as "r g b" from 0 to
# 255, with commas between. Files: curves (spd(5)), of which the first column is drawn.
#
# The axes run from pixel left,foot, which is low and bottom, to right,head, which is high and top:
# 40,height-21 to width-11,10.

function least(a, b) {
  return a < b ? a : b
}
function most(a, b) {
  return a > b ? a : b
}

# Lays a colour over a pixel, with a share.
function ink(x, y, share, red, green, blue, at) {
  if (x < 0 || y < 0 || x >= width || y >= height || share <= 0) return
  at = y * width + x
  share = least(share, 1)
  of[at, 0] += share * (red - of[at, 0])
  of[at, 1] += share * (green - of[at, 1])
  of[at, 2] += share * (blue - of[at, 2])
}

# How much of a pixel a line covers whose middle is so far away.
function covers(distance, thick) {
  return most(0, least(1, thick / 2 + 0.5 - distance))
}

# What a piece of a curve covers, in cover: of several pieces the most.
function piece(x0, y0, x1, y1, thick, x, y, t, square, distance) {
  square = (x1 - x0) ^ 2 + (y1 - y0) ^ 2
  for (y = int(least(y0, y1) - thick); y <= most(y0, y1) + thick; y++)
    for (x = int(least(x0, x1) - thick); x <= most(x0, x1) + thick; x++) {
      t = square > 0 ? most(0, least(1, ((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / square)) : 0
      distance = sqrt((x - x0 - t * (x1 - x0)) ^ 2 + (y - y0 - t * (y1 - y0)) ^ 2)
      cover[x, y] = most(cover[x, y], covers(distance, thick))
    }
}

# A number, its last pixel at x; digits are 3 x 5 pixels.
function number(text, x, y, i, row, column, glyph) {
  for (i = length(text); i > 0; i--) {
    glyph = font[substr(text, i, 1)]
    x -= length(glyph) / 5
    for (row = 0; row < 5; row++)
      for (column = 0; column < length(glyph) / 5; column++)
        if (substr(glyph, row * length(glyph) / 5 + column + 1, 1) == "#") ink(x + column, y + row, 1, 0, 0, 0)
    x--
  }
}

function place_x(nm) {
  return left + (nm - low) / (high - low) * (right - left)
}
function place_y(value) {
  return foot + (value - bottom) / (top - bottom) * (head - foot)
}

function finish_curve(i, key, at, xy) {
  if (!points) return
  for (i = 1; i < points; i++)
    if (nm[i + 1] >= low && nm[i] <= high)
      piece(place_x(nm[i]), place_y(value[i]), place_x(nm[i + 1]), place_y(value[i + 1]), 2)
  split(colour[curve], at, " ")
  for (key in cover) {
    split(key, xy, SUBSEP)
    if (xy[1] >= left && xy[1] <= right) ink(xy[1], xy[2], cover[key], at[1], at[2], at[3])
  }
  split("", cover)
  points = 0
}

BEGIN {
  split(colours, colour, ",")
  left = 40; right = width - 11; head = 10; foot = height - 21
  font["0"] = "####.##.##.####"; font["1"] = ".#.##..#..#.###"; font["2"] = "###..#####..###"
  font["3"] = "###..#.##..####"; font["4"] = "#.##.####..#..#"; font["5"] = "####..###..####"
  font["6"] = "####..####.####"; font["7"] = "###..#.#..#..#."; font["8"] = "####.#####.####"
  font["9"] = "####.####..####"; font["."] = "....#"; font["-"] = "......###......"
  for (i = 0; i < width * height; i++) of[i, 0] = of[i, 1] = of[i, 2] = 255
}

FNR == 1 { finish_curve(); curve++ }
/^[0-9]/ { points++; nm[points] = $1; value[points] = $2 }

END {
  finish_curve()
  for (x = left; x <= right; x++) ink(x, foot, 1, 0, 0, 0)
  for (y = head; y <= foot; y++) ink(left, y, 1, 0, 0, 0)
  for (v = bottom; v <= top + step / 1e6; v += step) {
    y = int(place_y(v) + 0.5)
    for (i = 1; i <= 4; i++) ink(left - i, y, 1, 0, 0, 0)
    number(sprintf("%.6g", v > -step / 1e6 && v < step / 1e6 ? 0 : v), left - 6, y - 2)
  }
  for (v = step_nm * int((low + step_nm - 1) / step_nm); v <= high; v += step_nm) {
    x = int(place_x(v) + 0.5)
    for (i = 1; i <= 4; i++) ink(x, foot + i, 1, 0, 0, 0)
    number(v "", x + 6, foot + 8)
  }
  printf "P3\n%d %d\n255\n", width, height
  for (i = 0; i < width * height; i++) print int(of[i, 0] + 0.5), int(of[i, 1] + 0.5), int(of[i, 2] + 0.5)
}
