#include "spawn/cga/modules.h"

#include "core/suggest.h"
#include "spawn/cga/parser.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <tuple>

namespace gpgp::spawn::cga {
namespace {

constexpr uint32_t kDeepestImport = 32;
constexpr size_t kMostModules = 4096;

/// Where a path in an import may lie: beside the importing file, at the root of any folder above it (a path with a
/// slash in front begins at the workspace), without that folder's name, or under its folder "rules".
std::vector<std::string> places(const std::string& path, const std::string& importer) {
  namespace fs = std::filesystem;
  std::vector<std::string> result;
  std::string slashes = path; // some files have them of Windows
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  const fs::path relative = slashes.starts_with('/') ? fs::path(slashes.substr(1)) : fs::path(slashes);
  fs::path withoutFirst;
  for (auto part = relative.begin(); part != relative.end(); ++part)
    if (part != relative.begin()) withoutFirst /= *part;
  fs::path folder = fs::path(importer).parent_path();
  for (uint32_t i = 0; i < 16; ++i) {
    result.push_back((folder / relative).lexically_normal().string());
    if (!path.empty() && path[0] == '/') result.push_back((folder / withoutFirst).lexically_normal().string());
    result.push_back((folder / "rules" / relative).lexically_normal().string());
    const fs::path above = folder.parent_path();
    if (above == folder || folder.empty()) break;
    folder = above;
  }
  return result;
}

} // namespace

void Messages::push(const std::string& file, Place place, GpgpSeverity severity, std::string text) {
  // A file that is imported several times has its errors once.
  const auto isSame = [&](const Message& m) {
    const Diagnostic& d = m.diagnostic;
    return d.severity == severity && d.place.line == place.line && d.place.column == place.column && d.text == text &&
           m.file == file;
  };
  if (severity == GPGP_SEVERITY_ERROR && std::any_of(all_.begin(), all_.end(), isSame)) return;
  if (severity == GPGP_SEVERITY_ERROR) ++errors_;
  if (all_.size() < kLimit) all_.push_back({file, {place, severity, std::move(text)}});
}
void Messages::error(const std::string& file, Place place, std::string text) {
  push(file, place, GPGP_SEVERITY_ERROR, std::move(text));
}
void Messages::warning(const std::string& file, Place place, std::string text) {
  push(file, place, GPGP_SEVERITY_WARNING, std::move(text));
}
void Messages::once(const std::string& kind, const std::string& file, Place place, std::string text) {
  const auto [found, isNew] = kinds_.try_emplace(kind, all_.size(), 0u);
  ++found->second.second;
  if (isNew) warning(file, place, std::move(text));
}
void Messages::add(const std::string& file, const Diagnostics& diagnostics) {
  for (const Diagnostic& d : diagnostics.sorted()) push(file, d.place, d.severity, d.text);
}
void Messages::merge(const Messages& other) {
  std::map<size_t, const std::pair<const std::string, std::pair<size_t, uint32_t>>*> firsts;
  for (const auto& kind : other.kinds_) firsts[kind.second.first] = &kind;
  for (size_t i = 0; i < other.all_.size(); ++i) {
    const Message& m = other.all_[i];
    if (const auto found = firsts.find(i); found != firsts.end()) {
      once(found->second->first, m.file, m.diagnostic.place, m.diagnostic.text);
      kinds_[found->second->first].second += found->second->second.second - 1;
    } else {
      push(m.file, m.diagnostic.place, m.diagnostic.severity, m.diagnostic.text);
    }
  }
}
std::vector<Messages::Message> Messages::sorted() const {
  std::vector<Message> result = all_;
  for (const auto& [kind, first] : kinds_)
    if (first.second > 1 && first.first < result.size())
      result[first.first].diagnostic.text += " (and " + std::to_string(first.second - 1) + " more of these)";
  std::vector<std::string> files; // in the order in which they appear
  for (const Message& m : result)
    if (std::find(files.begin(), files.end(), m.file) == files.end()) files.push_back(m.file);
  const auto key = [&](const Message& m) {
    return std::tuple(std::find(files.begin(), files.end(), m.file) - files.begin(), m.diagnostic.place.line,
                      m.diagnostic.place.column);
  };
  std::stable_sort(result.begin(), result.end(), [&](const Message& a, const Message& b) { return key(a) < key(b); });
  return result;
}

Entity* Module::find(const std::string& name, bool isRule, size_t parameters) {
  const auto [begin, end] = entities.equal_range(name);
  for (auto it = begin; it != end; ++it) {
    const Definition& d = *it->second.definition;
    if ((it->second.kind == Definition::Kind::rule) != isRule || d.parameters.size() != parameters) continue;
    Entity* entity = &it->second;
    while (entity->same) entity = entity->same;
    return entity;
  }
  return nullptr;
}

Module* Modules::load(const std::string& path, const std::string& text, const std::string& style) {
  Diagnostics diagnostics;
  files_[path] = std::make_unique<File>(parse(text, path, diagnostics));
  messages_.add(path, diagnostics);
  return instantiate(files_[path].get(), {}, nullptr, nullptr, style, 0);
}

const File* Modules::parsed(const std::string& path) {
  const auto found = files_.find(path);
  if (found != files_.end()) return found->second.get();
  std::string text;
  std::unique_ptr<File>& file = files_[path];
  if (!read_(path, text)) return nullptr;
  Diagnostics diagnostics;
  file = std::make_unique<File>(parse(text, path, diagnostics));
  messages_.add(path, diagnostics);
  return file.get();
}

Module* Modules::instantiate(const File* file, std::string prefix, Module* importer, const Import* import,
                             const std::string& style, uint32_t depth) {
  modules_.push_back(std::make_unique<Module>());
  Module* module = modules_.back().get();
  module->file = file;
  module->prefix = std::move(prefix);
  module->importer = importer;
  if (import) {
    module->hidesAll = import->hidesAll || importer->hidesAll;
    module->hides = {import->hides.begin(), import->hides.end()};
  }
  if (!file) return module;
  define(*module, style);
  if (import) apply(*module, *import), propagate(*module, *import);
  for (const Import& i : file->imports) {
    if (i.prefix.empty()) {
      messages_.error(file->path, i.place, "an import needs a prefix: import name: \"" + i.path + '"');
      continue;
    }
    if (module->imports.count(i.prefix)) {
      messages_.error(file->path, i.place, "two imports have the prefix '" + i.prefix + "'");
      continue;
    }
    bool isCycle = false;
    const File* imported = nullptr;
    for (const std::string& path : places(i.path, file->path)) {
      imported = parsed(path);
      if (imported) break;
    }
    for (const Module* above = module; above && imported; above = above->importer)
      if (above->file == imported) isCycle = true;
    if (isCycle) {
      messages_.error(file->path, i.place, "\"" + i.path + "\" imports itself, by way of others or not");
      imported = nullptr;
    } else if (!imported) {
      messages_.once("import " + i.path, file->path, i.place,
                     "there is no file \"" + i.path + "\"; names that it would define have no effect");
    } else if (depth + 1 > kDeepestImport || modules_.size() >= kMostModules) {
      messages_.error(file->path, i.place,
                      "imports are nested more than " + std::to_string(kDeepestImport) + " deep, or more than " +
                          std::to_string(kMostModules));
      imported = nullptr;
    }
    module->imports[i.prefix] = instantiate(imported, module->prefix + i.prefix + '.', module, &i, i.style, depth + 1);
  }
  return module;
}

void Modules::define(Module& module, const std::string& style) {
  const File& file = *module.file;
  std::vector<std::string> active; // styles, the one that is chosen last
  for (std::string at = style; !at.empty() && active.size() <= file.styles.size();) {
    const auto found =
        std::find_if(file.styles.begin(), file.styles.end(), [&](const Style& s) { return s.name == at; });
    if (found == file.styles.end() && at == "Default") break; // what belongs to no style
    if (found == file.styles.end()) {
      core::Suggestion suggestion(at);
      for (const Style& s : file.styles) suggestion.offer(s.name);
      messages_.error(file.path, {}, "there is no style '" + at + "'" + suggestion.text());
      break;
    }
    active.insert(active.begin(), at);
    at = found->base;
  }
  active.insert(active.begin(), std::string());
  for (const std::string& name : active)
    for (const Definition& d : file.definitions) {
      if (d.style != name) continue;
      const bool isRule = d.kind == Definition::Kind::rule;
      if (Entity* other = module.find(d.name, isRule, d.parameters.size())) {
        if (other->definition->style == name)
          messages_.error(file.path, d.place,
                          "'" + d.name + "' is defined twice with as many parameters, first in line " +
                              std::to_string(other->definition->place.line));
        else
          other->definition = &d;
        continue;
      }
      module.entities.emplace(d.name, Entity{&d, &module, &module, d.kind});
    }
  // What @StartRule marks, else the first rule.
  for (const bool marked : {true, false})
    for (const Definition& d : file.definitions)
      if (!module.start && d.kind == Definition::Kind::rule && d.style.empty() && (d.isStart || !marked))
        module.start = module.find(d.name, true, d.parameters.size());
}

void Modules::apply(Module& module, const Import& import) {
  for (const Definition& d : import.overrides) {
    const bool isRule = d.kind == Definition::Kind::rule;
    Entity* entity = module.find(d.name, isRule, d.parameters.size());
    if (!entity) {
      core::Suggestion suggestion(d.name);
      for (const auto& [name, other] : module.entities) suggestion.offer(name);
      messages_.warning(module.importer->file->path, d.place,
                        "\"" + import.path + "\" has no " + (isRule ? "rule" : "attribute") + " '" + d.name +
                            "' to be passed" + suggestion.text());
      continue;
    }
    entity->definition = &d;
    entity->scope = module.importer;
  }
}

namespace {
/// Whether an attribute is given the value of a name: attr height = Import.height.
bool takes(const Entity& attribute, const std::string& name) {
  const std::function<bool(const Expression&)> holds = [&](const Expression& e) {
    if (e.kind == Expression::Kind::name && !e.isCall && e.text == name) return true;
    return std::any_of(e.arguments.begin(), e.arguments.end(),
                       [&](const ExpressionPtr& a) { return a && holds(*a); }) ||
           std::any_of(e.choices.begin(), e.choices.end(), [&](const Choice& c) {
             return (c.condition && holds(*c.condition)) || (c.value && holds(*c.value));
           });
  };
  return attribute.definition->value && holds(*attribute.definition->value);
}
} // namespace

/// An attribute that the importing file has as well is that one, unless the import protects it or gives it a value, or
/// the importing file takes its value from there.
void Modules::propagate(Module& module, const Import& import) {
  const auto has = [](const auto& list, const auto& isIt) { return std::any_of(list.begin(), list.end(), isIt); };
  for (const std::string& name : import.isProtected)
    if (!module.find(name, false, 0)) {
      core::Suggestion suggestion(name);
      for (const auto& [other, entity] : module.entities) suggestion.offer(other);
      messages_.warning(module.importer->file->path, import.place,
                        "\"" + import.path + "\" has no attribute '" + name + "' to be protected" + suggestion.text());
    }
  if (import.protectsAll) return;
  for (auto& [name, entity] : module.entities) {
    const std::string& own = name;
    if (entity.kind != Definition::Kind::attribute || entity.scope != &module) continue;
    if (has(import.isProtected, [&](const std::string& p) { return p == own; })) continue;
    Entity* outer = module.importer->find(name, false, 0);
    if (outer && outer->kind == Definition::Kind::attribute && !takes(*outer, import.prefix + '.' + name))
      entity.same = outer;
  }
}

} // namespace gpgp::spawn::cga
