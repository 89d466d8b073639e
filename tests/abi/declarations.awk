# Prints one line per GPGP_API function of the headers given: NAME, a tab, its parameters, a tab, the comment before it
# on one line. Functions that follow each other without a blank line or another comment share the comment.
function flush_comment() { comment = "" }
/^[ \t]*\/\*\*/ { comment = ""; inside = 1 }
inside {
  line = $0
  sub(/^[ \t]*(\/\*\*|\*)?[ \t]*/, "", line)
  ended = sub(/[ \t]*\*\/.*$/, "", line)
  comment = comment (comment == "" ? "" : " ") line
  if (ended) inside = 0
  next
}
/^GPGP_API/ { declaration = ""; open = 1 }
open {
  declaration = declaration " " $0
  if ($0 !~ /;/) next
  open = 0
  name = declaration
  sub(/\(.*$/, "", name)
  sub(/^.*[ \t*]/, "", name)
  parameters = declaration
  sub(/^[^(]*\(/, "", parameters)
  sub(/\);.*$/, "", parameters)
  gsub(/[ \t]+/, " ", parameters)
  print name "\t" parameters "\t" comment
  next
}
/^[ \t]*$/ || /^typedef/ || /^#/ { flush_comment() }
