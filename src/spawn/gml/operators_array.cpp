// Arrays and dictionaries. Arrays do not change; operators that alter one leave another.
#include "spawn/gml/machine.h"

#include "spawn/graph/export_labels.h"

#include <algorithm>

namespace gpgp::spawn::gml {
namespace {
const std::vector<Value>& itemsOf(const Value& value) { return std::get<Items>(value)->items; }

/// Nothing, and an error, where there is no such item.
std::optional<size_t> placeOf(Machine& m, const Value& array, const Value& number) {
  const Number* n = std::get_if<Number>(&number);
  if (!n || n->formula || n->known != shader::floor(n->known)) {
    m.fail(std::string(m.operatorName()) + " takes the place of an item as a whole number, found " + kindOf(number));
    return std::nullopt;
  }
  const size_t size = itemsOf(array).size();
  if (n->known >= 0 && n->known < static_cast<float>(size)) return static_cast<size_t>(n->known);
  m.fail("there is no item " + numberText(n->known) + " in an array of " + std::to_string(size) + "; the first is 0");
  return std::nullopt;
}

bool isDictionary(Machine& m, const Value& holder, const Value& key) {
  if (std::holds_alternative<Dictionary>(holder) && std::holds_alternative<Name>(key)) return true;
  m.fail(std::string(m.operatorName()) + " takes an array and a whole number, or a dictionary and a name, found " +
         kindOf(holder) + " and " + kindOf(key));
  return false;
}

void get(Machine& m, Arguments& a) {
  if (std::holds_alternative<Items>(a[0])) {
    const auto at = placeOf(m, a[0], a[1]);
    const Items items = std::get<Items>(a[0]);
    for (size_t i = 0; items->hasShapes && i < items->items.size(); ++i)
      if (!at || i != *at) m.drop(items->items[i]);
    return m.push(at ? items->items[*at] : Value(Broken{}));
  }
  if (!isDictionary(m, a[0], a[1])) return m.push(Broken{});
  auto& values = m.dictionary(std::get<Dictionary>(a[0]).dictionary);
  const uint32_t name = std::get<Name>(a[1]).name;
  if (const auto it = values.find(name); it != values.end()) return m.push(m.copyOf(it->second));
  m.fail("the dictionary has no '" + m.nameText(name) + "'");
  m.push(Broken{});
}

void put(Machine& m, Arguments& a) {
  if (std::holds_alternative<Items>(a[0])) {
    const auto at = placeOf(m, a[0], a[1]);
    if (!at) return m.push(Broken{});
    std::vector<Value> items = itemsOf(a[0]);
    m.drop(items[*at]);
    items[*at] = std::move(a[2]);
    return m.pushArray(std::move(items));
  }
  if (isDictionary(m, a[0], a[1]))
    if (auto* values = m.changed(std::get<Dictionary>(a[0]).dictionary))
      (*values)[std::get<Name>(a[1]).name] = std::move(a[2]);
  m.push(std::move(a[0]));
}

void close(Machine& m, Arguments&) {
  std::vector<Value>& stack = m.stack();
  size_t first = stack.size();
  while (first > 0 && !std::holds_alternative<Mark>(stack[first - 1])) --first;
  if (first == 0) {
    if (!m.hasLostTrack()) m.fail("this ']' has no '['");
    m.loseTrack();
    return m.push(Broken{});
  }
  std::vector<Value> items(std::make_move_iterator(stack.begin() + static_cast<std::ptrdiff_t>(first)),
                           std::make_move_iterator(stack.end()));
  stack.resize(first - 1);
  m.pushArray(std::move(items));
}

void length(Machine& m, Arguments& a) {
  if (const Items* items = std::get_if<Items>(&a[0])) {
    if (!(*items)->hasShapes) return m.pushNumber(static_cast<float>((*items)->items.size()));
    m.push(a[0]); // of shapes, which are not lost for that
    return m.pushNumber(static_cast<float>((*items)->items.size()));
  }
  if (const auto* v = std::get_if<std::shared_ptr<const Vector>>(&a[0]))
    return m.pushNumber(static_cast<float>((*v)->size));
  m.fail(std::string("length takes an array or a vector, found ") + kindOf(a[0]));
  m.push(Broken{});
}
} // namespace

std::span<const Builtin> arrayOperators() {
  static constexpr Builtin kOperators[] = {
      {"[", "", 1, [](Machine& m, Arguments&) { m.push(Mark{}); }},
      {"]", "", 1, close},
      {"aload", "a", 0,
       [](Machine& m, Arguments& a) {
         if (m.spend(itemsOf(a[0]).size()))
           for (const Value& item : itemsOf(a[0])) m.push(item);
       }},
      {"length", "*", 1, length},
      {"get", "**", 1, get},
      {"put", "***", 1, put},
      {"append", "a*", 1,
       [](Machine& m, Arguments& a) {
         std::vector<Value> items = itemsOf(a[0]);
         items.push_back(std::move(a[1]));
         m.pushArray(std::move(items));
       }},
      {"concat", "aa", 1,
       [](Machine& m, Arguments& a) {
         std::vector<Value> items = itemsOf(a[0]);
         const std::vector<Value>& others = itemsOf(a[1]);
         items.insert(items.end(), others.begin(), others.end());
         m.pushArray(std::move(items));
       }},
      {"reverse", "a", 1,
       [](Machine& m, Arguments& a) {
         std::vector<Value> items = itemsOf(a[0]);
         std::reverse(items.begin(), items.end());
         m.pushArray(std::move(items));
       }},
      {"dict", "", 1, [](Machine& m, Arguments&) { m.push(Dictionary{m.newDictionary()}); }},
      {"begin", "d", 0, [](Machine& m, Arguments& a) { m.beginDictionary(std::get<Dictionary>(a[0]).dictionary); }},
      {"end", "", 0, [](Machine& m, Arguments&) { m.endDictionary(); }},
      {"known", "dt", 1,
       [](Machine& m, Arguments& a) {
         const auto& values = m.dictionary(std::get<Dictionary>(a[0]).dictionary);
         m.pushNumber(values.count(std::get<Name>(a[1]).name) ? 1.0f : 0.0f);
       }},
  };
  return kOperators;
}

} // namespace gpgp::spawn::gml
