// Operators on the stack itself, and on names. A copy of a shape is a Replicate in the graph.
#include "spawn/gml/machine.h"

#include "spawn/graph/export_labels.h"

#include <algorithm>

namespace gpgp::spawn::gml {
namespace {
/// The number of values that an operator is told to take from the stack.
std::optional<size_t> countOf(Machine& m, const Value& value) {
  const float n = std::get<Number>(value).known;
  const size_t held = m.stack().size();
  if (n >= 0 && n <= static_cast<float>(held)) return static_cast<size_t>(n);
  if (!m.hasLostTrack())
    m.fail(std::string(m.operatorName()) + " takes " + numberText(n) + " values, but the stack holds " +
           std::to_string(held));
  m.loseTrack();
  return std::nullopt;
}

void duplicate(Machine& m, Arguments& a) {
  Value other = m.copyOf(a[0]);
  m.push(std::move(a[0]));
  m.push(std::move(other));
}

void copy(Machine& m, Arguments& a) {
  const auto n = countOf(m, a[0]);
  if (!n) return;
  const size_t first = m.stack().size() - *n;
  for (size_t i = 0; i < *n && m.spend(1); ++i) {
    Value other = m.copyOf(m.stack()[first + i]);
    m.push(std::move(other));
  }
}

void index(Machine& m, Arguments& a) {
  Number& n = std::get<Number>(a[0]);
  n.known += 1; // values from the one that is meant on
  const auto count = n.known > 0 ? countOf(m, a[0]) : std::nullopt;
  if (!count) {
    if (n.known <= 0) m.fail("index counts from 0");
    m.push(Broken{});
    return;
  }
  Value other = m.copyOf(m.stack()[m.stack().size() - *count]);
  m.push(std::move(other));
}

/// n j roll: the top n values move up by j, and those that leave at the top come back below.
void roll(Machine& m, Arguments& a) {
  const auto n = countOf(m, a[0]);
  if (!n || *n == 0 || !m.spend(*n)) return;
  const auto turns = static_cast<int64_t>(std::clamp(std::get<Number>(a[1]).known, -1e6f, 1e6f));
  const auto size = static_cast<int64_t>(*n), up = (turns % size + size) % size;
  const auto first = m.stack().end() - size;
  std::rotate(first, m.stack().end() - up, m.stack().end());
}

std::string textOf(Machine& m, const Value& value) {
  if (const Number* n = std::get_if<Number>(&value); n && !n->formula) return numberText(n->known);
  if (const Text* t = std::get_if<Text>(&value)) return '"' + *t->text + '"';
  if (const Name* n = std::get_if<Name>(&value)) return '/' + m.nameText(n->name);
  if (const auto* v = std::get_if<std::shared_ptr<const Vector>>(&value)) {
    std::string text;
    for (uint32_t i = 0; i < (*v)->size; ++i) text += (i ? ", " : "(") + textOf(m, (*v)->components[i]);
    return text + ')';
  }
  if (const Items* items = std::get_if<Items>(&value)) {
    std::string text = "[";
    for (size_t i = 0; i < (*items)->items.size() && text.size() < 200; ++i)
      text += (i ? " " : "") + textOf(m, (*items)->items[i]);
    return text + (text.size() < 200 ? "]" : " ...]");
  }
  return kindOf(value);
}
} // namespace

std::span<const Builtin> stackOperators() {
  static constexpr Builtin kOperators[] = {
      {"dup", "*", 2, duplicate},
      {"pop", "*", 0,
       [](Machine& m, Arguments& a) {
         if (const Shape* shape = std::get_if<Shape>(&a[0]); shape && !m.mayTake(*shape)) return;
         m.drop(a[0]);
       }},
      {"exch", "**", 2,
       [](Machine& m, Arguments& a) {
         m.push(std::move(a[1]));
         m.push(std::move(a[0]));
       }},
      {"copy", "i", 0, copy},
      {"index", "i", 1, index},
      {"roll", "ii", 0, roll},
      {"count", "", 1, [](Machine& m, Arguments&) { m.pushNumber(static_cast<float>(m.stack().size())); }},
      {"print", "*", 1,
       [](Machine& m, Arguments& a) { // the value stays
         m.diagnostics().info(m.place(), textOf(m, a[0]));
         m.push(std::move(a[0]));
       }},
      {"def", "t*", 0, [](Machine& m, Arguments& a) { m.define(std::get<Name>(a[0]).name, std::move(a[1])); }},
      {"load", "t", 1,
       [](Machine& m, Arguments& a) { // without executing it
         const uint32_t name = std::get<Name>(a[0]).name;
         Value* value = m.find(name);
         if (!value) m.fail("'" + m.nameText(name) + "' is not defined when this runs");
         m.push(value ? m.copyOf(*value) : Value(Broken{}));
       }},
      {"var", "tk", 0,
       [](Machine& m, Arguments& a) { m.defineVariable(std::get<Name>(a[0]).name, std::get<Number>(a[1]).known); }},
      {"usereg", "", 0, [](Machine&, Arguments&) {}}, // each call of a procedure has registers of its own
  };
  return kOperators;
}

} // namespace gpgp::spawn::gml
