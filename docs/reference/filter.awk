# What Doxygen is given of a file: awk -v root=PROJECT -f filter.awk FILE
#
#   headers    the first comment becomes the file's description, laid out as it is (Doxygen lists functions of described
#              files alone)
#   Markdown   headings and links to them get names that are the page's own, as `guide_ui_hit-tests`; links to pages go
#              to the page; links to other files become their text
function slug(text, made, i, c) { # as GitHub names a heading
  text = tolower(text)
  made = ""
  for (i = 1; i <= length(text); ++i) {
    c = substr(text, i, 1)
    if (c ~ /[a-z0-9_-]/) made = made c
    else if (c == " ") made = made "-"
  }
  return made
}
function normal(path, parts, count, kept, i, made) { # without . and ..
  count = split(path, parts, "/")
  kept = 0
  for (i = 1; i <= count; ++i) {
    if (parts[i] == "" || parts[i] == ".") continue
    if (parts[i] == "..") { if (kept > 0) --kept; continue }
    stack[++kept] = parts[i]
  }
  made = ""
  for (i = 1; i <= kept; ++i) made = made (i > 1 ? "/" : "") stack[i]
  return made
}
function pageName(path) { # docs/guide/ui.md: guide_ui
  sub(/^docs\//, "", path)
  sub(/\.md$/, "", path)
  gsub(/[\/.]/, "_", path)
  return path
}
function link(text, target, file, anchor, at, name) {
  if (target ~ /^[a-z]+:/) return "[" text "](" target ")"
  at = index(target, "#")
  file = at ? substr(target, 1, at - 1) : target
  anchor = at ? substr(target, at + 1) : ""
  file = file == "" ? own : normal(folder "/" file)
  if (file !~ /\.md$/ || file !~ /^(docs|integrations)\//) return text
  name = pageName(file)
  gsub(/`/, "", text) # which links to names show as they are
  if (anchor != "") return "[" text "](@ref " name "_" anchor ")"
  return file == "docs/README.md" ? "[" text "](index.html)" : "[" text "](@ref " name ")"
}
function links(line, made, open, rest, middle, close_, text, target) {
  made = ""
  while (match(line, /!?\[[^]]*\]\([^() ]*\)/)) {
    made = made substr(line, 1, RSTART - 1)
    rest = substr(line, RSTART, RLENGTH)
    line = substr(line, RSTART + RLENGTH)
    middle = index(rest, "](")
    if (substr(rest, 1, 1) == "!") { # from docs/pictures, a copy of which lies beside the pages
      target = normal(folder "/" substr(rest, middle + 2, length(rest) - middle - 2))
      sub(/^docs\//, "", target)
      made = made substr(rest, 1, middle + 1) target ")"
      continue
    }
    text = substr(rest, 2, middle - 2)
    target = substr(rest, middle + 2, length(rest) - middle - 2)
    made = made link(text, target)
  }
  return made line
}
function spans(line, parts, count, i, made) { # Doxygen ends a code span at an apostrophe, and finds commands in it
  count = split(line, parts, "`")
  if (count % 2 == 0) { # a span goes on in the next line
    gsub(/@/, "\\@", line)
    return line
  }
  for (i = 1; i <= count; i += 2) gsub(/@/, "\\@", parts[i])
  made = parts[1]
  for (i = 2; i <= count; i += 2) {
    if (parts[i] ~ /[@\047]/) {
      gsub(/&/, "\\&amp;", parts[i])
      gsub(/</, "\\&lt;", parts[i])
      gsub(/@/, "\\&#64;", parts[i])
      made = made "<code>" parts[i] "</code>" parts[i + 1]
    } else {
      made = made "`" parts[i] "`" parts[i + 1]
    }
  }
  return made
}
NR == 1 {
  own = FILENAME
  if (index(own, root "/") == 1) own = substr(own, length(root) + 2)
  folder = own
  sub(/\/[^\/]*$/, "", folder)
  markdown = own ~ /\.md$/
}
!markdown && NR == 1 && /^\/\* / {
  sub(/^\/\* */, "")
  intro = !sub(/ *\*\/.*/, "")
  print "/** @verbatim " $0 (intro ? "" : " @endverbatim @file */") # lines keep their numbers
  next
}
!markdown {
  if (intro) {
    last = sub(/ *\*\/.*/, "")
    sub(/^ \*? ?/, "")
    print $0 (last ? " @endverbatim @file */" : "")
    intro = !last
    next
  }
  gsub(/@axiom/, "\\@axiom") # a name of the language, no tag
  print
  next
}
/^ *```/ { fenced = !fenced; print; next }
fenced { print; next }
{
  gsub(/src="\.\.\/pictures\//, "src=\"pictures/")
  $0 = links(spans($0))
}
/^#+ / {
  depth = index($0, " ") - 1
  title = substr($0, depth + 2)
  plain = title
  gsub(/`/, "", plain)
  name = depth == 1 && !titled ? pageName(own) : pageName(own) "_" slug(plain)
  titled = 1
  print $0 " {#" name "}"
  next
}
{ print }
