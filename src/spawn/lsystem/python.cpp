// Python in files of L-Py: logical lines, and expressions by recursive descent.
#include "spawn/lsystem/python.h"

namespace gpgp::spawn::lsystem {
namespace {

Line at(const std::string& text, Place place) { return {text, std::vector<Place>(text.size() + 1, place)}; }
Line joined(std::initializer_list<Line> parts) {
  Line all;
  for (const Line& part : parts) {
    all.text += part.text;
    all.places.insert(all.places.end(), part.places.begin(),
                      part.places.begin() + static_cast<ptrdiff_t>(part.text.size()));
  }
  all.places.push_back(all.places.empty() ? Place{} : all.places.back());
  return all;
}

} // namespace

std::vector<PyLine> pythonLines(std::string_view text) {
  std::vector<PyLine> lines;
  PyLine line;
  bool isNew = true;
  int open = 0; // parentheses, across which lines go on
  std::string_view quotes;
  Place place{1, 1};
  const auto finish = [&](Place at) {
    while (!line.text.empty() && isPyBlank(line.text.back())) {
      line.text.pop_back();
      line.places.pop_back();
    }
    line.places.push_back(at);
    if (!line.text.empty()) lines.push_back(std::move(line));
    line = {};
    isNew = true;
  };
  for (size_t i = 0; i < text.size(); ++i, ++place.column) {
    const std::string_view rest = text.substr(i);
    const char c = text[i];
    if (c == '\n' && quotes.size() == 1) quotes = {}; // which ends with its line
    if (!quotes.empty()) {                            // strings of Python
      if (rest.starts_with(quotes)) {
        i += quotes.size() - 1;
        place.column += static_cast<uint32_t>(quotes.size()) - 1;
        quotes = {};
      } else if (c == '\n') {
        place = {place.line + 1, 0};
      }
      continue;
    }
    if (isNew && isPyBlank(c)) {
      line.indent = c == '\t' ? (line.indent / 8 + 1) * 8 : line.indent + (c == ' ');
      continue;
    }
    const bool isComment = c == '#' && (i + 1 >= text.size() || text[i + 1] != '(');
    if (isComment) {
      while (i + 1 < text.size() && text[i + 1] != '\n') ++i, ++place.column;
      continue;
    }
    if (c == '\\' && (rest.starts_with("\\\n") || rest.starts_with("\\\r\n"))) {
      i += rest[1] == '\r' ? 2 : 1;
      place = {place.line + 1, 0};
      continue;
    }
    if (c == '\n') {
      const Place end = place;
      place = {place.line + 1, 0};
      if (open > 0) {
        line.text += ' ';
        line.places.push_back(end);
      } else {
        finish(end);
      }
      continue;
    }
    isNew = false;
    for (const std::string_view mark : {"\"\"\"", "'''", "\"", "'"})
      if (quotes.empty() && rest.starts_with(mark)) quotes = mark;
    if (!quotes.empty()) {
      line.text += '"'; // what it says is nothing here
      line.places.push_back(place);
      i += quotes.size() - 1;
      place.column += static_cast<uint32_t>(quotes.size()) - 1;
      continue;
    }
    open += c == '(' ? 1 : c == ')' ? -1 : 0;
    line.text += c;
    line.places.push_back(place);
  }
  finish(place);
  return lines;
}

char PyReader::peek(const PyLine& line) {
  while (cursor_ < line.text.size() && isPyBlank(line.text[cursor_])) ++cursor_;
  return cursor_ < line.text.size() ? line.text[cursor_] : '\0';
}
bool PyReader::take(const PyLine& line, char c) {
  if (peek(line) != c) return false;
  ++cursor_;
  return true;
}
std::string PyReader::word(const PyLine& line) {
  peek(line);
  std::string text;
  while (cursor_ < line.text.size() &&
         (isPyLetter(line.text[cursor_]) || (!text.empty() && isPyDigit(line.text[cursor_]))))
    text += line.text[cursor_++];
  return text;
}
bool PyReader::takeWord(const PyLine& line, std::string_view wanted) {
  const size_t before = cursor_;
  if (word(line) == wanted) return true;
  cursor_ = before;
  return false;
}

/// Whether another level fits; if not, the rest of the line is passed over.
bool PyReader::enters(const PyLine& line) {
  if (++depth_ <= 100) return true;
  --depth_;
  diagnostics_.error(placeOf(line), "the expression nests too deep");
  cursor_ = line.text.size();
  return false;
}

/// Whether an expression has more operators than L+C takes; the rest of the line is then passed over.
bool PyReader::isTooLong(const PyLine& line, uint32_t operators) {
  if (operators <= 256) return false;
  diagnostics_.error(placeOf(line), "the expression is too long");
  cursor_ = line.text.size();
  return true;
}

/// value if condition else other
Line PyReader::expressionOf(const PyLine& line) {
  if (!enters(line)) return at("0.0", line.places[0]);
  Line value = logical(line, 0);
  if (takeWord(line, "if")) {
    const Place place = placeOf(line);
    const Line condition = logical(line, 0);
    if (!takeWord(line, "else")) diagnostics_.error(placeOf(line), "expected 'else' of this 'if'");
    const Line other = expressionOf(line);
    value = joined({at("((", place), condition, at(") ? (", place), value, at(") : (", place), other, at("))", place)});
  }
  --depth_;
  return value;
}

/// level 0: or, 1: and, 2: not
Line PyReader::logical(const PyLine& line, int level) {
  if (level == 2) {
    const Place place = (peek(line), placeOf(line));
    if (takeWord(line, "not")) {
      if (!enters(line)) return at("0.0", place);
      const Line value = joined({at("!(", place), logical(line, 2), at(")", place)});
      --depth_;
      return value;
    }
    return comparison(line);
  }
  Line left = logical(line, level + 1);
  for (uint32_t count = 1; !isTooLong(line, count); ++count) {
    const Place place = placeOf(line);
    if (!takeWord(line, level == 0 ? "or" : "and")) return left;
    const Line right = logical(line, level + 1);
    left = joined({at("(", place), left, at(level == 0 ? " || " : " && ", place), right, at(")", place)});
  }
  return left;
}

Line PyReader::comparison(const PyLine& line) {
  Line left = sum(line), result;
  bool isFirst = true;
  for (uint32_t count = 1; !isTooLong(line, count); ++count) { // a < b < c
    peek(line);
    const Place place = placeOf(line);
    std::string found;
    for (const char* op : {"==", "!=", "<=", ">=", "<", ">"})
      if (found.empty() && line.text.compare(cursor_, std::string_view(op).size(), op) == 0) found = op;
    if (found.empty()) return isFirst ? left : result;
    cursor_ += found.size();
    const Line right = sum(line);
    const Line pair = joined({at("(", place), left, at(" " + found + " ", place), right, at(")", place)});
    result = isFirst ? pair : joined({at("(", place), result, at(" && ", place), pair, at(")", place)});
    isFirst = false;
    left = right;
  }
  return isFirst ? left : result;
}

Line PyReader::sum(const PyLine& line) {
  Line left = product(line);
  for (uint32_t count = 1; !isTooLong(line, count); ++count) {
    const char c = peek(line);
    const Place place = placeOf(line);
    if ((c != '+' && c != '-') || line.text.compare(cursor_, 3, "-->") == 0) return left;
    ++cursor_;
    left = joined({at("(", place), left, at(std::string(" ") + c + " ", place), product(line), at(")", place)});
  }
  return left;
}
Line PyReader::product(const PyLine& line) {
  Line left = unary(line);
  for (uint32_t count = 1; !isTooLong(line, count); ++count) {
    const char c = peek(line);
    const Place place = placeOf(line);
    if (line.text.compare(cursor_, 2, "//") == 0) {
      cursor_ += 2;
      left = joined({at("floor(", place), left, at(" / ", place), unary(line), at(")", place)});
    } else if ((c == '*' && line.text.compare(cursor_, 2, "**") != 0) || c == '/' || c == '%') {
      ++cursor_;
      left = joined({at("(", place), left, at(std::string(" ") + c + " ", place), unary(line), at(")", place)});
    } else {
      return left;
    }
  }
  return left;
}
Line PyReader::unary(const PyLine& line) {
  const char c = peek(line);
  const Place place = placeOf(line);
  if (!enters(line)) return at("0.0", place);
  Line value;
  if (c == '-' || c == '+') {
    ++cursor_;
    value = joined({at(std::string("(") + c, place), unary(line), at(")", place)});
  } else {
    value = primary(line);
    peek(line);
    if (line.text.compare(cursor_, 2, "**") == 0) {
      cursor_ += 2;
      value = joined({at("pow(", place), value, at(", ", place), unary(line), at(")", place)});
    }
  }
  --depth_;
  return value;
}

Line PyReader::primary(const PyLine& line) {
  const char c = peek(line);
  const Place place = placeOf(line);
  if (take(line, '(')) {
    const Line value = expressionOf(line);
    if (!take(line, ')')) {
      refuse(placeOf(line), "'" + line.text.substr(cursor_, 12) + "' in parentheses");
      cursor_ = line.text.size();
    }
    return joined({at("(", place), value, at(")", place)});
  }
  if (isPyDigit(c) || c == '.') {
    size_t end = cursor_;
    bool isWhole = true;
    while (end < line.text.size() && (isPyDigit(line.text[end]) || line.text[end] == '.'))
      isWhole &= line.text[end++] != '.';
    if (end < line.text.size() && (line.text[end] == 'e' || line.text[end] == 'E')) {
      isWhole = false;
      ++end;
      if (end < line.text.size() && (line.text[end] == '-' || line.text[end] == '+')) ++end;
      while (end < line.text.size() && isPyDigit(line.text[end])) ++end;
    }
    std::string number = line.text.substr(cursor_, end - cursor_);
    cursor_ = end;
    return at(isWhole ? number + ".0" : number, place); // whole numbers divide as others do
  }
  std::string name = word(line);
  for (const std::string_view module : {"math", "random", "rd", "numpy", "np"})
    if (name == module && take(line, '.')) name = word(line);
  if (name == "True" || name == "False") return at(name == "True" ? "1.0" : "0.0", place);
  if (name == "pi") return at("3.14159265", place);
  if (name.empty() || peek(line) == '.' || peek(line) == '[') {
    refuse(place,
           "Python's '" +
               line.text.substr(line.text.size() > cursor_ && name.empty() ? cursor_ : cursor_ - name.size(), 20) +
               "'");
    cursor_ = line.text.size();
    return at("0.0", place);
  }
  if (!take(line, '(')) return at(name, place);
  return call(line, std::move(name), place);
}

/// A function's values, behind its '('.
Line PyReader::call(const PyLine& line, std::string name, Place place) {
  std::vector<Line> values;
  while (peek(line) != ')' && peek(line) != 0) {
    values.push_back(expressionOf(line));
    if (!take(line, ',') && peek(line) != ')') break;
  }
  if (!take(line, ')')) {
    refuse(placeOf(line), "'" + line.text.substr(cursor_, 12) + "' in the values of '" + name + "'");
    cursor_ = line.text.size();
  }
  const auto zero = at("0.0", place);
  const auto value = [&](size_t i) { return i < values.size() ? values[i] : zero; };
  const auto one = [&](const char* before, const char* behind) {
    return joined({at(before, place), value(0), at(behind, place)});
  };
  if (name == "random" && values.empty()) return at("ran(1.0)", place);
  if (name == "uniform")
    return joined(
        {at("((", place), value(0), at(") + ran((", place), value(1), at(") - (", place), value(0), at(")))", place)});
  if (name == "randint")
    return joined({at("floor((", place), value(0), at(") + ran((", place), value(1), at(") - (", place), value(0),
                   at(") + 1.0))", place)});
  if (name == "round" && values.size() == 2) // to so many places behind the point
    return joined({at("(round((", place), value(0), at(") * pow(10.0, ", place), value(1), at(")) / pow(10.0, ", place),
                   value(1), at("))", place)});
  if (name == "gauss" || name == "normalvariate") name = "nran";
  if (name == "radians") return one("((", ") * 0.0174532925)");
  if (name == "degrees") return one("((", ") * 57.2957795)");
  if (name == "float") return one("(", ")");
  if (name == "int") return one("trunc(", ")");
  Line all = at(name + "(", place);
  for (size_t i = 0; i < values.size(); ++i) all = joined({all, at(i ? ", " : "", place), values[i]});
  return joined({all, at(")", place)});
}

} // namespace gpgp::spawn::lsystem
