// A rule is found by its most telling part (id, else first class, else type), so that a match costs little.
#include "vector/import/svg/stylesheet.h"

#include "vector/import/svg/scanner.h"

#include <algorithm>

namespace gpgp::vector::svg {
namespace {

/// Comments become spaces, newlines stay, so that lines can be counted.
std::string withoutComments(std::string_view text) {
  std::string out(text);
  for (size_t at = 0; (at = out.find("/*", at)) != out.npos;) {
    const size_t close = out.find("*/", at + 2), end = close == out.npos ? out.size() : close + 2;
    std::replace_if(
        out.begin() + static_cast<ptrdiff_t>(at), out.begin() + static_cast<ptrdiff_t>(end),
        [](char c) { return c != '\n'; }, ' ');
    at = end;
  }
  return out;
}

/// The end of a block that begins after its brace, nested ones skipped.
size_t blockEnd(std::string_view text, size_t at) {
  for (size_t depth = 1; at < text.size(); ++at) {
    depth += text[at] == '{';
    if (text[at] == '}' && --depth == 0) return at;
  }
  return text.size();
}

/// Separators in quotes or brackets do not count.
template <class F> void split(std::string_view text, char separator, F&& part) {
  size_t begin = 0, depth = 0;
  char quote = 0;
  for (size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (quote) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '(') {
      ++depth;
    } else if (c == ')') {
      depth -= depth > 0;
    } else if (c == separator && depth == 0) {
      part(text.substr(begin, at - begin));
      begin = at + 1;
    }
  }
  part(text.substr(begin));
}

std::string lowered(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

/// Of a text without comments.
std::vector<Declaration> declarationsOf(std::string_view text) {
  std::vector<Declaration> declarations;
  split(text, ';', [&declarations](std::string_view part) {
    const size_t colon = part.find(':');
    if (colon == part.npos) return;
    Declaration d{lowered(trim(part.substr(0, colon))), std::string(trim(part.substr(colon + 1))), false};
    const size_t mark = d.value.rfind('!');
    if (mark != d.value.npos && isWord(trim(std::string_view(d.value).substr(mark + 1)), "important")) {
      d.important = true;
      d.value = trim(d.value.substr(0, mark));
    }
    declarations.push_back(std::move(d));
  });
  return declarations;
}

} // namespace

std::vector<Declaration> parseDeclarations(std::string_view text) { return declarationsOf(withoutComments(text)); }

void StyleSheet::parse(std::string_view original, size_t line, Reporter& reporter) {
  const std::string clean = withoutComments(original);
  const std::string_view text = clean;
  size_t counted = 0; // newlines before it are in `line`
  for (size_t at = 0; at < text.size();) {
    while (at < text.size() && trim(text.substr(at, 1)).empty()) ++at;
    if (text.substr(at, 4) == "<!--") at += 4;
    if (text.substr(at, 3) == "-->") at += 3;
    if (at >= text.size()) return;
    while (at < text.size() && trim(text.substr(at, 1)).empty()) ++at;
    line += static_cast<size_t>(
        std::count(text.begin() + static_cast<ptrdiff_t>(counted), text.begin() + static_cast<ptrdiff_t>(at), '\n'));
    counted = at;
    const size_t brace = std::min(text.find('{', at), text.size()),
                 semicolon = std::min(text.find(';', at), text.size());
    if (text.substr(at, 1) == "@") {
      Scanner name(text.substr(at + 1));
      reporter.warn(line, std::string("style rule @") + std::string(name.name().substr(0, 40)) + " is not supported");
      at = semicolon < brace ? semicolon + 1 : blockEnd(text, std::min(brace + 1, text.size())) + 1;
      continue;
    }
    if (brace == text.size()) {
      if (!trim(text.substr(at)).empty()) reporter.error(line, "style rule without a block");
      return;
    }
    const size_t end = blockEnd(text, brace + 1);
    if (rules_.size() >= kMaxRules) {
      reporter.error(line, "more than 65536 style rules; the rest are left out", GPGP_ERROR_UNSUPPORTED);
      return;
    }
    const size_t block = blocks_.size();
    blocks_.push_back(declarationsOf(text.substr(brace + 1, end - brace - 1)));
    split(text.substr(at, brace - at), ',', [&](std::string_view selector) {
      selector = trim(selector);
      if (rules_.size() < kMaxRules && !addSelector(selector, block))
        reporter.warn(line,
                      std::string("style selector '") + std::string(selector.substr(0, 60)) + "' is not supported");
    });
    at = end + 1;
  }
}

bool StyleSheet::addSelector(std::string_view selector, size_t block) {
  Rule rule;
  rule.block = block;
  Scanner s(selector);
  if (!s.take("*")) rule.type = s.name();
  if (!rule.type.empty()) rule.specificity += 1;
  while (!s.done()) {
    const bool id = s.take("#");
    if (!id && !s.take(".")) return false;
    const std::string_view name = s.name();
    if (name.empty() || (id && !rule.id.empty()) || rule.classes.size() > 64) return false;
    rule.specificity += id ? 1u << 16 : 1u << 8;
    if (id)
      rule.id = name;
    else
      rule.classes.emplace_back(name);
  }
  if (selector.empty()) return false;
  std::string key = "*";
  if (!rule.id.empty())
    key.assign(1, '#').append(rule.id);
  else if (!rule.classes.empty())
    key.assign(1, '.').append(rule.classes[0]);
  else if (!rule.type.empty())
    key = rule.type;
  byKey_[key].push_back(rules_.size());
  rules_.push_back(std::move(rule));
  return true;
}

std::vector<const Declaration*> StyleSheet::match(std::string_view type, std::string_view id, std::string_view classes,
                                                  size_t& work) const {
  std::vector<const Declaration*> declarations;
  if (rules_.empty()) return declarations;
  std::vector<std::string_view> names;
  while (!(classes = trim(classes)).empty() && names.size() < 64) {
    const size_t end = std::min(classes.find_first_of(" \t\r\n\f"), classes.size());
    names.push_back(classes.substr(0, end));
    classes.remove_prefix(end);
  }
  std::vector<size_t> found;
  const auto collect = [&](const std::string& key) {
    const auto at = byKey_.find(key);
    if (at == byKey_.end()) return;
    for (const size_t index : at->second) {
      const Rule& rule = rules_[index];
      ++work;
      const bool fits = (rule.type.empty() || rule.type == type) && (rule.id.empty() || rule.id == id) &&
                        std::all_of(rule.classes.begin(), rule.classes.end(), [&names](const std::string& c) {
                          return std::find(names.begin(), names.end(), c) != names.end();
                        });
      if (fits) found.push_back(index);
    }
  };
  collect("*");
  collect(std::string(type));
  for (const std::string_view name : names) collect(std::string(1, '.').append(name));
  if (!id.empty()) collect(std::string(1, '#').append(id));
  std::sort(found.begin(), found.end(), [this](size_t a, size_t b) {
    return rules_[a].specificity != rules_[b].specificity ? rules_[a].specificity < rules_[b].specificity : a < b;
  });
  for (const size_t index : found)
    for (const Declaration& d : blocks_[rules_[index].block]) {
      ++work;
      declarations.push_back(&d);
    }
  return declarations;
}

} // namespace gpgp::vector::svg
