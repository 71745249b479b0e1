# SPDX-License-Identifier: BSD-3-Clause
# Turns the output of "PROGRAM [COMMAND] --help" (CLI11's form) into a manual page, or into a
# command's sub-section of its program's page.
#   -v program=NAME -v command=NAME or "" -v version=X

function escape(text) {
  gsub(/\\/, "\\e", text)
  gsub(/-/, "\\-", text)
  if (text ~ /^[.']/) text = "\\&" text
  return text
}

# "-h,--help" or "--out DIR": the flag bold, its argument in italics.
function term(text,    space) {
  sub(/ (Excludes|Needs):.*/, "", text)
  sub(/ REQUIRED/, "", text)
  space = index(text, " ")
  if (space == 0) return "\\fB" escape(text) "\\fR"
  return "\\fB" escape(substr(text, 1, space - 1)) "\\fR \\fI" escape(substr(text, space + 1)) "\\fR"
}

NR == 1 { sub(/^Ergocast: /, ""); summary = $0; next }
/^Usage: / {
  usage = substr($0, 8)
  if (command == "") {
    what = summary
    sub(/\.$/, "", what)
    printf ".TH %s 1 \"\" \"Ergocast %s\" \"Ergocast\"\n", toupper(escape(program)), version
    printf ".SH NAME\n%s \\- %s\n.SH SYNOPSIS\n.B %s\n", escape(program), escape(what), escape(usage)
  } else {
    printf ".SS %s\n%s.\n.PP\n.B %s\n", escape(command), escape(summary), escape(usage)
  }
  next
}
usage == "" { summary = summary " " $0; next }
/^[A-Z][A-Za-z]*:$/ {
  section = $0
  if (/^Options/ && command == "") print ".SH OPTIONS"
  if (/^Positionals/ && command == "") print ".SH ARGUMENTS"
  next
}
/^ *$/ { section = ""; next }
section ~ /^Subcommands/ { next }
section != "" && /^  [^ ]/ {
  hidden = command != "" && /^  (-h|--version)/
  if (hidden) next
  at = match($0, /[^ ]  +[^ ]/)
  if (at == 0) {
    printf ".TP\n%s\n%s", term(substr($0, 3)), / REQUIRED/ ? "Required.\n" : ""
    next
  }
  required = /^  -.* REQUIRED /
  printf ".TP\n%s\n%s%s\n", term(substr($0, 3, at - 2)), required ? "Required. " : "",
    escape(substr($0, at + RLENGTH - 1))
  next
}
section != "" { sub(/^ +/, ""); if (!hidden) print escape($0); next }
# The text below all options.
{
  if (!noted++) print command == "" ? ".SH NOTES" : ".PP"
  print escape($0)
}
