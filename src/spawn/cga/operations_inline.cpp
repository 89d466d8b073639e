// Derivations within a rule: what comes of a block becomes the current shape, or an operand of a Boolean operation.
#include "spawn/cga/deriver.h"

namespace gpgp::spawn::cga {

bool Deriver::deriveNow(uint32_t body, uint32_t base, uint32_t top, std::vector<Shape>& leaves) {
  if (nested_ == kMostNested) {
    fail("inline, union, subtract and intersect are nested more than " + std::to_string(kMostNested) + " deep");
    return false;
  }
  const Scope ruleScope = ruleScope_;
  const bool made = made_;
  const uint32_t chunk = chunk_, at = at_, stackBase = stackBase_;
  const std::string_view operation = operation_;
  std::vector<Shape> states, queue, next, outer;
  std::vector<uvec2> forks;
  std::vector<CgaValue> queueValues, nextValues;
  const auto exchange = [&] {
    states.swap(states_);
    forks.swap(forks_);
    queue.swap(queue_);
    next.swap(next_);
    outer.swap(leaves_);
    queueValues.swap(queueValues_);
    nextValues.swap(nextValues_);
  };
  exchange();
  Shape& begin = child();
  begin.key = childKey(begin.key, 0x10000000u); // no way of the rule itself
  const bool begins = addChild(begin, body, base);
  const Shape whole = shape_;
  const bool drawn = drawn_;
  queue_.swap(next_);
  queueValues_.swap(nextValues_);
  stackBase_ = top;
  ++nested_;
  if (begins) derive();
  --nested_;
  exchange();
  leaves.swap(outer);
  shape_ = whole;
  drawn_ = drawn;
  ruleScope_ = ruleScope;
  made_ = made;
  chunk_ = chunk;
  at_ = at;
  stackBase_ = stackBase;
  operation_ = operation;
  hasHull_ = false;
  return begins && !stopped_ && !noRoom_;
}

bool Deriver::gather(const std::vector<Shape>& leaves, bool unify, const char* what) {
  std::vector<const Shape*> shapes;
  for (const Shape& leaf : leaves)
    if (leaf.form.mesh) shapes.push_back(&leaf);
  if (shapes.empty()) {
    shape_.form.mesh = 0;
    return true;
  }
  bool isOneMaterial = true;
  for (const Shape* s : shapes)
    isOneMaterial = isOneMaterial && s->color == shapes[0]->color && s->texture == shapes[0]->texture;
  if (isOneMaterial) {
    shape_.color = shapes[0]->color;
    shape_.texture = shapes[0]->texture;
  } else {
    warn(std::string(what) + " material",
         std::string(what) + ": shapes of several colours or textures get those of the current shape");
  }
  if (shapes.size() == 1) {
    shape_.form = shapes[0]->form;
    shape_.values = shapes[0]->values;
    shape_.changes = shapes[0]->changes;
    shape_.changeCount = shapes[0]->changeCount;
    return isWithin(shape_.form);
  }
  Form all = shapes[0]->form;
  const Axes own = axesOf(shape_.form.scope);
  if (unify) {
    for (size_t i = 1; i < shapes.size(); ++i) {
      Form both;
      const Status status = boolean(pool_, all, shapes[i]->form, Boolean::Union, both);
      if (status == kGeometryNotPlanar || status == kGeometryBadArgument) {
        warn("unify", std::string(what) + ": only flat shapes of one plane and closed ones are united; these are put "
                                          "together as they are");
        unify = false;
        break;
      }
      if (status != kGeometryOk) {
        if (!check(status, what)) return false;
        continue;
      }
      all = both;
    }
  }
  if (!unify) {
    std::vector<Form> forms;
    for (const Shape* s : shapes) forms.push_back(s->form);
    const Status status = combine(pool_, forms, all);
    if (status != kGeometryOk) return check(status, what);
  }
  shape_.form = all;
  return check(alignScope(pool_, shape_.form, own), what) && isWithin(shape_.form);
}

bool Deriver::inline_(const Arguments& a, uint32_t table, uint32_t base) {
  const std::string_view strategy = a.count ? word(a[0]) : std::string_view("append");
  std::vector<Shape> leaves;
  if (!deriveNow(words_[words_[table + 1] + kCgaPartBody], base, topOf(a), leaves)) return false;
  if (!gather(leaves, strategy == "unify", "inline")) return false;
  if (strategy != "recompose" || shape_.form.mesh == 0 || boxes_.is(shape_.form)) return true;
  Cleanup vertices;
  vertices.faces = false;
  return check(cleanup(pool_, shape_.form, vertices), "inline");
}

/// Of two blocks, or of the current shape and one block.
bool Deriver::combineBy(Boolean what, const Arguments& a, uint32_t table, uint32_t base) {
  const char* name = what == Boolean::Union ? "union" : what == Boolean::Difference ? "subtract" : "intersect";
  const uint32_t parts = words_[table];
  const Shape before = shape_;
  Shape operands[2] = {before, before};
  for (uint32_t p = 0; p < parts && p < 2; ++p) {
    std::vector<Shape> leaves;
    if (!deriveNow(words_[words_[table + 1 + p] + kCgaPartBody], base, topOf(a), leaves)) return false;
    const uint32_t children = shape_.children;
    if (!gather(leaves, true, name)) return false;
    operands[parts == 1 ? 1 : p] = shape_;
    shape_ = before;
    shape_.children = children;
  }
  if (a.count && word(a[0]) == "swap") std::swap(operands[0], operands[1]);
  const uint32_t children = shape_.children, draws = shape_.draws;
  shape_ = operands[0];
  shape_.children = children;
  shape_.draws = draws;
  const Status status = boolean(pool_, operands[0].form, operands[1].form, what, shape_.form);
  if (status == kGeometryNotPlanar || status == kGeometryBadArgument) {
    warn(name, std::string(name) + ": operands are flat shapes of one plane, or closed ones; the first one stays as it "
                                   "was");
    return true;
  }
  return check(status, name) && isWithin(shape_.form);
}

bool Deriver::union_(const Arguments& a, uint32_t table, uint32_t base) {
  return combineBy(Boolean::Union, a, table, base);
}
bool Deriver::subtract_(const Arguments& a, uint32_t table, uint32_t base) {
  return combineBy(Boolean::Difference, a, table, base);
}
bool Deriver::intersect_(const Arguments& a, uint32_t table, uint32_t base) {
  return combineBy(Boolean::Intersection, a, table, base);
}

} // namespace gpgp::spawn::cga
