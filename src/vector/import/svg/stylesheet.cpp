// A rule is found by its most telling part (id, else first class, else type), so that a match costs little.
#include "vector/import/svg/stylesheet.h"

#include "vector/import/svg/media.h"
#include "vector/import/svg/supports.h"

#include <algorithm>
#include <charconv>
#include <optional>

namespace gpgp::vector::svg {
namespace {

/// Behind the comment, the string or the escape that begins at `at`, else behind the character. A string ends with its
/// line; of url(...) without quotes only the closing bracket is left.
size_t pastToken(std::string_view text, size_t at) {
  const char c = text[at];
  const auto behind = [&](size_t found, size_t length) {
    return found == text.npos ? text.size() : std::min(found + length, text.size());
  };
  const auto to = [&](std::string_view marks) { // the next of them that is not escaped
    for (++at; at < text.size() && marks.find(text[at]) == marks.npos; ++at) at += text[at] == '\\';
    return std::min(at, text.size());
  };
  if (text.substr(at, 2) == "/*") return behind(text.find("*/", at + 2), 2);
  if (c == '\\') return behind(at, 2);
  if (c == '"') return behind(to("\"\n"), 1);
  if (c == '\'') return behind(to("'\n"), 1);
  if (c == '(' && at >= 3 && isWord(text.substr(at - 3, 3), "url")) {
    const size_t inside = text.find_first_not_of(" \t\r\n\f", at + 1);
    if (inside != text.npos && text[inside] != '"' && text[inside] != '\'') return to(")");
  }
  return at + 1;
}

} // namespace

size_t findOutside(std::string_view text, size_t at, std::string_view marks) {
  std::string open; // what closes the brackets around
  for (; at < text.size(); at = pastToken(text, at)) {
    const char c = text[at];
    if (open.empty() && marks.find(c) != marks.npos) return at;
    if (!open.empty() && c == open.back())
      open.pop_back();
    else if (c == '(' || c == '[' || c == '{')
      open.push_back(c == '(' ? ')' : c == '[' ? ']' : '}');
  }
  return text.size();
}

namespace {
/// Comments become spaces, as they are between the parts of a value.
std::string withoutComments(std::string_view text) {
  std::string out(text);
  for (size_t at = 0; at < text.size();) {
    const size_t end = pastToken(text, at);
    if (text.substr(at, 2) == "/*")
      std::fill(out.begin() + static_cast<ptrdiff_t>(at), out.begin() + static_cast<ptrdiff_t>(end), ' ');
    at = end;
  }
  return out;
}

/// Behind spaces and comments.
size_t pastSpace(std::string_view text, size_t at) {
  while (at < text.size() && (trim(text.substr(at, 1)).empty() || text.substr(at, 2) == "/*")) at = pastToken(text, at);
  return at;
}

/// Escapes of letters by their numbers as the letters, outside of strings (CSS Syntax 3, 4.3.7).
std::string withoutEscapes(std::string text) {
  if (text.find('\\') == text.npos) return text;
  std::string out;
  for (size_t at = 0; at < text.size();) {
    uint32_t code = 0;
    size_t end = at + 1;
    if (text[at] == '\\') {
      const size_t most = std::min(end + 6, text.size());
      const auto read = std::from_chars(text.data() + end, text.data() + most, code, 16);
      end = static_cast<size_t>(read.ptr - text.data());
    }
    const bool isLetter = ((code | 0x20) >= 'a' && (code | 0x20) <= 'z') || code == '-' || code == '_' ||
                          (code >= 0x80 && code < 0xd800) || (code >= 0xe000 && code <= 0x10ffff);
    if (isLetter) {
      appendUtf8(out, code);
      at = end + (end < text.size() && (text[end] == ' ' || text[end] == '\t'));
      continue;
    }
    const size_t past = pastToken(text, at);
    out += text.substr(at, past - at);
    at = past;
  }
  return out;
}

/// Separators in comments, strings and brackets do not count.
template <class F> void split(std::string_view text, char separator, F&& part) {
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = findOutside(text, begin, {&separator, 1});
    part(text.substr(begin, end - begin));
    begin = end + 1;
  }
}

/// The address of url(a), url("a") or "a", and what follows it.
std::pair<std::string, std::string_view> uriAt(std::string_view text) {
  std::string uri;
  const bool isUrl = isWord(text.substr(0, 4), "url(");
  size_t at = isUrl ? std::min(text.find_first_not_of(" \t\r\n\f", 4), text.size()) : 0;
  const char quote = at < text.size() && (text[at] == '"' || text[at] == '\'') ? text[at] : '\0';
  if (!isUrl && !quote) return {};
  for (at += quote != 0; at < text.size() && text[at] != (quote ? quote : ')'); ++at) {
    if (text[at] == '\\' && at + 1 < text.size()) ++at; // the next is itself
    uri += text[at];
  }
  if (isUrl) at = text.find(')', at);
  if (at >= text.size()) return {};
  return {std::string(trim(uri)), trim(text.substr(at + 1))};
}

} // namespace

