// From modules to a program: which definitions there are, in which order attributes get their values, and offsets.
#include "spawn/cga/compile.h"

#include "core/suggest.h"
#include "spawn/cga/compiler.h"
#include "spawn/cga/files.h"
#include "spawn/cga/lower.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace gpgp::spawn::cga {

using namespace shader;

uint32_t Compiler::string(const std::string& text) {
  const auto [found, isNew] = strings_.try_emplace(text, static_cast<uint32_t>(program_.strings.size()));
  if (isNew) program_.strings.push_back(text);
  return found->second;
}

uint32_t Compiler::newLabel() {
  labels_.push_back(0);
  return static_cast<uint32_t>(labels_.size() - 1);
}

void Compiler::emit(uint32_t code, std::initializer_list<uint32_t> operands) {
  emit(code);
  for (const uint32_t operand : operands) emit(operand);
}

void Compiler::emitLabel(uint32_t label) {
  fixups_.push_back({static_cast<uint32_t>(program_.words.size()), label});
  emit(0);
}

void Compiler::source(const Context& context, Place place) {
  const auto [found, isNew] = files_.try_emplace(context.file(), static_cast<uint32_t>(program_.files.size()));
  if (isNew) program_.files.push_back(context.file());
  program_.sources.push_back({static_cast<uint32_t>(program_.words.size()), found->second, place});
}

void Compiler::chunk(uint32_t label, const std::string& name, size_t parameters, size_t locals) {
  place(label);
  emit(string(name));
  emit(static_cast<uint32_t>(parameters));
  emit(static_cast<uint32_t>(locals));
}

void Compiler::refer(const Context& context, Entity& to) {
  references_[context.entity].push_back(&to);
  if (choices_ == 0) certain_.insert({context.entity, &to});
}

void Compiler::assignSlots() {
  for (const auto& module : modules_->all())
    for (auto& [name, entity] : module->entities) {
      if (entity.same) continue;
      entity.label = newLabel();
      if (entity.kind != Definition::Kind::attribute && entity.kind != Definition::Kind::constant) continue;
      if (entity.kind == Definition::Kind::constant && !entity.definition->parameters.empty()) {
        entity.kind = Definition::Kind::function;
        continue;
      }
      entity.slot = static_cast<uint32_t>(slots_.size());
      slots_.push_back(&entity);
    }
}

void Compiler::definition(Entity& entity) {
  const Definition& d = *entity.definition;
  Context context{entity.scope, d.parameters, entity.owner->prefix + d.name, &entity};
  const size_t locals = d.parameters.size() + d.locals.size();
  if (locals > 250) {
    messages_.error(context.file(), d.place, "'" + d.name + "' has more than 250 parameters and local variables");
    return;
  }
  chunk(entity.label, context.name, d.parameters.size(), locals);
  for (const Local& local : d.locals) {
    expression(*local.value, context);
    emit(kCgaSetLocalCode, {static_cast<uint32_t>(context.locals.size())});
    context.locals.push_back(local.name);
    if (!d.value) path(Operation::path_drawn);
  }
  if (d.value) {
    expression(*d.value, context);
    emit(kCgaReturnCode);
  } else {
    const uint32_t end = newLabel();
    body(d.body, context, true, true, end);
    place(end);
    emit(kCgaEndCode);
  }
  while (!pending_.empty()) {
    const PendingPart next = std::move(pending_.back());
    pending_.pop_back();
    parts(next);
  }
}

void Compiler::definitions() {
  for (const auto& module : modules_->all()) {
    // In the order of the file, so that messages and programs are.
    std::vector<Entity*> entities;
    for (auto& [name, entity] : module->entities) entities.push_back(&entity);
    std::stable_sort(entities.begin(), entities.end(), [](const Entity* a, const Entity* b) {
      return std::pair(a->definition->place.line, a->definition->place.column) <
             std::pair(b->definition->place.line, b->definition->place.column);
    });
    for (Entity* entity : entities) {
      if (entity->same) continue;
      definition(*entity);
      if (entity->kind != Definition::Kind::rule) continue;
      RuleInfo rule;
      rule.name = module->prefix + entity->definition->name;
      rule.file = entity->scope->file->path;
      rule.place = entity->definition->place;
      rule.parameters = static_cast<uint32_t>(entity->definition->parameters.size());
      rule.chunk = entity->label; // an offset below
      rule.isStart = entity == module->start;
      for (const Annotation& a : entity->definition->annotations) rule.isHidden |= a.name == "Hidden";
      program_.rules.push_back(std::move(rule));
    }
  }
}

