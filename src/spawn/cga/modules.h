// The files of a program: a main file and what it imports, each import an instance with values of its own.
#pragma once
#include "spawn/cga/syntax.h"

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace gpgp::spawn::cga {

/// All messages of a program's files. What is not supported is said once a kind.
class Messages {
public:
  struct Message {
    std::string file;
    Diagnostic diagnostic;
  };
  void error(const std::string& file, Place place, std::string text);
  void warning(const std::string& file, Place place, std::string text);
  /// The first of each kind, with how many more there are.
  void once(const std::string& kind, const std::string& file, Place place, std::string text);
  void add(const std::string& file, const Diagnostics& diagnostics);
  /// Those of a part of the work.
  void merge(const Messages& other);
  bool hasErrors() const { return errors_ > 0; }
  size_t errorCount() const { return errors_; }
  /// In the order of files and places.
  std::vector<Message> sorted() const;

private:
  static constexpr size_t kLimit = 1000; ///< further messages would only be noise
  void push(const std::string& file, Place place, GpgpSeverity severity, std::string text);
  std::vector<Message> all_;
  std::map<std::string, std::pair<size_t, uint32_t>> kinds_; // where the first one is, how many there are
  size_t errors_ = 0;
};

struct Module;

/// A definition in the instance that it belongs to.
struct Entity {
  const Definition* definition = nullptr;
  Module* owner = nullptr; ///< whose name it is
  Module* scope = nullptr; ///< where the names in it are looked up: of what an import passes, the importer
  Definition::Kind kind = Definition::Kind::rule; ///< of what an import passes, the kind of what it replaces
  Entity* same = nullptr;                         ///< the importer's attribute of this name, which it is
  uint32_t slot = 0;                              ///< of attributes and constants
  uint32_t label = 0;                             ///< of rules and functions, for calls
};

struct Module {
  const File* file = nullptr; ///< none: it could not be read, and was named
  std::string prefix;         ///< "Roof.Tiles.", empty for the main file
  Module* importer = nullptr;
  std::map<std::string, Module*> imports;
  std::multimap<std::string, Entity> entities; ///< by name; rules and functions by the number of parameters as well
  Entity* start = nullptr;
  bool hidesAll = false;       ///< by @Hidden before the import: its attributes, and those that it imports
  std::set<std::string> hides; ///< attributes that are hidden

  /// parameters: of rules and functions; attributes and constants have none.
  Entity* find(const std::string& name, bool isRule, size_t parameters);
};

/// Text of a file, or nothing. path: as it stands in the import, made relative to the importing file.
using ReadFile = std::function<bool(const std::string& path, std::string& text)>;

class Modules {
public:
  Modules(const ReadFile& read, Messages& messages) : read_(read), messages_(messages) {}
  /// The main file; none where it cannot be read.
  Module* load(const std::string& path, const std::string& text, const std::string& style);
  const std::vector<std::unique_ptr<Module>>& all() const { return modules_; }

private:
  const File* parsed(const std::string& path);
  Module* instantiate(const File* file, std::string prefix, Module* importer, const Import* import,
                      const std::string& style, uint32_t depth);
  void define(Module& module, const std::string& style);
  void apply(Module& module, const Import& import);
  void propagate(Module& module, const Import& import);

  const ReadFile& read_;
  Messages& messages_;
  std::map<std::string, std::unique_ptr<File>> files_; // none: was not found
  std::vector<std::unique_ptr<Module>> modules_;
};

} // namespace gpgp::spawn::cga