std::vector<Declaration> parseDeclarations(std::string_view original) {
  const std::string text = withoutEscapes(withoutComments(original));
  std::vector<Declaration> declarations;
  split(text, ';', [&declarations](std::string_view part) {
    const size_t colon = part.find(':');
    Scanner name(trim(part.substr(0, colon == part.npos ? 0 : colon)));
    name.name();
    if (colon == part.npos || !name.done()) { // the latter may be a rule inside of another
      if (part = trim(part); !part.empty()) declarations.push_back({"", std::string(part), false});
      return;
    }
    const std::string_view written = trim(part.substr(0, colon));
    Declaration d{written.starts_with("--") ? std::string(written) : lowered(written),
                  std::string(trim(part.substr(colon + 1))), false};
    const size_t mark = d.value.rfind('!');
    if (mark != d.value.npos && isWord(trim(std::string_view(d.value).substr(mark + 1)), "important")) {
      d.important = true;
      d.value = trim(d.value.substr(0, mark));
    }
    declarations.push_back(std::move(d));
  });
  return declarations;
}

void StyleSheet::parse(std::string_view text, const Place& place, Reporter& reporter, const ImportFn& import) {
  Reading reading{reporter, import};
  readRules(text, place, reading);
}

void StyleSheet::readRules(std::string_view text, Place place, Reading& reading) {
  size_t placed = 0; // where `place` is
  const auto placeAt = [&](size_t at) {
    place = placeIn(text.substr(placed), at - placed, place);
    placed = at;
    return place;
  };
  for (size_t at = 0; at < text.size();) {
    at = pastSpace(text, at);
    if (text.substr(at, 4) == "<!--") at += 4;
    if (text.substr(at, 3) == "-->") at += 3;
    at = pastSpace(text, at);
    if (at >= text.size()) return;
    const Place here = placeAt(at);
    const bool isAt = text[at] == '@';
    const size_t brace = findOutside(text, at, isAt ? ";{" : "{"); // or the end of a rule without a block
    const bool hasBlock = brace < text.size() && text[brace] == '{';
    const size_t end = hasBlock ? findOutside(text, brace + 1, "}") : brace;
    const std::string_view block = hasBlock ? text.substr(brace + 1, end - brace - 1) : std::string_view();
    if (isAt) {
      Scanner name(text.substr(at + 1));
      const std::string_view word = name.name();
      const size_t behind = at + 1 + word.size();
      const std::string prelude = withoutComments(text.substr(behind, brace - behind));
      readAtRule(word, trim(prelude), block, here, placeAt(std::min(brace + 1, text.size())), reading);
    } else {
      if (!hasBlock) return reading.reporter.error(here, "style rule without a block");
      if (rules_.size() >= kMaxRules) {
        reading.reporter.error(here, "more than 65536 style rules; the rest are left out", GPGP_ERROR_UNSUPPORTED);
        return;
      }
      readRule(text.substr(at, brace - at), block, here, reading);
    }
    at = end + 1;
  }
}