/// Slots that roots can reach, each behind those that its value needs. Cycles are told where tells says so.
std::vector<uint32_t> Compiler::order(const std::vector<Entity*>& roots, bool tells) {
  std::vector<uint32_t> result;
  enum class State : uint8_t { untouched, open, done };
  std::unordered_map<Entity*, State> states;
  struct Visit {
    Entity* entity;
    size_t next = 0;
  };
  const auto isSlot = [](const Entity& e) {
    return e.kind == Definition::Kind::attribute || e.kind == Definition::Kind::constant;
  };
  std::set<uint32_t> ordered;
  std::vector<Visit> stack;
  size_t root = 0;
  while (!stack.empty() || root < roots.size()) {
    if (stack.empty()) {
      Entity* next = roots[root++];
      if (!next || states[next] != State::untouched) continue;
      states[next] = State::open;
      stack.push_back({next});
    }
    Visit& visit = stack.back();
    const std::vector<Entity*>& to = references_[visit.entity];
    if (visit.next < to.size()) {
      Entity* next = to[visit.next++];
      State& state = states[next];
      if (state == State::untouched) {
        state = State::open;
        stack.push_back({next});
      } else if (tells && state == State::open && isSlot(*next)) {
        // A cycle by way of functions, or of one of several values, may never be run; what does run sees the value 0.
        bool isDirect = true;
        Entity* behind = next;
        for (auto it = stack.rbegin(); it != stack.rend(); ++it) {
          isDirect &= isSlot(*it->entity) && certain_.count({it->entity, behind});
          behind = it->entity;
          if (it->entity == next) break;
        }
        mayNeedItself_ |= !isDirect;
        const Definition& d = *next->definition;
        if (isDirect)
          messages_.error(next->scope->file->path, d.place, "the value of '" + d.name + "' needs itself");
        else
          messages_.once("cycle " + d.name, next->scope->file->path, d.place,
                         "the value of '" + d.name + "' may need itself, which is then 0");
      }
      continue;
    }
    if (isSlot(*visit.entity)) result.push_back(visit.entity->slot);
    states[visit.entity] = State::done;
    stack.pop_back();
  }
  return result;
}

namespace {
AnnotationValue valueOf(const AnnotationArgument& argument) {
  AnnotationValue result;
  result.name = argument.name;
  const Expression* e = argument.value.get();
  double sign = 1;
  if (e && e->kind == Expression::Kind::unary && e->text == "-") {
    sign = -1;
    e = e->arguments[0].get();
  }
  if (!e) return result;
  result.text = e->text;
  if (e->kind == Expression::Kind::number) {
    result.number = sign * e->number;
    std::ostringstream text;
    text << *result.number;
    result.text = text.str();
  }
  if (e->kind == Expression::Kind::boolean) result.text = e->number != 0 ? "true" : "false";
  return result;
}
} // namespace

void Compiler::attributes() {
  for (Entity* entity : slots_) {
    AttributeInfo info;
    if (entity) {
      const Definition& d = *entity->definition;
      info.name = entity->owner->prefix + d.name;
      info.file = entity->scope->file->path;
      info.place = d.place;
      info.isConstant = entity->kind == Definition::Kind::constant;
      info.chunk = labels_[entity->label];
      const auto add = [&](const Annotation& a) {
        AttributeAnnotation annotation{a.name, {}};
        for (const AnnotationArgument& argument : a.arguments) annotation.values.push_back(valueOf(argument));
        info.annotations.push_back(std::move(annotation));
      };
      if (d.group && !d.group->arguments.empty()) add(*d.group); // @Group alone leaves the group
      for (const Annotation& a : d.annotations) add(a);
      const bool isHidden = entity->owner->hidesAll || entity->owner->hides.count(d.name);
      const auto isSaid = [](const AttributeAnnotation& a) { return a.name == "Hidden"; };
      if (isHidden && std::none_of(info.annotations.begin(), info.annotations.end(), isSaid))
        info.annotations.push_back({"Hidden", {}});
    } else {
      info.isMaterial = true;
    }
    program_.attributes.push_back(std::move(info));
  }
  for (const auto& [name, slot] : materials_) program_.attributes[slot].name = name;
}

