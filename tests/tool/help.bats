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

@test "a default is not torn apart, and what is quoted can be copied" {
  specfilm --help | grep -qF "'air | (TiO2 60nm | SiO2 95nm)^8 | N-BK7'"
  specdisc --help | grep -qE '^ +\(default: 0deg\)$'
}
