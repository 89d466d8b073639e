// Expressions to code that leaves one value on the machine's stack.
#include "core/suggest.h"
#include "spawn/cga/compiler.h"

#include <algorithm>

namespace gpgp::spawn::cga {

using namespace shader;

namespace {
struct BinaryCode {
  std::string_view text;
  uint32_t code;
};
constexpr BinaryCode kBinary[] = {{"+", kCgaAddCode},       {"-", kCgaSubtractCode},     {"*", kCgaMultiplyCode},
                                  {"/", kCgaDivideCode},    {"%", kCgaModuloCode},       {"==", kCgaEqualCode},
                                  {"!=", kCgaNotEqualCode}, {"<", kCgaLessCode},         {"<=", kCgaLessEqualCode},
                                  {">", kCgaGreaterCode},   {">=", kCgaGreaterEqualCode}};
const char* nameOf(Type type) {
  return type == Type::string    ? "a string"
         : type == Type::boolean ? "true or false"
         : type == Type::array   ? "an array"
                                 : "a number";
}
/// Whether a question for tags may be for those of extrusions and splits, which cost shapes their shared meshes.
bool mayBeOwnTag(const Expression& call) {
  if (call.arguments.empty() || call.arguments[0]->kind != Expression::Kind::string) return true;
  const std::string_view query = call.arguments[0]->text;
  return query.empty() || query[0] == '*' || query[0] == '?' || query.starts_with("extrude") ||
         query.starts_with("split");
}
} // namespace

Module* Compiler::resolve(const std::string& path, const Context& context, std::string& last, bool& isMissing) {
  return resolvePath(path, context.scope, last, isMissing);
}

Module* resolvePath(const std::string& path, Module* module, std::string& last, bool& isMissing) {
  last = path;
  isMissing = false;
  for (size_t dot = last.find('.'); dot != std::string::npos; dot = last.find('.')) {
    const auto found = module->imports.find(last.substr(0, dot));
    if (found == module->imports.end()) break;
    module = found->second;
    last.erase(0, dot + 1);
    if (!module->file) {
      isMissing = true;
      break;
    }
  }
  return module;
}

/// A constant that is a plain value is used where it is named.
bool Compiler::literal(const Entity& entity, Type& type) {
  if (entity.kind != Definition::Kind::constant || !entity.definition->value || entity.scope != entity.owner)
    return false;
  const Expression& e = *entity.definition->value;
  if (e.kind == Expression::Kind::number) {
    emit(kCgaPushFloatCode, {floatBitsToUint(static_cast<float>(e.number))});
    type = Type::number;
  } else if (e.kind == Expression::Kind::string) {
    emit(kCgaPushStringCode, {string(e.text)});
    type = Type::string;
  } else if (e.kind == Expression::Kind::boolean) {
    emit(kCgaPushBoolCode, {e.number != 0 ? 1u : 0u});
    type = Type::boolean;
  } else {
    return false;
  }
  return true;
}

Type Compiler::expression(const Expression& e, const Context& context, bool selectorFirst) {
  switch (e.kind) {
  case Expression::Kind::number:
    emit(kCgaPushFloatCode, {floatBitsToUint(static_cast<float>(e.number))});
    return Type::number;
  case Expression::Kind::string: emit(kCgaPushStringCode, {string(e.text)}); return Type::string;
  case Expression::Kind::boolean: emit(kCgaPushBoolCode, {e.number != 0 ? 1u : 0u}); return Type::boolean;
  case Expression::Kind::name: return name(e, context, selectorFirst);
  case Expression::Kind::unary:
  case Expression::Kind::relative:
  case Expression::Kind::floating: {
    if (e.kind == Expression::Kind::unary && e.text == "-" && e.arguments[0]->kind == Expression::Kind::number) {
      emit(kCgaPushFloatCode, {floatBitsToUint(settle(-static_cast<float>(e.arguments[0]->number)))});
      return Type::number;
    }
    const Type type = expression(*e.arguments[0], context);
    if (e.text == ".!" || e.text == ".-") {
      source(context, e.place);
      if (e.text == ".!") {
        emit(kCgaFunctionCode, {static_cast<uint32_t>(Function::eachNot_), 1});
      } else { // -1 times each
        emit(kCgaPushFloatCode, {floatBitsToUint(-1.0f)});
        emit(kCgaEachCode, {kCgaMultiplyCode});
      }
      return Type::array;
    }
    const bool isNot = e.text == "!";
    if (type == Type::string || type == Type::array || (!isNot && type == Type::boolean))
      messages_.error(context.file(), e.place, "'" + e.text + "' stands before " + nameOf(type));
    emit(e.kind == Expression::Kind::relative   ? kCgaRelativeCode
         : e.kind == Expression::Kind::floating ? kCgaFloatingCode
         : isNot                                ? kCgaNotCode
                                                : kCgaNegateCode);
    return isNot ? Type::boolean : Type::number;
  }
  case Expression::Kind::binary: return binary(e, context);
  case Expression::Kind::index:
    source(context, e.place);
    for (const ExpressionPtr& a : e.arguments) expression(*a, context);
    emit(kCgaIndexCode, {static_cast<uint32_t>(e.arguments.size() - 1)});
    return Type::unknown;
  case Expression::Kind::range: {
    bool isOpen = false;
    for (const ExpressionPtr& a : e.arguments) {
      if (a)
        expression(*a, context);
      else
        emit(kCgaPushNothingCode), isOpen = true;
    }
    source(context, e.place);
    if (isOpen)
      emit(kCgaRangeCode);
    else
      emit(kCgaFunctionCode, {static_cast<uint32_t>(Function::sequence_), static_cast<uint32_t>(e.arguments.size())});
    return Type::unknown;
  }
  case Expression::Kind::components: {
    PendingPart pending{&e.parts, false, {}, context, newLabel()};
    arguments(e.text, e.arguments, context);
    uint32_t count = static_cast<uint32_t>(e.arguments.size());
    checkCount(context.file(), e.place, e.text, e.arguments.size(), 1, 2);
    selectors(e.parts, context, true, count, pending.selectors);
    source(context, e.place);
    emit(kCgaBlockCode, {static_cast<uint32_t>(Operation::componentValues_), count});
    emitLabel(pending.label);
    pending_.push_back(std::move(pending));
    emit(kCgaFunctionCode, {static_cast<uint32_t>(Function::componentResult_), 0});
    return Type::array;
  }
  case Expression::Kind::rows:
    for (const ExpressionPtr& row : e.arguments) expression(*row, context);
    if (e.arguments.size() > 2000) messages_.error(context.file(), e.place, "an array of more than 2000 rows");
    source(context, e.place);
    emit(kCgaFunctionCode, {static_cast<uint32_t>(Function::arrayRows_), static_cast<uint32_t>(e.arguments.size())});
    return Type::array;
  case Expression::Kind::array:
    for (const ExpressionPtr& a : e.arguments) {
      expression(*a, context);
      if (a->kind == Expression::Kind::range && (!a->arguments[0] || !a->arguments[1]))
        messages_.error(context.file(), a->place, "a sequence in an array needs both ends");
    }
    if (e.arguments.size() > 2000) messages_.error(context.file(), e.place, "an array of more than 2000 values");
    source(context, e.place);
    emit(kCgaArrayCode, {static_cast<uint32_t>(e.arguments.size())});
    return Type::array;
  case Expression::Kind::cases:
  case Expression::Kind::stochastic: return choices(e, context);
  }
  return Type::unknown;
}

Type Compiler::binary(const Expression& e, const Context& context) {
  const Type left = expression(*e.arguments[0], context);
  if (e.text == "&&" || e.text == "||") {
    const uint32_t end = newLabel();
    emit(e.text == "&&" ? kCgaAndCode : kCgaOrCode);
    emitLabel(end);
    const Type right = expression(*e.arguments[1], context);
    place(end);
    for (const Type type : {left, right})
      if (type == Type::string || type == Type::array)
        messages_.error(context.file(), e.place, "'" + e.text + "' joins conditions; one is " + nameOf(type));
    return Type::boolean;
  }
  const Type right = expression(*e.arguments[1], context);
  const bool each = e.text[0] == '.';
  const std::string_view text = each ? std::string_view(e.text).substr(1) : std::string_view(e.text);
  if (text == "&&" || text == "||") {
    source(context, e.place);
    emit(kCgaFunctionCode, {static_cast<uint32_t>(text == "&&" ? Function::eachAnd_ : Function::eachOr_), 2});
    return Type::array;
  }
  const uint32_t code =
      std::find_if(std::begin(kBinary), std::end(kBinary), [&](const BinaryCode& b) { return b.text == text; })->code;
  source(context, e.place);
  if (each) {
    emit(kCgaEachCode, {code});
    return Type::array;
  }
  emit(code);
  if (code >= kCgaEqualCode) return Type::boolean;
  if (code == kCgaAddCode && (left == Type::string || right == Type::string)) return Type::string;
  if (code == kCgaAddCode && (left == Type::unknown || right == Type::unknown)) return Type::unknown;
  for (const Type type : {left, right})
    if (type == Type::string)
      messages_.error(context.file(), e.place, "'" + e.text + "' computes with numbers; one side is a string");
  return left == Type::array || right == Type::array ? Type::array : Type::number;
}

Type Compiler::choices(const Expression& e, const Context& context) {
  const bool isCase = e.kind == Expression::Kind::cases;
  const uint32_t end = newLabel();
  Type type = Type::unknown;
  bool hasElse = false;
  double sum = 0;
  if (!isCase) emit(kCgaDrawCode);
  for (size_t i = 0; i < e.choices.size(); ++i) {
    const Choice& c = e.choices[i];
    const uint32_t next = newLabel();
    if (i == 1) ++choices_;
    if (c.condition) {
      const Type condition = expression(*c.condition, context);
      if (condition == Type::string || condition == Type::array)
        messages_.error(context.file(), c.condition->place,
                        std::string(isCase ? "a condition" : "a percentage") + " is " + nameOf(condition));
      if (!isCase && c.condition->kind == Expression::Kind::number) sum += c.condition->number;
      emit(isCase ? kCgaJumpUnlessCode : kCgaChooseCode);
      emitLabel(next);
    } else {
      hasElse = true;
      if (!isCase) emit(kCgaPopCode);
    }
    choices_ += i == 0;
    const Type value = expression(*c.value, context);
    choices_ -= i == 0;
    type = i == 0 || type == value ? value : Type::unknown;
    if (c.condition) {
      emit(kCgaJumpCode);
      emitLabel(end);
      place(next);
    }
  }
  if (e.choices.size() > 1) --choices_;
  if (!hasElse) {
    messages_.error(context.file(), e.place, isCase ? "these cases have no else" : "these percentages have no else");
    if (!isCase) emit(kCgaPopCode);
    nothing();
  }
  if (sum > 100.0001) messages_.error(context.file(), e.place, "these percentages sum up to more than 100");
  place(end);
  return type;
}

size_t placeOf(std::string_view operation, size_t argument, std::span<const ExpressionPtr> all) {
  if (operation == "extrude" || operation == "report") return 0;
  if (operation == "taper" || operation.starts_with("roof")) { // the height or angle is the third value there
    const bool hasMeasure = all[0]->text == "byHeight" || all[0]->text == "byAngle";
    return argument + 2 - (hasMeasure && argument ? 1 : 0);
  }
  return operation == "r" && all.size() == 4 && argument ? argument - 1 : argument;
}

void Compiler::arguments(std::string_view name, const std::vector<ExpressionPtr>& arguments, const Context& context,
                         bool isOperation) {
  const uint32_t words = wordArguments(name, arguments.size());
  for (size_t i = 0; i < arguments.size(); ++i) {
    if (isOperation) drawsOf(*arguments[i], placeOf(name, i, arguments));
    expression(*arguments[i], context, i < 32 && ((words >> i) & 1u));
  }
}

Type Compiler::name(const Expression& e, const Context& context, bool selectorFirst) {
  if (!e.isCall) {
    for (size_t i = context.locals.size(); i-- > 0;)
      if (context.locals[i] == e.text && !(selectorFirst && isSelector(e.text))) {
        emit(kCgaLocalCode, {static_cast<uint32_t>(i)});
        return Type::unknown;
      }
    if (selectorFirst && isSelector(e.text)) {
      emit(kCgaPushWordCode, {string(e.text)});
      return Type::unknown;
    }
  }
  if (selectorFirst && e.isCall && e.text == "isTagged" && !e.arguments.empty() && e.arguments.size() <= 2) {
    program_.asksOwnTags |= mayBeOwnTag(e);
    arguments(e.text, e.arguments, context); // not whether the shape has the tag, but a selector of what has it
    emit(kCgaPushBoolCode, {1});
    source(context, e.place);
    emit(kCgaFunctionCode, {static_cast<uint32_t>(Function::isTagged_), static_cast<uint32_t>(e.arguments.size() + 1)});
    return Type::unknown;
  }
  std::string last;
  bool isMissing = false;
  Module* module = resolve(e.text, context, last, isMissing);
  if (isMissing) {
    const std::string prefix = e.text.substr(0, e.text.size() - last.size() - 1);
    messages_.once("missing " + prefix, context.file(), e.place,
                   "'" + e.text + "' comes from an import that was not found, and is 0");
    nothing();
    return Type::unknown;
  }
  if (Entity* entity = module->find(last, false, e.arguments.size())) {
    refer(context, *entity);
    if (entity->kind == Definition::Kind::function) {
      for (const ExpressionPtr& a : e.arguments) expression(*a, context);
      source(context, e.place);
      emit(kCgaCallCode);
      emitLabel(entity->label);
      emit(static_cast<uint32_t>(e.arguments.size()));
      return Type::unknown;
    }
    Type type = Type::unknown;
    if (!literal(*entity, type)) emit(kCgaAttributeCode, {entity->slot});
    return type;
  }
  if (const auto function = findFunction(e.text)) {
    checkCount(context.file(), e.place, e.text, e.arguments.size(), function->least, function->most);
    if (!function->isMath && function->number == static_cast<uint32_t>(Function::Field_)) field(e, context);
    if (!function->isMath && function->number >= static_cast<uint32_t>(Function::geometry_isTagged_) &&
        function->number <= static_cast<uint32_t>(Function::isTagged_))
      program_.asksOwnTags |= mayBeOwnTag(e);
    if (!function->isMath && function->number >= static_cast<uint32_t>(Function::inside_) &&
        function->number <= static_cast<uint32_t>(Function::contextCompare_))
      contextQuery(e, static_cast<Function>(function->number));
    arguments(e.text, e.arguments, context);
    source(context, e.place);
    emit(function->isMath ? kCgaMathCode : kCgaFunctionCode,
         {function->number, static_cast<uint32_t>(e.arguments.size())});
    return function->isMath && function->number != kCgaPMath && function->number != kCgaIsinfMath &&
                   function->number != kCgaIsnanMath
               ? Type::number
               : Type::unknown;
  }
  if (!e.isCall && isSelector(e.text)) {
    emit(kCgaPushWordCode, {string(e.text)});
    return Type::unknown;
  }
  if (!e.isCall && e.text.starts_with("material.")) {
    const auto [found, isNew] = materials_.try_emplace(e.text, static_cast<uint32_t>(slots_.size()));
    if (isNew) slots_.push_back(nullptr);
    emit(kCgaAttributeCode, {found->second});
    return Type::unknown;
  }
  if (isUnsupportedFunction(e.text)) {
    const bool isString = e.text.ends_with("String") || e.text.starts_with("assetNaming");
    messages_.once("function " + e.text, context.file(), e.place,
                   "'" + e.text + "' is not supported, and is " + (isString ? "\"\"" : "0"));
    if (isString)
      emit(kCgaPushStringCode, {string({})});
    else
      nothing();
    return Type::unknown;
  }
  unknownName(e, context);
  nothing();
  return Type::unknown;
}

/// Notes which shapes a query for those around asks for.
void Compiler::contextQuery(const Expression& e, Function function) {
  asksContext_ = true;
  const auto isOf = [&](size_t i, std::string_view text) {
    return i < e.arguments.size() && !e.arguments[i]->isCall && e.arguments[i]->text == text;
  };
  if (isOf(0, "intra")) return;
  program_.asksAround = true;
  const Expression* label = e.arguments.size() > 1 ? e.arguments[1].get() : nullptr;
  const bool isLabelled = label && label->kind == Expression::Kind::string && !label->text.empty();
  if (function <= Function::touches_) program_.asksUnlabelled |= !isLabelled;
}

/// Notes which field is read where its name is a string.
void Compiler::field(const Expression& e, const Context& context) {
  if (e.arguments.size() == 2)
    messages_.error(context.file(), e.place, "'Field' takes the name of a field, or that, x and z");
  if (e.arguments.empty() || e.arguments[0]->kind != Expression::Kind::string) return;
  const std::string& name = e.arguments[0]->text;
  if (std::none_of(program_.fields.begin(), program_.fields.end(), [&](const FieldRead& f) { return f.name == name; }))
    program_.fields.push_back({name, context.file(), e.place});
}

void Compiler::unknownName(const Expression& e, const Context& context) {
  std::string last;
  bool isMissing = false;
  Module* module = resolve(e.text, context, last, isMissing);
  const auto [begin, end] = module->entities.equal_range(last);
  for (auto it = begin; it != end; ++it)
    if (it->second.kind != Definition::Kind::rule) {
      const size_t takes = it->second.definition->parameters.size();
      messages_.error(context.file(), e.place,
                      "'" + e.text + "' takes " + std::to_string(takes) + (takes == 1 ? " value" : " values") +
                          ", not " + std::to_string(e.arguments.size()));
      return;
    }
  core::Suggestion suggestion(e.text);
  for (const std::string& local : context.locals) suggestion.offer(local);
  for (const auto& [other, entity] : context.scope->entities)
    if (entity.kind != Definition::Kind::rule) suggestion.offer(other);
  for (const std::string_view other : functionNames()) suggestion.offer(other);
  if (!e.isCall)
    for (const std::string_view other : selectorNames()) suggestion.offer(other);
  const bool isImported = module != context.scope;
  if (isImported)
    for (const auto& [other, entity] : module->entities)
      if (entity.kind != Definition::Kind::rule)
        suggestion.offer(e.text.substr(0, e.text.size() - last.size()) + other);
  if (e.isCall || isImported) // perhaps of a newer version, of CGA or of the file: the rest derives
    messages_.once("function " + e.text, context.file(), e.place,
                   std::string(e.isCall ? "there is no function '" : "there is no attribute, constant or function '") +
                       e.text + "', and it is 0" + suggestion.text());
  else
    messages_.error(context.file(), e.place,
                    "there is no attribute, constant or function '" + e.text + "'" + suggestion.text());
}

} // namespace gpgp::spawn::cga