Entity* Compiler::startRule(Module& main) {
  if (options_.start.empty()) {
    if (!main.start) {
      messages_.error(main.file->path, {}, "there is no rule to start with");
    } else if (!main.start->definition->parameters.empty()) {
      // The first rule without parameters, as long as nothing is marked.
      for (const Definition& d : main.file->definitions)
        if (d.kind == Definition::Kind::rule && d.parameters.empty())
          if (Entity* found = main.find(d.name, true, 0)) return found;
      messages_.error(main.file->path, main.start->definition->place,
                      "the start rule '" + main.start->definition->name + "' has parameters");
      return nullptr;
    }
    return main.start;
  }
  Module* module = &main;
  std::string name = options_.start;
  for (size_t dot = name.find('.'); dot != std::string::npos; dot = name.find('.')) {
    const auto found = module->imports.find(name.substr(0, dot));
    if (found == module->imports.end() || !found->second->file) break;
    module = found->second;
    name.erase(0, dot + 1);
  }
  if (Entity* found = module->find(name, true, 0)) return found;
  core::Suggestion suggestion(options_.start);
  for (const auto& [other, entity] : main.entities)
    if (entity.kind == Definition::Kind::rule && entity.definition->parameters.empty()) suggestion.offer(other);
  messages_.error(main.file->path, {},
                  "there is no rule '" + options_.start + "' without parameters to start with" + suggestion.text());
  return nullptr;
}

std::optional<Program> Compiler::run(const std::string& text) {
  modules_ = std::make_unique<Modules>(options_.read, messages_);
  Module* main = modules_->load(options_.path, text, options_.style);
  program_.words.push_back(0);
  string({});
  assignSlots();
  definitions();
  Entity* start = startRule(*main);
  if (start) {
    program_.order = order({start}, true);
    program_.wholeOrder = order(slots_, false);
    // Where values may need each other in a ring, those that were chosen are right when they were worked out again.
    for (std::vector<uint32_t>* slots : {&program_.order, &program_.wholeOrder}) {
      const std::vector<uint32_t> once = *slots;
      if (mayNeedItself_) slots->insert(slots->end(), once.begin(), once.end());
    }
  }
  if (messages_.hasErrors() || !start) return std::nullopt;
  attributes();
  for (const auto& [at, label] : fixups_) program_.words[at] = labels_[label];
  // A rule that asks for labels runs when all shapes of the generation before it have theirs.
  for (const size_t at : lastInvokes_)
    if (asksContext_) program_.words[at] = kCgaInvokeCode;
  for (uint32_t i = 0; i < program_.rules.size(); ++i) {
    if (program_.rules[i].chunk == start->label) program_.start = i;
    program_.rules[i].chunk = labels_[program_.rules[i].chunk];
  }
  program_.folder = std::filesystem::path(options_.path).parent_path().string();
  if (!program_.folder.empty()) program_.folder += '/';
  if (const std::string wrong = validate(program_); !wrong.empty()) { // which would be the compiler's fault
    messages_.error(options_.path, {}, "the compiled program is wrong: " + wrong + "; please report this");
    return std::nullopt;
  }
  if (options_.graph) program_.graph = Lowering(options_.attributes, program_).run(*start);
  return std::move(program_);
}

std::optional<Program> compile(const std::string& text, const CompileOptions& options, Messages& messages) {
  return Compiler(options, messages).run(text);
}

ReadFile filesOnDisk() {
  return [](const std::string& path, std::string& text) {
    const std::string found = existingFile(path);
    if (found.empty()) return false;
    std::ifstream file(found, std::ios::binary);
    std::ostringstream all;
    all << file.rdbuf();
    text = all.str();
    return static_cast<bool>(file);
  };
}

} // namespace gpgp::spawn::cga
