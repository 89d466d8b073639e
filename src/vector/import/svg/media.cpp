// Types, and the features of colour and motion; sizes of the window are not known. One query: [not | only] type and
// (feature) and (feature). Where "or", ranges or brackets in brackets are, nothing can be told.
#include "vector/import/svg/media.h"

#include "vector/import/svg/scanner.h"

#include <algorithm>

namespace gpgp::vector::svg {
namespace {

/// A drawing on a light page of a colour screen, which nobody asks to move.
Media feature(std::string_view inside) {
  constexpr struct {
    std::string_view name, value; ///< no value: what "(name)" alone says
    bool holds;
  } known[] = {{"prefers-color-scheme", "light", true},
               {"prefers-color-scheme", "dark", false},
               {"prefers-color-scheme", "", true},
               {"prefers-reduced-motion", "no-preference", true},
               {"prefers-reduced-motion", "reduce", false},
               {"prefers-reduced-motion", "", false},
               {"prefers-contrast", "no-preference", true},
               {"prefers-contrast", "more", false},
               {"prefers-contrast", "less", false},
               {"prefers-contrast", "", false},
               {"forced-colors", "none", true},
               {"forced-colors", "active", false},
               {"forced-colors", "", false},
               {"color", "", true},
               {"monochrome", "", false},
               {"grid", "", false},
               {"scripting", "none", true},
               {"scripting", "enabled", false},
               {"scripting", "", false}};
  const size_t colon = std::min(inside.find(':'), inside.size());
  const std::string_view name = trim(inside.substr(0, colon)),
                         value = trim(inside.substr(std::min(colon + 1, inside.size())));
  for (const auto& k : known)
    if (name == k.name && value == k.value) return k.holds ? Media::Yes : Media::No;
  return Media::Unknown;
}

Media negated(Media media) {
  return media == Media::Yes ? Media::No : media == Media::No ? Media::Yes : Media::Unknown;
}

/// In small letters.
Media query(std::string_view text) {
  Scanner s(text);
  s.skipSpace();
  const auto word = [&s] {
    const std::string_view name = s.name();
    s.skipSpace();
    return name;
  };
  std::string_view first = word();
  const bool isNot = first == "not";
  if (isNot || first == "only") first = word();
  Media all = Media::Yes;
  const auto both = [&all](Media more) {
    if (all == Media::No || more == Media::No)
      all = Media::No;
    else if (more == Media::Unknown)
      all = Media::Unknown;
  };
  bool wantsFeature = first.empty();
  if (!first.empty()) {
    if (first != "all" && first != "screen") all = Media::No;
    if (s.done()) return isNot ? negated(all) : all;
    if (word() != "and") return Media::Unknown;
    wantsFeature = true;
  }
  while (wantsFeature) {
    if (!s.take("(")) return Media::Unknown;
    const size_t begin = s.offset();
    while (!s.done() && s.peek() != ')' && s.peek() != '(') s.advance();
    const size_t end = s.offset();
    if (!s.take(")")) return Media::Unknown;
    both(feature(text.substr(begin, end - begin)));
    s.skipSpace();
    if (s.done()) break;
    if (word() != "and") return Media::Unknown;
  }
  return isNot ? negated(all) : all;
}

} // namespace

Media evaluateMedia(std::string_view list) {
  const std::string lower = lowered(trim(list));
  if (lower.empty()) return Media::Yes;
  Media any = Media::No;
  for (size_t begin = 0; begin <= lower.size();) {
    const size_t end = std::min(lower.find(',', begin), lower.size());
    const std::string_view one = trim(std::string_view(lower).substr(begin, end - begin));
    const Media is = one.empty() ? Media::No : query(one);
    if (is == Media::Yes) return is;
    if (is == Media::Unknown) any = is;
    begin = end + 1;
  }
  return any;
}

} // namespace gpgp::vector::svg
