#!/usr/bin/env bats
# What every tool says of itself: --help beside the terminal's width and the tool's page.

load common

@test "--help is no wider than a terminal of 80 columns" {
  for source in "$ROOT"/cmd/*.c; do
    tool=$(basename "$source" .c)
    "$tool" --help >help
    [ "$(grep -c '^  -\|^      --' help)" -ge 15 ]
    if grep -nE '.{81}| $' help; then complain "$tool"; fi
  done
}

@test "the page of every tool has each option of --help, and no other" {
  for source in "$ROOT"/cmd/*.c; do
    tool=$(basename "$source" .c)
    "$tool" --help | sed -nE 's/^  (-., |    )--([a-z0-9-]+).*/\2/p' | sort -u >help
    grep '^\.It ' "$ROOT/man/$tool.1" | grep -o 'Fl Fl [a-z0-9-]*' | cut -c7- | sort -u >page
    diff help page || complain "$tool"
  done
}

# Each option as "LETTER NAME", with a "+" where it has an argument.
options_of_help() {
  awk '/^  (-.,|   ) --/ {
    name = substr($0, 9); sub(/ .*/, "", name)
    print ($1 ~ /,$/ ? substr($1, 2, 1) " " : "") name (substr($0, 9 + length(name)) ~ /^ [^ ]/ ? " +" : "")
  }' | sort
}

# The same of a page: .It Fl o , Fl Fl output Ar FILE
options_of_page() {
  awk '/^\.Sh/ { on = $2 == "OPTIONS" }
  on && /^\.It Fl/ {
    letter = ""
    for (i = 2; i <= NF; i++) {
      if ($i != "Fl") continue
      if ($(++i) != "Fl") { letter = $i " "; continue }
      print letter $(++i) ($(i + 1) == "Ar" || $(i + 1) == "Cm" ? " +" : "")
      letter = ""
    }
  }' "$1" | sort -u
}

@test "the page of every tool has the letters of --help, and arguments where it has them" {
  for source in "$ROOT"/cmd/*.c; do
    tool=$(basename "$source" .c)
    "$tool" --help | options_of_help >help
    options_of_page "$ROOT/man/$tool.1" >page
    diff help page || complain "$tool"
  done
}

@test "a default is not torn apart, and what is quoted can be copied" {
  specfilm --help | grep -qF "'air | (TiO2 60nm | SiO2 95nm)^8 | N-BK7'"
  specdisc --help | grep -qE '^ +\(default: 0deg\)$'
}
