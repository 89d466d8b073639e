// Control. What is known decides while the program runs; what depends on the shape becomes a node that chooses.
#include "spawn/gml/machine.h"

#include "core/math.h"

#include <cmath>

namespace gpgp::spawn::gml {
using namespace shader;

namespace {
void choose(Machine& m, const Number& condition, const Value& yes, const Value& no) {
  if (!condition.formula) return m.execute(condition.known != 0 ? yes : no, m.place());
  const size_t at = m.topShape();
  if (at == m.stack().size()) {
    m.fail(std::string("the condition of ") + m.operatorName() +
           " depends on a shape, but there is none on the stack to choose for");
    return m.loseTrack();
  }
  const Shape shape = std::get<Shape>(m.stack()[at]);
  if (!m.mayTake(shape)) return;
  if (shape->ends.empty()) return; // nothing comes here
  const Parameter parameter = m.parameter(condition, shape);
  const uint32_t node = m.graph().addNode(shape, {kOpIf, 0, 0, {parameter}, 2}, m.place());
  const Value branches[] = {yes, no};
  m.branchOn(at, node, branches, &condition);
}

void repeat(Machine& m, Arguments& a) {
  const float turns = std::get<Number>(a[0]).known;
  if (turns < 0) m.fail("repeat takes a number of turns from 0");
  m.beginLoop();
  for (float i = 0; i < turns && m.goesOn(); ++i) m.execute(a[1], m.place());
  m.endLoop();
}

/// first step last { } for: pushes first, first + step ... up to last.
void count(Machine& m, Arguments& a) {
  const float first = std::get<Number>(a[0]).known, step = std::get<Number>(a[1]).known,
              last = std::get<Number>(a[2]).known;
  if (step == 0) {
    m.fail("for takes a step other than 0");
    return;
  }
  // A part in ten thousand of a step is taken for rounding, as Repeat does.
  const double turns = std::floor((double(last) - double(first)) / double(step) + 1e-4) + 1;
  m.beginLoop();
  for (double i = 0; i < turns && m.goesOn(); ++i) {
    m.pushNumber(add(first, multiply(step, static_cast<float>(i))));
    m.execute(a[3], m.place());
  }
  m.endLoop();
}

void forAll(Machine& m, Arguments& a) {
  m.beginLoop();
  for (const Value& item : std::get<Items>(a[0])->items) {
    if (!m.goesOn()) break;
    m.push(item);
    m.execute(a[1], m.place());
  }
  m.endLoop();
}

void map(Machine& m, Arguments& a) {
  std::vector<Value> results;
  m.beginLoop();
  for (const Value& item : std::get<Items>(a[0])->items) {
    if (!m.goesOn()) break;
    m.push(item);
    m.execute(a[1], m.place());
    if (!m.hasStopped()) results.push_back(m.pop());
  }
  m.endLoop();
  m.pushArray(std::move(results));
}

std::optional<uint32_t> shapeNamed(Machine& m, const Value& value) {
  const std::string& name = m.nameText(std::get<Name>(value).name);
  std::string names;
  for (uint32_t s = 0; s < kShapeCount; ++s) {
    if (name == shapeName(s)) return s;
    names += (s ? ", /" : "/") + std::string(shapeName(s));
  }
  m.fail("there is no shape '" + name.substr(0, 64) + "'; expected " + names);
  return std::nullopt;
}
bool isDynamic(uint32_t shape) { return shape >= kShapeDynamicConvexPolygon && shape <= kShapeDynamicRightPrism; }

void start(Machine& m, const Value& shape, const Value* corners, std::optional<uint32_t> rule) {
  const auto type = shapeNamed(m, shape);
  std::optional<uint32_t> polygon;
  if (type && isDynamic(*type) != (corners != nullptr))
    m.fail(corners
               ? "only Dynamic... shapes have corners of their own"
               : std::string("expected corners before /") + shapeName(*type) + ", as [(-0.5,-0.5) (0.5,-0.5) (0,0.5)]");
  else if (type && corners)
    polygon = m.cornersOf(*corners, *type == kShapeDynamicConvexPolygon || *type == kShapeDynamicConvexRightPrism);
  else if (type)
    polygon = usualPolygon(*type);
  if (type && polygon)
    m.startShape(*type, *polygon, rule);
  else if (!rule)
    m.push(Broken{});
}
std::optional<uint32_t> ruleOf(const Value& value) { return std::get<Name>(value).name; }

void terminal(Machine& m, Arguments& a) {
  std::vector<uint32_t> names;
  if (const Name* name = std::get_if<Name>(&a[0])) {
    names.push_back(name->name);
  } else if (const Items* items = std::get_if<Items>(&a[0])) {
    for (const Value& item : (*items)->items)
      if (const Name* of = std::get_if<Name>(&item)) names.push_back(of->name);
    if (names.size() != (*items)->items.size()) names.clear();
  }
  const float kind = std::get<Number>(a[1]).known, index = std::get<Number>(a[2]).known;
  if (names.empty())
    m.fail("terminal takes a name or an array of names, a kind and an index");
  else if (kind != 0 && kind != 1)
    m.fail("a terminal's kind is 0 (triangles) or 1 (an instanced mesh)");
  else if (index < 0 || index > 16777216.0f)
    m.fail("a terminal's index is a whole number from 0");
  else
    m.defineTerminals(names, static_cast<uint32_t>(kind), static_cast<uint32_t>(index));
}

void rule(Machine& m, Arguments& a) {
  const float parameters = std::get<Number>(a[1]).known;
  const Procedure* procedure = std::get_if<Procedure>(&a[2]);
  if (parameters < 0 || parameters > 16)
    m.fail("a rule takes from 0 to 16 values");
  else if (!procedure)
    m.fail("rule takes a name, the number of values that the rule takes, and a procedure");
  else
    m.defineRule(std::get<Name>(a[0]).name, static_cast<uint32_t>(parameters), procedure->procedure);
}
} // namespace

std::span<const Builtin> controlOperators() {
  static constexpr Builtin kOperators[] = {
      {"if", "np", 0, [](Machine& m, Arguments& a) { choose(m, std::get<Number>(a[0]), a[1], Broken{}); }},
      {"ifelse", "npp", 0, [](Machine& m, Arguments& a) { choose(m, std::get<Number>(a[0]), a[1], a[2]); }},
      {"repeat", "ip", 0, repeat},
      {"for", "kkkp", 0, count},
      {"loop", "p", 0,
       [](Machine& m, Arguments& a) {
         m.beginLoop();
         while (m.goesOn()) m.execute(a[0], m.place());
         m.endLoop();
       }},
      {"exit", "", 0, [](Machine& m, Arguments&) { m.exitLoop(); }},
      {"forall", "ap", 0, forAll},
      {"map", "ap", 1, map},
      {"exec", "p", 0, [](Machine& m, Arguments& a) { m.execute(a[0], m.place()); }},
      {"axiom", "at", 1, [](Machine& m, Arguments& a) { start(m, a[1], a.data(), std::nullopt); }},
      {"axiom", "t", 1, [](Machine& m, Arguments& a) { start(m, a[0], nullptr, std::nullopt); }},
      {"start", "att", 0, [](Machine& m, Arguments& a) { start(m, a[1], a.data(), ruleOf(a[2])); }},
      {"start", "tt", 0, [](Machine& m, Arguments& a) { start(m, a[0], nullptr, ruleOf(a[1])); }},
      {"terminal", "*ii", 0, terminal},
      {"rule", "tip", 0, rule},
  };
  return kOperators;
}

} // namespace gpgp::spawn::gml
