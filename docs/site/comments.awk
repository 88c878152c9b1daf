# Makes comments of a header into descriptions for Doxygen, which sees only those with a mark. Lines of comment belong
# to the declaration below them; above a namespace, or apart at the beginning, to the file. A comment behind a
# declaration belongs to that.
function give(kind,   k) {
  if (lines && kind == "file") print indent "/// @file"
  for (k = 1; k <= lines; ++k) print indent (kind == "" ? "//" : "///") block[k]
  lines = 0
}
match($0, /^ *\/\//) {
  if (RLENGTH == behind) {
    sub(/\/\//, "///<")
    print
  } else {
    indent = substr($0, 1, RLENGTH - 2)
    block[++lines] = substr($0, RLENGTH + 1)
    behind = 0
  }
  next
}
{
  if (/^namespace / || (/^$/ && !declared)) give("file")
  else if (/^$/) give("")
  else if (match($0, /\{ +\/\/ /) && /^ *(struct|class|enum) /) {
    indent = substr($0, 1, match($0, /[^ ]/) - 1)
    match($0, /\{ +\/\/ /)
    block[++lines] = " " substr($0, RSTART + RLENGTH)
    $0 = substr($0, 1, RSTART)
    give("declaration")
  } else give("declaration")
  behind = match($0, /[;,] +\/\/ /) ? RSTART + RLENGTH - 2 : 0
  if (behind) sub(/\/\/ /, "///< ")
  if (!/^$|^#|^namespace /) declared = 1
  print
}
END { give("") }