void StyleSheet::readAtRule(std::string_view name, std::string_view prelude, std::string_view block, const Place& place,
                            const Place& blockPlace, Reading& reading) {
  constexpr size_t kMaxDepth = 32;
  Reporter& reporter = reading.reporter;
  const std::string rule = std::string("style rule @") + std::string(name.substr(0, 40));
  const std::string shown = std::string("'") + std::string(prelude.substr(0, 60)) + "'";
  if (isWord(name, "charset")) return;
  if (isWord(name, "import")) {
    if (!reading.importsCount || reading.depth)
      return reporter.ignored(place, rule + " does not stand before all others; ignored");
    auto [uri, media] = uriAt(prelude);
    if (uri.empty()) return reporter.ignored(place, rule + " has " + shown + ", which is not an address; ignored");
    constexpr std::string_view kSupports = "supports(";
    if (isWord(media.substr(0, kSupports.size()), kSupports)) {
      const size_t end = findOutside(media, kSupports.size(), ")");
      if (!evaluateSupportsOfImport(media.substr(kSupports.size(), end - kSupports.size())).value_or(false)) return;
      media = trim(media.substr(std::min(end + 1, media.size())));
    }
    const Media is = lowered(media).starts_with("layer") ? Media::Unknown : evaluateMedia(media);
    if (is == Media::Unknown)
      return reporter.warn(place, rule + " has the condition '" + std::string(media.substr(0, 60)) +
                                      "', which is not supported: its style sheet does not count");
    if (is == Media::No) return;
    if (!reading.import) return reporter.warn(place, rule + " is not supported");
    return reading.import(uri, place);
  }
  if (isWord(name, "namespace")) { // prefixes are named where selectors have them
    const auto [uri, rest] = uriAt(prelude);
    if (!uri.empty() && uri != "http://www.w3.org/2000/svg")
      reporter.warn(place, rule + " of other elements than SVG's is not supported");
    return;
  }
  reading.importsCount = false;
  const bool isSupports = isWord(name, "supports");
  if (!isSupports && !isWord(name, "media")) return reporter.warn(place, rule + " is not supported");
  Media is = Media::Unknown;
  if (isSupports) {
    const std::optional<bool> holds = evaluateSupports(prelude);
    if (!holds)
      return reporter.ignored(place, rule + " has " + shown + ", which is not a condition; its contents are ignored");
    is = *holds ? Media::Yes : Media::No;
  } else {
    is = evaluateMedia(prelude);
  }
  if (is == Media::Unknown || reading.depth >= kMaxDepth)
    return reporter.warn(place,
                         rule + " has the condition " + shown + ", which is not supported: its contents are ignored");
  if (is == Media::No) return;
  ++reading.depth;
  readRules(block, blockPlace, reading);
  --reading.depth;
}

void StyleSheet::readRule(std::string_view selectors, std::string_view declarations, const Place& place,
                          Reading& reading) {
  reading.importsCount = false;
  const size_t block = blocks_.size();
  blocks_.push_back(parseDeclarations(declarations));
  std::vector<Rule> rules;
  bool valid = true;
  split(selectors, ',', [&](std::string_view selector) {
    if (rules_.size() + rules.size() >= kMaxRules) return;
    Rule rule;
    rule.block = block;
    const Selector::Read read = rule.selector.parse(selector);
    if (read == Selector::Read::Yes) return rules.push_back(std::move(rule));
    const std::string said =
        std::string("style selector '") + std::string(trim(withoutComments(selector)).substr(0, 60)) + "' is ";
    if (read == Selector::Read::Unsupported) return reading.reporter.warn(place, said + "not supported");
    valid = false; // and with it all of the rule
    reading.reporter.ignored(place, said + "not valid; its rule is ignored");
  });
  if (valid)
    for (Rule& rule : rules) add(std::move(rule));
}

void StyleSheet::add(Rule rule) {
  byKey_[rule.selector.key()].push_back(rules_.size());
  rules_.push_back(std::move(rule));
}

std::vector<const Declaration*> StyleSheet::match(const Document& document, pugi::xml_node node, size_t& work,
                                                  size_t most) const {
  std::vector<const Declaration*> declarations;
  if (rules_.empty()) return declarations;
  MatchBudget budget{work, most};
  std::vector<size_t> found;
  const auto collect = [&](const std::string& key) {
    const auto at = byKey_.find(key);
    if (at == byKey_.end()) return;
    for (const size_t index : at->second)
      if (rules_[index].selector.fits(document, node, budget)) found.push_back(index);
  };
  collect("*");
  collect(std::string(document.name(node)));
  std::vector<std::string_view> names = wordsOf(node.attribute("class").value());
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  for (const std::string_view name : names) collect(std::string(1, '.').append(name));
  if (const std::string_view id = node.attribute("id").value(); !id.empty()) collect(std::string(1, '#').append(id));
  std::sort(found.begin(), found.end(), [this](size_t a, size_t b) {
    const uint32_t first = rules_[a].selector.specificity(), second = rules_[b].selector.specificity();
    return first != second ? first < second : a < b;
  });
  for (const size_t index : found)
    for (const Declaration& d : blocks_[rules_[index].block]) {
      if ((work += 1 + d.value.size() / 16) >= most) return declarations; // a value will be looked through
      declarations.push_back(&d);
    }
  return declarations;
}

} // namespace gpgp::vector::svg
