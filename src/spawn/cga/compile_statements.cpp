// Bodies of rules to code that changes the current shape and makes new ones.
#include "core/suggest.h"
#include "spawn/cga/compiler.h"

#include <algorithm>
#include <span>

namespace gpgp::spawn::cga {

using namespace shader;

void Compiler::checkCount(const std::string& file, Place place, std::string_view name, size_t count, size_t least,
                          size_t most) {
  if (count >= least && count <= most) return;
  const std::string takes =
      least == most ? std::to_string(least) : std::to_string(least) + " to " + std::to_string(most);
  messages_.error(
      file, place,
      std::string("'").append(name).append("' takes ").append(takes).append(most == 1 ? " value" : " values") +
          ", not " + std::to_string(count));
}

namespace {
/// Whether random numbers may be drawn for a value.
bool mayDraw(const Expression& e) {
  if (e.kind == Expression::Kind::stochastic || e.kind == Expression::Kind::components) return true;
  if (e.kind == Expression::Kind::name && (e.isCall || e.text.find('.') == std::string::npos)) return true;
  for (const ExpressionPtr& a : e.arguments)
    if (a && mayDraw(*a)) return true;
  for (const Choice& c : e.choices)
    if ((c.condition && mayDraw(*c.condition)) || (c.value && mayDraw(*c.value))) return true;
  return false;
}
} // namespace

Makes whatMakes(const Statement& s) {
  const auto either = [](bool shapes) { return shapes ? Makes::shapes : Makes::nothing; };
  if (s.kind != Statement::Kind::call) return either(s.kind == Statement::Kind::leaf);
  const auto operation = findOperation(s.name);
  if (!operation) return either(s.name != "NIL" && s.name != "set" && !isUnsupportedOperation(s.name));
  if (*operation == Operation::report_) return Makes::report;
  if (*operation >= Operation::inline_ && *operation <= Operation::modify_) return Makes::nothing;
  return either(operationInfo(*operation).block != Block::none);
}

Makes whatMake(std::span<const Statement> statements) {
  Makes most = Makes::nothing;
  for (const Statement& s : statements) {
    most = std::max(most, whatMakes(s));
    for (const Branch& branch : s.branches) most = std::max(most, whatMake(branch.body));
  }
  return most;
}

size_t bracketEnd(const Body& body, size_t push) {
  int32_t depth = 0;
  for (size_t i = push; i < body.size(); ++i) {
    depth += body[i].kind == Statement::Kind::push ? 1 : body[i].kind == Statement::Kind::pop ? -1 : 0;
    if (depth == 0) return i;
  }
  return body.size();
}

bool forks(Makes makes, const Body& body, size_t next, bool isTail) {
  return makes == Makes::report || (makes == Makes::shapes && isFollowed(body, next, isTail));
}

bool isFollowed(const Body& body, size_t next, bool isTail) {
  return next < body.size() ? body[next].kind != Statement::Kind::pop : !isTail;
}

/// The numbers of a value that is one of several are counted from its place on, as those of an operator's parameters.
void Compiler::drawsOf(const Expression& e, size_t place) {
  if (place == 0 || !mayDraw(e)) return;
  emit(kCgaPushFloatCode, {floatBitsToUint(static_cast<float>(place))});
  emit(kCgaOperationCode, {static_cast<uint32_t>(Operation::path_drawsFrom), 1});
}

void Compiler::body(const Body& body, const Context& context, bool isLast, bool isTail, uint32_t end) {
  int32_t brackets = 0;
  std::vector<bool> ways; // of brackets: whether they are one
  for (size_t i = 0; i < body.size(); ++i) {
    const Statement& s = body[i];
    const bool last = isLast && i + 1 == body.size() && brackets == 0;
    const bool isForked = cga::forks(whatMakes(s), body, i + 1, isTail && brackets == 0);
    if (isForked) path(Operation::path_fork);
    switch (s.kind) {
    case Statement::Kind::push: {
      const size_t close = bracketEnd(body, i);
      const bool isWay =
          cga::forks(whatMake(std::span(body).subspan(i, close - i)), body, close + 1, isTail && brackets == 0);
      ways.push_back(isWay);
      if (isWay) path(Operation::path_fork);
      ++brackets;
      source(context, s.place);
      emit(kCgaPushShapeCode);
      break;
    }
    case Statement::Kind::pop:
      if (--brackets < 0) {
        messages_.error(context.file(), s.place, "this ] has no [ before it");
        brackets = 0;
      }
      source(context, s.place);
      emit(kCgaPopShapeCode);
      if (!ways.empty()) {
        if (ways.back()) path(Operation::path_rest);
        ways.pop_back();
      }
      break;
    case Statement::Kind::cases:
    case Statement::Kind::stochastic:
      branches(s, context, last, !isFollowed(body, i + 1, isTail && brackets == 0), end);
      break;
    default: statement(s, context, last); break;
    }
    if (isForked) path(Operation::path_rest);
  }
  if (brackets > 0) messages_.warning(context.file(), body.front().place, "a [ in this rule has no ] behind it");
}

void Compiler::branches(const Statement& s, const Context& context, bool isLast, bool isTail, uint32_t end) {
  const bool isCase = s.kind == Statement::Kind::cases;
  const uint32_t behind = isLast ? end : newLabel();
  bool hasElse = false;
  double sum = 0;
  if (!isCase) emit(kCgaDrawCode), path(Operation::path_drawn);
  for (const Branch& branch : s.branches) {
    const uint32_t next = newLabel();
    if (branch.condition) {
      const Type condition = expression(*branch.condition, context);
      if (condition == Type::string || condition == Type::array)
        messages_.error(context.file(), branch.condition->place, "a condition or percentage is a string or an array");
      if (!isCase && branch.condition->kind == Expression::Kind::number) sum += branch.condition->number;
      if (isCase && mayDraw(*branch.condition)) path(Operation::path_drawn);
      emit(isCase ? kCgaJumpUnlessCode : kCgaChooseCode);
      emitLabel(next);
    } else {
      hasElse = true;
      if (!isCase) emit(kCgaPopCode);
    }
    body(branch.body, context, isLast, isTail, end);
    if (branch.condition) {
      emit(kCgaJumpCode);
      emitLabel(behind);
      place(next);
    }
  }
  if (!hasElse) {
    if (!isCase) emit(kCgaPopCode);
    messages_.once(isCase ? "case without else" : "percentages without else", context.file(), s.place,
                   isCase ? "these cases have no else; where none holds, nothing is done"
                          : "these percentages have no else; for the rest, nothing is done");
  }
  if (sum > 100.0001) messages_.error(context.file(), s.place, "these percentages sum up to more than 100");
  if (!isLast) place(behind);
}

void Compiler::statement(const Statement& s, const Context& context, bool isLast) {
  if (s.kind == Statement::Kind::leaf) {
    source(context, s.place);
    emit(kCgaLeafCode, {string(s.name)});
    return;
  }
  if (invoke(s, context, isLast)) return;
  if (s.name == "NIL" && !s.hasBlock) {
    emit(kCgaNilCode);
    return;
  }
  if (s.name == "set") return set(s, context);
  const auto operation = findOperation(s.name);
  if (!operation) return unknownStatement(s, context);
  const OperationInfo& info = operationInfo(*operation);
  checkCount(context.file(), s.place, s.name, s.arguments.size(), info.least, info.most);
  if (s.hasBlock != (info.block != Block::none)) {
    messages_.error(context.file(), s.place,
                    "'" + s.name + (s.hasBlock ? "' takes no block, { ... }" : "' needs a block, { ... }"));
    return;
  }
  if (s.hasBlock) return block(s, *operation, context);
  arguments(s.name, s.arguments, context, true);
  source(context, s.place);
  emit(kCgaOperationCode, {static_cast<uint32_t>(*operation), static_cast<uint32_t>(s.arguments.size())});
}

bool Compiler::invoke(const Statement& s, const Context& context, bool isLast) {
  if (s.hasBlock) return false;
  std::string last;
  bool isMissing = false;
  Module* module = resolve(s.name, context, last, isMissing);
  if (isMissing) {
    messages_.once("missing rule " + s.name.substr(0, s.name.find('.')), context.file(), s.place,
                   "'" + s.name + "' comes from an import that was not found; shapes end there");
    emit(kCgaLeafCode, {string(s.name)});
    return true;
  }
  Entity* entity = module->find(last, true, s.arguments.size());
  if (!entity && last == "start" && s.arguments.empty()) entity = module->start;
  if (!entity) return false;
  refer(context, *entity);
  for (const ExpressionPtr& a : s.arguments) expression(*a, context);
  source(context, s.place);
  if (isLast) lastInvokes_.push_back(program_.words.size());
  emit(isLast ? kCgaInvokeLastCode : kCgaInvokeCode);
  emitLabel(entity->label);
  emit(static_cast<uint32_t>(s.arguments.size()));
  return true;
}

void Compiler::unknownStatement(const Statement& s, const Context& context) {
  if (isUnsupportedOperation(s.name)) {
    messages_.once("operation " + s.name, context.file(), s.place,
                   "the operation '" + s.name + "' is not supported, and does nothing");
    return;
  }
  std::string last;
  bool isMissing = false;
  Module* module = resolve(s.name, context, last, isMissing);
  const auto [begin, end] = module->entities.equal_range(last);
  for (auto it = begin; it != end; ++it)
    if (it->second.kind == Definition::Kind::rule) {
      const size_t takes = it->second.definition->parameters.size();
      messages_.once("rule " + s.name, context.file(), s.place,
                     "the rule '" + s.name + "' takes " + std::to_string(takes) + (takes == 1 ? " value" : " values") +
                         ", not " + std::to_string(s.arguments.size()) + "; shapes end there");
      emit(kCgaLeafCode, {string(s.name)});
      return;
    }
  core::Suggestion suggestion(s.name);
  for (const auto& [name, entity] : context.scope->entities)
    if (entity.kind == Definition::Kind::rule) suggestion.offer(name);
  for (const std::string_view name : operationNames()) suggestion.offer(name);
  if (s.hasBlock) {
    messages_.once("operation " + s.name, context.file(), s.place,
                   "there is no operation '" + s.name + "'; it and its block do nothing" + suggestion.text());
    return;
  }
  // CGA takes it for the name of a shape that ends here.
  messages_.once("rule " + s.name, context.file(), s.place,
                 "there is no rule or operation '" + s.name + "'; shapes end there" + suggestion.text());
  emit(kCgaLeafCode, {string(s.name)});
}

void Compiler::set(const Statement& s, const Context& context) {
  checkCount(context.file(), s.place, "set", s.arguments.size(), 2, 2);
  if (s.arguments.size() != 2) return;
  const Expression& target = *s.arguments[0];
  if (target.kind != Expression::Kind::name || target.isCall) {
    messages_.error(context.file(), target.place, "set takes the name of an attribute first");
    return;
  }
  std::string last;
  bool isMissing = false;
  Module* module = resolve(target.text, context, last, isMissing);
  if (isMissing) {
    messages_.once("missing " + target.text.substr(0, target.text.find('.')), context.file(), target.place,
                   "'" + target.text + "' comes from an import that was not found");
    return;
  }
  if (Entity* entity = module->find(last, false, 0)) {
    if (entity->kind != Definition::Kind::attribute) {
      messages_.error(context.file(), target.place, "'" + target.text + "' is not an attr, and cannot be set");
      return;
    }
    refer(context, *entity);
    expression(*s.arguments[1], context);
    source(context, s.place);
    emit(kCgaSetAttributeCode, {entity->slot});
    if (mayDraw(*s.arguments[1])) path(Operation::path_drawn);
    return;
  }
  expression(*s.arguments[1], context);
  source(context, s.place);
  if (const auto operation = findSettable(target.text)) {
    emit(kCgaOperationCode, {static_cast<uint32_t>(*operation), 1});
  } else if (target.text.starts_with("material.")) {
    const auto [found, isNew] = materials_.try_emplace(target.text, static_cast<uint32_t>(slots_.size()));
    if (isNew) slots_.push_back(nullptr);
    emit(kCgaSetAttributeCode, {found->second});
  } else if (target.text.starts_with("pivot.")) {
    messages_.once("set " + target.text, context.file(), target.place,
                   "'" + target.text + "' is not supported, and cannot be set");
    emit(kCgaPopCode);
  } else {
    core::Suggestion suggestion(target.text);
    for (const auto& [name, entity] : context.scope->entities)
      if (entity.kind == Definition::Kind::attribute) suggestion.offer(name);
    messages_.error(context.file(), target.place, "there is no attribute '" + target.text + "'" + suggestion.text());
    emit(kCgaPopCode);
  }
}

void Compiler::selectors(const std::vector<Part>& parts, const Context& context, bool selectorFirst, uint32_t& count,
                         std::vector<uint32_t>& numbers) {
  for (const Part& part : parts) {
    if (part.isGroup) {
      selectors(part.group, context, selectorFirst, count, numbers);
      continue;
    }
    numbers.push_back(part.selector ? count : kCgaNoSelector);
    if (!part.selector) continue;
    const bool isShort = part.selector->text.size() == 1; // rather a name of the file
    if (!selectorFirst) drawsOf(*part.selector, numbers.size() - 1);
    const bool isRemainder = part.selector->text == "remainder" && !part.depth;
    const Type type = expression(*part.selector, context, (selectorFirst && !isShort) || isRemainder);
    if (type == Type::string || type == Type::array)
      messages_.error(context.file(), part.selector->place,
                      selectorFirst ? "a selector is a word or a number" : "a size is a number");
    if (!selectorFirst && type == Type::boolean)
      messages_.error(context.file(), part.selector->place, "a size is a number");
    ++count;
  }
}

void Compiler::block(const Statement& s, Operation operation, const Context& context) {
  const bool isPerimeter = operation == Operation::splitAndSetbackPerimeter_;
  const bool isSplit = operation == Operation::split_ || operation == Operation::splitArea_ || isPerimeter;
  PendingPart pending{&s.parts, s.repeats, {}, context, newLabel()};
  if (operation == Operation::setbackPerEdge_ && !s.arguments.empty()) {
    pending.perEdge = s.arguments[0].get();
    for (size_t i = 0; i < s.arguments.size(); ++i) {
      if (i)
        expression(*s.arguments[i], context);
      else
        nothing();
    }
  } else {
    arguments(s.name, s.arguments, context);
  }
  uint32_t count = static_cast<uint32_t>(s.arguments.size());
  selectors(s.parts, context, !isSplit, count, pending.selectors);
  if (count > 1000) messages_.error(context.file(), s.place, "a block of more than 1000 parts");
  if (!isSplit) {
    if (s.repeats) messages_.error(context.file(), s.place, "only the parts of a split repeat");
    for (const Part& part : s.parts)
      if (part.isGroup) messages_.error(context.file(), part.place, "only the parts of a split are nested");
  } else if (s.parts.empty()) {
    messages_.error(context.file(), s.place, "this split has no parts");
  }
  if (isPerimeter && (s.parts.size() != 2 || !s.parts[1].selector || s.parts[1].selector->text != "remainder"))
    messages_.error(context.file(), s.place, "the second block of splitAndSetbackPerimeter is { remainder : ... }");
  source(context, s.place);
  emit(kCgaBlockCode, {static_cast<uint32_t>(operation), count});
  emitLabel(pending.label);
  pending_.push_back(std::move(pending));
}

/// Tables first, then bodies.
void Compiler::parts(const PendingPart& pending) {
  std::vector<PartChunk> chunks;
  size_t selector = 0;
  if (pending.repeats) { // { ... }*: a table of one group
    place(pending.label);
    emit(1);
    const uint32_t inner = newLabel();
    emit(static_cast<uint32_t>(program_.words.size() + 1));
    emit(kCgaPartRepeated);
    emit(kCgaNoSelector);
    emitLabel(inner);
    table(*pending.parts, pending, selector, inner, nullptr, chunks);
  } else {
    table(*pending.parts, pending, selector, pending.label, pending.perEdge, chunks);
  }
  for (const PartChunk& made : chunks) {
    const size_t visible = pending.context.locals.size();
    chunk(made.label, pending.context.name, visible, visible);
    if (made.value) {
      expression(*made.value, pending.context);
      emit(kCgaReturnCode);
      continue;
    }
    const uint32_t end = newLabel();
    body(*made.body, pending.context, true, true, end);
    place(end);
    emit(kCgaEndCode);
  }
}

void Compiler::table(const std::vector<Part>& parts, const PendingPart& pending, size_t& selector, uint32_t label,
                     const Expression* perEdge, std::vector<PartChunk>& chunks) {
  place(label);
  std::vector<const Expression*> values; // with records behind those of the parts, in the same order
  for (const Part& part : parts)
    if (part.depth) values.push_back(part.depth.get());
  if (perEdge) values.push_back(perEdge);
  const size_t count = parts.size() + values.size(), offsets = program_.words.size() + 1;
  emit(static_cast<uint32_t>(count));
  for (size_t i = 0; i < count; ++i) emit(0);
  for (size_t i = 0; i < values.size(); ++i) {
    program_.words[offsets + parts.size() + i] = static_cast<uint32_t>(program_.words.size());
    const uint32_t target = newLabel();
    emit(kCgaPartEach);
    emit(kCgaNoSelector);
    emitLabel(target);
    chunks.push_back({nullptr, values[i], target});
  }
  for (size_t i = 0; i < parts.size(); ++i) {
    const Part& part = parts[i];
    program_.words[offsets + i] = static_cast<uint32_t>(program_.words.size());
    const uint32_t target = newLabel();
    if (part.isGroup) {
      emit(part.repeats ? kCgaPartRepeated : kCgaPartGroup);
      emit(kCgaNoSelector);
      emitLabel(target);
      table(part.group, pending, selector, target, nullptr, chunks);
    } else {
      emit(part.isConnected ? kCgaPartConnected : part.isOneShape ? kCgaPartTogether : kCgaPartEach);
      emit(pending.selectors[selector++]);
      emitLabel(target);
      chunks.push_back({&part.body, part.value.get(), target});
    }
  }
}

} // namespace gpgp::spawn::cga
