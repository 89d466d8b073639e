#include "vector/import/svg/values.h"

#include <cmath>
#include <functional>
#include <set>
#include <vector>

namespace gpgp::vector::svg {
namespace {

constexpr size_t kMaxValue = size_t(64) << 10;

/// Behind the bracket that closes the one before `at`; npos where there is none. Strings are skipped.
size_t pastBracket(std::string_view text, size_t at) {
  for (size_t depth = 1; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '"' || c == '\'') {
      at = text.find(c, at + 1);
      if (at == text.npos) return at;
    }
    depth += c == '(';
    if (c == ')' && --depth == 0) return at + 1;
  }
  return text.npos;
}

/// Where the next var( is.
size_t findVariable(std::string_view text, size_t at) {
  for (; at + 4 <= text.size(); ++at)
    if (isWord(text.substr(at, 4), "var(") &&
        (at == 0 || std::string_view(" \t\r\n\f(,/*+-").find(text[at - 1]) != std::string_view::npos))
      return at;
  return text.npos;
}

using Lookup = std::function<const std::string*(std::string_view name)>;

std::optional<std::string> substitute(std::string_view value, const Lookup& lookup, size_t depth) {
  constexpr size_t kMaxDepth = 32;
  std::string out;
  for (size_t at = 0; at < value.size();) {
    const size_t found = findVariable(value, at);
    out += value.substr(at, found == value.npos ? found : found - at);
    if (out.size() > kMaxValue) return std::nullopt;
    if (found == value.npos) break;
    const size_t end = pastBracket(value, found + 4);
    if (end == value.npos || depth >= kMaxDepth) return std::nullopt;
    const std::string_view inside = value.substr(found + 4, end - found - 5);
    const size_t comma = inside.find(',');
    const std::string_view name = trim(inside.substr(0, comma));
    if (const std::string* is = lookup(name)) {
      out += *is;
    } else {
      if (comma == inside.npos) return std::nullopt;
      const std::optional<std::string> fallback = substitute(trim(inside.substr(comma + 1)), lookup, depth + 1);
      if (!fallback) return std::nullopt;
      out += *fallback;
    }
    at = end;
  }
  return out.size() > kMaxValue ? std::nullopt : std::optional(std::move(out));
}

/// Of a sum: a number, or with `power` 1 a length.
struct Quantity {
  double value = 0;
  int power = 0;
};

class Calculator {
public:
  Calculator(std::string_view text, const LengthContext& context, LengthAxis axis)
      : text_(text), context_(context), axis_(axis) {}

  std::optional<Quantity> run() {
    const auto result = unary();
    skip();
    return result && at_ == text_.size() ? result : std::nullopt;
  }

private:
  using Result = std::optional<Quantity>;
  void skip() {
    while (at_ < text_.size() && std::string_view(" \t\r\n\f").find(text_[at_]) != std::string_view::npos) ++at_;
  }
  bool take(char c) {
    const size_t before = at_;
    skip();
    if (at_ < text_.size() && text_[at_] == c) return ++at_, true;
    at_ = before;
    return false;
  }
  bool isSpace(size_t at) const {
    return at < text_.size() && std::string_view(" \t\r\n\f").find(text_[at]) != std::string_view::npos;
  }
  Result sum() {
    Result left = product();
    while (left) {
      const size_t before = at_;
      skip();
      const bool plus = at_ < text_.size() && text_[at_] == '+', minus = at_ < text_.size() && text_[at_] == '-';
      if (!plus && !minus) return left;
      if (at_ == before || !isSpace(at_ + 1)) return std::nullopt; // there are spaces on both sides
      ++at_;
      const Result right = product();
      if (!right || right->power != left->power) return std::nullopt;
      left->value += plus ? right->value : -right->value;
    }
    return left;
  }
  Result product() {
    Result left = unary();
    while (left) {
      const bool times = take('*');
      if (!times && !take('/')) return left;
      const Result right = unary();
      if (!right) return right;
      left->power += times ? right->power : -right->power;
      left->value = times ? left->value * right->value : left->value / right->value;
    }
    return left;
  }
  Result unary() {
    constexpr size_t kMaxDepth = 32;
    skip();
    if (at_ >= text_.size() || depth_ >= kMaxDepth) return std::nullopt;
    ++depth_;
    const Result result = take('(')                                              ? bracket()
                          : std::isalpha(static_cast<unsigned char>(text_[at_])) ? call()
                                                                                 : plain();
    --depth_;
    return result;
  }
  Result bracket() {
    const Result inside = sum();
    return inside && take(')') ? inside : std::nullopt;
  }
  Result plain() {
    Scanner s(text_.substr(at_));
    double number = 0;
    if (!s.number(number)) return std::nullopt;
    const size_t digits = s.offset();
    if (!s.take("%")) s.name();
    const std::string_view whole = text_.substr(at_, s.offset()), unit = whole.substr(digits);
    at_ += s.offset();
    if (unit.empty()) return Quantity{number, 0};
    constexpr struct {
      std::string_view name;
      double degrees;
    } angles[] = {{"deg", 1}, {"grad", 0.9}, {"rad", 180 / 3.14159265358979323846}, {"turn", 360}};
    for (const auto& angle : angles)
      if (isWord(unit, angle.name)) return Quantity{number * angle.degrees, 0};
    double length = 0;
    if (!parseLength(whole, context_, axis_, length)) return std::nullopt;
    return Quantity{length, 1};
  }
  Result call() {
    const size_t begin = at_;
    while (at_ < text_.size() && std::isalpha(static_cast<unsigned char>(text_[at_]))) ++at_;
    const std::string name = lowered(text_.substr(begin, at_ - begin));
    if (name == "pi") return Quantity{3.14159265358979323846, 0};
    if (name == "e") return Quantity{2.71828182845904523536, 0};
    if (at_ >= text_.size() || text_[at_] != '(') return std::nullopt;
    ++at_;
    std::vector<Quantity> values;
    do {
      const Result value = sum();
      if (!value || values.size() >= 64) return std::nullopt;
      values.push_back(*value);
    } while (take(','));
    if (!take(')')) return std::nullopt;
    const Quantity first = values[0];
    for (const Quantity& v : values)
      if (v.power != first.power && name != "pow") return std::nullopt;
    const size_t n = values.size();
    const auto fold = [&](auto&& f) {
      Quantity all = first;
      for (const Quantity& v : values) all.value = f(all.value, v.value);
      return all;
    };
    const auto unaryOf = [&](double value, int power) {
      return n == 1 ? Result(Quantity{value, power}) : std::nullopt;
    };
    if (name == "calc") return unaryOf(first.value, first.power);
    if (name == "min") return fold([](double a, double b) { return std::fmin(a, b); });
    if (name == "max") return fold([](double a, double b) { return std::fmax(a, b); });
    if (name == "clamp" && n == 3)
      return Quantity{std::fmax(first.value, std::fmin(values[1].value, values[2].value)), first.power};
    if (name == "abs") return unaryOf(std::fabs(first.value), first.power);
    if (name == "sign") return unaryOf(first.value > 0 ? 1 : first.value < 0 ? -1 : 0, 0);
    if (name == "sqrt" && first.power == 0) return unaryOf(std::sqrt(first.value), 0);
    if (name == "hypot") {
      Quantity all{0, first.power};
      for (const Quantity& v : values) all.value = std::hypot(all.value, v.value);
      return all;
    }
    if (name == "pow" && n == 2 && first.power == 0 && values[1].power == 0)
      return Quantity{std::pow(first.value, values[1].value), 0};
    return std::nullopt;
  }

