#include "vector/import/svg/selector.h"

#include <algorithm>
#include <charconv>

namespace gpgp::vector::svg {
namespace {

constexpr size_t kMaxCompounds = 16, kMaxParts = 64, kMaxDepth = 8;

/// Behind spaces and comments; whether there was a space, which a comment is not.
bool skipSpace(Scanner& s, bool spaces = true) {
  bool skipped = false;
  for (;;) {
    const size_t at = s.offset();
    if (spaces) s.skipSpace();
    skipped |= s.offset() > at;
    if (!s.take("/*")) return skipped;
    while (!s.done() && !s.take("*/")) s.advance();
  }
}

/// A name in which backslashes escape characters, or begin the number of one.
std::string identifier(Scanner& s) {
  std::string name;
  for (;;) {
    name += s.name();
    Scanner ahead = s;
    if (!ahead.take("\\") || ahead.done() || ahead.peek() == '\n') return name;
    s = ahead;
    uint32_t code = 0;
    size_t digits = 0;
    for (; digits < 6; ++digits, s.advance()) {
      const char c = s.peek();
      const int digit = c >= '0' && c <= '9' ? c - '0' : (c | 32) >= 'a' && (c | 32) <= 'f' ? (c | 32) - 'a' + 10 : -1;
      if (digit < 0) break;
      code = code * 16 + static_cast<uint32_t>(digit);
    }
    if (digits == 0) {
      name += s.peek();
      s.advance();
      continue;
    }
    if (!s.take(" ")) (void)s.take("\t");
    if (code == 0 || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) code = 0xfffd;
    appendUtf8(name, code);
  }
}

/// "2n+1", "odd", "-n + 3", "5".
bool parseNth(std::string_view text, int& a, int& b) {
  std::string all;
  for (const char c : lowered(text))
    if (c != ' ' && c != '\t' && c != '\n' && c != '\r' && c != '\f') all += c;
  if (all == "odd" || all == "even") return a = 2, b = all == "odd", true;
  const auto number = [](std::string_view digits, int& value) {
    if (digits.starts_with('+')) digits.remove_prefix(1);
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return !digits.empty() && digits[0] != '+' && read.ec == std::errc() && read.ptr == digits.data() + digits.size() &&
           value > -1'000'000'000 && value < 1'000'000'000;
  };
  const size_t n = all.find('n');
  if (n == all.npos) return a = 0, number(all, b);
  const std::string_view before = std::string_view(all).substr(0, n), behind = std::string_view(all).substr(n + 1);
  if (before.empty() || before == "+" || before == "-")
    a = before == "-" ? -1 : 1;
  else if (!number(before, a))
    return false;
  b = 0;
  return behind.empty() || ((behind[0] == '+' || behind[0] == '-') && number(behind, b));
}

} // namespace

std::vector<std::string_view> wordsOf(std::string_view text) {
  std::vector<std::string_view> words;
  while (!(text = trim(text)).empty() && words.size() < 64) {
    const size_t end = std::min(text.find_first_of(" \t\r\n\f"), text.size());
    words.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return words;
}

/// Behind "[", up to and with "]".
bool Selector::AttributeTest::parse(Scanner& s) {
  skipSpace(s);
  name = identifier(s);
  skipSpace(s);
  if (name.empty() || s.take("]")) return !name.empty();
  how = s.peek();
  Scanner ahead = s;
  ahead.advance();
  if (how == '|' && ahead.peek() != '=') return false; // a namespace
  if (how != '=') s.advance();
  if (std::string_view("=~|^$*").find(how) == std::string_view::npos || !s.take("=")) return false;
  skipSpace(s);
  if (const char quote = s.peek(); quote == '"' || quote == '\'') {
    for (s.advance(); !s.done() && s.peek() != quote; s.advance()) value += s.peek();
    if (s.done()) return false;
    s.advance();
  } else { // a name, which begins with no digit
    if (s.peek() >= '0' && s.peek() <= '9') return false;
    value = identifier(s);
    if (value.empty()) return false;
  }
  skipSpace(s);
  if (const std::string_view flag = s.name(); !flag.empty()) {
    anyCase = isWord(flag, "i");
    if (!anyCase && !isWord(flag, "s")) return false;
    if (anyCase) value = lowered(value);
    skipSpace(s);
  }
  return s.take("]");
}

Selector::Read Selector::parsePseudo(std::string_view text, Scanner& s, Compound& compound, size_t depth) {
  using Kind = Pseudo::Kind;
  constexpr struct {
    std::string_view name;
    Kind kind;
    bool fromEnd = false, ofType = false, alsoFromEnd = false;
  } plain[] = {{"root", Kind::Root},
               {"empty", Kind::Empty},
               {"link", Kind::Link},
               {"any-link", Kind::Link},
               {"first-child", Kind::Nth},
               {"last-child", Kind::Nth, true},
               {"only-child", Kind::Nth, false, false, true},
               {"first-of-type", Kind::Nth, false, true},
               {"last-of-type", Kind::Nth, true, true},
               {"only-of-type", Kind::Nth, false, true, true},
               // What no reader does to a still picture: nothing is.
               {"hover", Kind::Is},
               {"active", Kind::Is},
               {"focus", Kind::Is},
               {"focus-within", Kind::Is},
               {"focus-visible", Kind::Is},
               {"visited", Kind::Is},
               {"target", Kind::Is},
               {"checked", Kind::Is},
               {"enabled", Kind::Is},
               {"disabled", Kind::Is}},
    called[] = {{"nth-child", Kind::Nth},
                {"nth-last-child", Kind::Nth, true},
                {"nth-of-type", Kind::Nth, false, true},
                {"nth-last-of-type", Kind::Nth, true, true},
                {"lang", Kind::Lang},
                {"not", Kind::Not},
                {"is", Kind::Is},
                {"where", Kind::Is},
                {"matches", Kind::Is}};
  if (s.peek() == ':') return Read::Unsupported; // a pseudo-element
  const std::string name = lowered(s.name());
  if (name.empty()) return Read::Invalid;
  const bool isCalled = s.take("(");
  const auto find = [&](const auto& table) {
    return std::find_if(std::begin(table), std::end(table), [&](const auto& row) { return row.name == name; });
  };
  if (!isCalled) {
    const auto* row = find(plain);
    if (row == std::end(plain)) return Read::Unsupported;
    Pseudo pseudo{row->kind, 0, 1, row->fromEnd, row->ofType, {}, {}};
    ++classes_;
    compound.pseudos.push_back(pseudo);
    pseudo.fromEnd = true;
    if (row->alsoFromEnd) compound.pseudos.push_back(std::move(pseudo));
    return Read::Yes;
  }
  const size_t begin = s.offset(), end = findOutside(text, begin, ")");
  if (end >= text.size()) return Read::Invalid;
  const std::string_view inside = trim(text.substr(begin, end - begin));
  while (s.offset() <= end) s.advance();
  const auto* row = find(called);
  if (row == std::end(called)) return Read::Unsupported;
  Pseudo pseudo{row->kind, 0, 1, row->fromEnd, row->ofType, {}, {}};
  if (row->kind == Kind::Nth) {
    ++classes_;
    if (lowered(inside).find(" of ") != std::string::npos) return Read::Unsupported;
    if (!parseNth(inside, pseudo.a, pseudo.b)) return Read::Invalid;
  } else if (row->kind == Kind::Lang) {
    ++classes_;
    pseudo.value = lowered(inside);
    if (pseudo.value.empty() || pseudo.value.find_first_of(",*\"' ") != std::string::npos) return Read::Unsupported;
  } else {
    if (depth >= kMaxDepth) return Read::Unsupported;
    const Selector* strongest = nullptr;
    for (size_t at = 0; at <= inside.size();) {
      const size_t comma = findOutside(inside, at, ",");
      if (pseudo.selectors.size() >= kMaxParts) return Read::Unsupported;
      if (const Read read = pseudo.selectors.emplace_back().parse(inside.substr(at, comma - at), depth + 1);
          read != Read::Yes)
        return read;
      at = comma + 1;
    }
    for (const Selector& selector : pseudo.selectors)
      if (!strongest || selector.specificity() > strongest->specificity()) strongest = &selector;
    if (strongest && name != "where")
      ids_ += strongest->ids_, classes_ += strongest->classes_, types_ += strongest->types_;
  }
  compound.pseudos.push_back(std::move(pseudo));
  return Read::Yes;
}

Selector::Read Selector::parseCompound(std::string_view text, Scanner& s, Compound& compound, size_t depth) {
  const size_t begin = s.offset();
  if (!s.take("*")) compound.type = identifier(s);
  if (Scanner ahead = s; ahead.take("|") && compound.type.empty() && s.offset() > begin) { // *|type: any namespace
    s = ahead;
    if (!s.take("*")) compound.type = identifier(s);
  }
  types_ += !compound.type.empty();
  for (size_t parts = 0;; ++parts) {
    skipSpace(s, false);
    if (parts > kMaxParts) return Read::Unsupported;
    if (s.take("#")) {
      const std::string id = identifier(s);
      if (id.empty() || (!compound.id.empty() && compound.id != id)) return Read::Invalid;
      compound.id = id;
      ++ids_;
    } else if (s.take(".")) {
      compound.classes.push_back(identifier(s));
      if (compound.classes.back().empty()) return Read::Invalid;
      ++classes_;
    } else if (s.take("[")) {
      if (!compound.attributes.emplace_back().parse(s)) return s.peek() == '|' ? Read::Unsupported : Read::Invalid;
      ++classes_;
    } else if (s.take(":")) {
      if (const Read read = parsePseudo(text, s, compound, depth); read != Read::Yes) return read;
    } else {
      return s.offset() > begin ? Read::Yes : s.peek() == '|' ? Read::Unsupported : Read::Invalid;
    }
  }
}

Selector::Read Selector::parse(std::string_view text, size_t depth) {
  Scanner s(text);
  skipSpace(s);
  for (char combinator = 0;;) {
    Compound compound;
    compound.combinator = combinator;
    if (const Read read = parseCompound(text, s, compound, depth); read != Read::Yes) return read;
    if (compounds_.size() == kMaxCompounds) return Read::Unsupported;
    compounds_.push_back(std::move(compound));
    combinator = skipSpace(s) ? ' ' : 0;
    if (s.done()) break;
    if (std::string_view(">+~").find(s.peek()) != std::string_view::npos) {
      combinator = s.peek();
      s.advance();
      skipSpace(s);
    }
    if (combinator == 0) return s.peek() == '|' ? Read::Unsupported : Read::Invalid;
  }
  return ids_ > 255 || classes_ > 255 || types_ > 255 ? Read::Unsupported : Read::Yes;
}

std::string Selector::key() const {
  const Compound& own = compounds_.back();
  if (!own.id.empty()) return '#' + own.id;
  if (!own.classes.empty()) return '.' + own.classes[0];
  return own.type.empty() ? "*" : own.type;
}

bool Selector::AttributeTest::fits(std::string_view is) const {
  const std::string small = anyCase ? lowered(is) : std::string();
  if (anyCase) is = small;
  const bool found = !value.empty() && is.find(value) != std::string_view::npos;
  switch (how) {
  case '=': return is == value;
  case '~': {
    const auto words = wordsOf(is);
    return std::find(words.begin(), words.end(), value) != words.end();
  }
  case '|': return is.substr(0, value.size()) == value && (is.size() == value.size() || is[value.size()] == '-');
  case '^': return found && is.substr(0, value.size()) == value;
  case '$': return found && is.substr(is.size() - value.size()) == value;
  case '*': return found;
  default: return true;
  }
}

namespace {
pugi::xml_attribute attributeOf(pugi::xml_node node, std::string_view name, MatchBudget& budget) {
  for (const pugi::xml_attribute a : node.attributes()) {
    ++budget.work;
    if (a.name() != name) continue;
    budget.work += std::string_view(a.value()).size() / 16; // which will be looked through
    return a;
  }
  return {};
}
} // namespace

bool Selector::fits(const Document& document, const Pseudo& pseudo, pugi::xml_node node, MatchBudget& budget) const {
  switch (pseudo.kind) {
  case Pseudo::Kind::Root: return node == document.root();
  case Pseudo::Kind::Empty:
    for (const pugi::xml_node child : node.children())
      if (child.type() == pugi::node_element || child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata)
        return false;
    return true;
  case Pseudo::Kind::Link: return document.name(node) == "a" && hrefOf(node);
  case Pseudo::Kind::Lang:
    for (pugi::xml_node up = node; up && budget.spend(1); up = up.parent())
      for (const char* name : {"lang", "xml:lang"})
        if (const pugi::xml_attribute a = up.attribute(name)) {
          const std::string is = lowered(a.value());
          return is.starts_with(pseudo.value) && (is.size() == pseudo.value.size() || is[pseudo.value.size()] == '-');
        }
    return false;
  case Pseudo::Kind::Nth: {
    int number = 1;
    for (pugi::xml_node other = node; budget.spend(1);) {
      other = pseudo.fromEnd ? other.next_sibling() : other.previous_sibling();
      if (!other) break;
      if (other.type() != pugi::node_element) continue;
      number += !pseudo.ofType || std::string_view(other.name()) == node.name();
    }
    const int over = number - pseudo.b;
    return pseudo.a == 0 ? over == 0 : over % pseudo.a == 0 && over / pseudo.a >= 0;
  }
  case Pseudo::Kind::Is:
  case Pseudo::Kind::Not:
    return std::any_of(pseudo.selectors.begin(), pseudo.selectors.end(), [&](const Selector& one) {
             return one.fits(document, node, budget);
           }) == (pseudo.kind == Pseudo::Kind::Is);
  }
  return false;
}

bool Selector::fits(const Document& document, const Compound& compound, pugi::xml_node node,
                    MatchBudget& budget) const {
  if (!budget.spend(1) || (!compound.type.empty() && document.name(node) != compound.type)) return false;
  if (!compound.id.empty() && attributeOf(node, "id", budget).value() != compound.id) return false;
  if (!compound.classes.empty()) {
    const auto names = wordsOf(attributeOf(node, "class", budget).value());
    budget.work += names.size() * compound.classes.size();
    for (const std::string& name : compound.classes)
      if (std::find(names.begin(), names.end(), name) == names.end()) return false;
  }
  return std::all_of(compound.attributes.begin(), compound.attributes.end(),
                     [&](const AttributeTest& test) {
                       const pugi::xml_attribute a = attributeOf(node, test.name, budget);
                       return a && test.fits(a.value());
                     }) &&
         std::all_of(compound.pseudos.begin(), compound.pseudos.end(),
                     [&](const Pseudo& pseudo) { return fits(document, pseudo, node, budget); });
}

/// Whether the compounds up to `last` fit, the last the element.
bool Selector::fits(const Document& document, size_t last, pugi::xml_node node, MatchBudget& budget) const {
  if (!fits(document, compounds_[last], node, budget)) return false;
  const char combinator = compounds_[last].combinator;
  if (combinator == 0) return true;
  const bool up = combinator == ' ' || combinator == '>', once = combinator == '>' || combinator == '+';
  while ((node = up ? node.parent() : node.previous_sibling()) && budget.spend(1)) {
    if (node.type() != pugi::node_element) continue;
    if (fits(document, last - 1, node, budget)) return true;
    if (once) return false;
  }
  return false;
}

bool Selector::fits(const Document& document, pugi::xml_node node, MatchBudget& budget) const {
  return fits(document, compounds_.size() - 1, node, budget);
}

} // namespace gpgp::vector::svg