  std::string_view text_;
  const LengthContext& context_;
  LengthAxis axis_;
  size_t at_ = 0, depth_ = 0;
};

} // namespace

bool hasVariables(std::string_view value) { return findVariable(value, 0) != value.npos; }

std::optional<std::string> withoutVariables(std::string_view value, const CustomProperties* properties) {
  return substitute(
      value,
      [properties](std::string_view name) -> const std::string* {
        if (!properties) return nullptr;
        const auto found = properties->find(name);
        return found == properties->end() ? nullptr : &found->second;
      },
      0);
}

std::shared_ptr<const CustomProperties> cascadeVariables(const std::shared_ptr<const CustomProperties>& parent,
                                                         const CustomProperties& own) {
  if (own.empty()) return parent;
  auto all = std::make_shared<CustomProperties>(parent ? *parent : CustomProperties());
  std::set<std::string, std::less<>> open, done;
  const std::function<void(const std::string&, const std::string&)> resolve = [&](const std::string& name,
                                                                                  const std::string& value) {
    if (done.contains(name)) return;
    open.insert(name);
    bool cyclic = false;
    const Lookup lookup = [&](std::string_view other) -> const std::string* {
      if (const auto mine = own.find(other); mine != own.end() && !done.contains(other)) {
        if (open.contains(other) || open.size() > 100) return cyclic = true, nullptr;
        resolve(mine->first, mine->second);
      }
      const auto found = all->find(other);
      return found == all->end() ? nullptr : &found->second;
    };
    std::optional<std::string> plain;
    if (isWord(value, "inherit") || isWord(value, "unset")) {
      if (const auto above = parent ? parent->find(name) : CustomProperties::const_iterator();
          parent && above != parent->end())
        plain = above->second;
    } else if (!isWord(value, "initial")) {
      plain = substitute(value, lookup, 0);
    }
    open.erase(name);
    done.insert(name);
    if (plain && !cyclic)
      (*all)[name] = *plain;
    else
      all->erase(name);
  };
  for (const auto& [name, value] : own) resolve(name, value);
  return all;
}

bool isMath(std::string_view text) {
  constexpr std::string_view names[] = {"calc", "min", "max", "clamp", "abs", "sign", "sqrt", "hypot", "pow"};
  const size_t bracket = text.find('(');
  return bracket != text.npos && bracket < 6 && oneOf(lowered(text.substr(0, bracket)), names);
}

bool evaluate(std::string_view text, const LengthContext& context, LengthAxis axis, double& value) {
  const auto result = Calculator(trim(text), context, axis).run();
  if (!result || result->power < 0 || result->power > 1 || !std::isfinite(result->value)) return false;
  value = result->value;
  return true;
}

} // namespace gpgp::vector::svg
