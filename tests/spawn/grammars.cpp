#include "grammars.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace gpgp::test {
namespace {
std::optional<std::string> readText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}
} // namespace

std::optional<std::string> sharedGrammar(const std::string& name) {
  return readText(GPGP_SHARED_DATA "/grammars/" + name);
}

std::string ownGrammar(const std::string& name) {
  auto text = readText(GPGP_TEST_DATA "/grammars/" + name);
  if (!text) throw std::runtime_error("there is no tests/data/grammars/" + name);
  return *text;
}

std::vector<std::string> ownGrammarNames() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(GPGP_TEST_DATA "/grammars"))
    if (entry.path().extension() == ".pga") names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string messageOf(const spawn::Diagnostic& diagnostic) {
  return spawn::format(diagnostic, "").substr(diagnostic.place.line ? 1 : 2);
}

std::vector<std::string> messagesOf(const std::string& text, const std::vector<GpgpVariable>& variables) {
  spawn::Diagnostics diagnostics;
  spawn::compile(text, variables, diagnostics, std::pmr::new_delete_resource());
  std::vector<std::string> result;
  for (const spawn::Diagnostic& d : diagnostics.sorted()) result.push_back(messageOf(d));
  return result;
}

std::vector<uint32_t> bake(const std::string& text, const std::vector<GpgpVariable>& variables) {
  spawn::Diagnostics diagnostics;
  const spawn::Graph graph = spawn::compile(text, variables, diagnostics, std::pmr::new_delete_resource());
  std::string messages;
  for (const spawn::Diagnostic& d : diagnostics.sorted()) messages += spawn::format(d, "grammar") + "\n";
  if (diagnostics.hasErrors()) throw std::runtime_error(messages);
  if (auto ok = spawn::validate(graph); !ok) throw std::runtime_error(ok.error().text);
  const auto words = spawn::serialize(graph, std::pmr::new_delete_resource());
  return {words.begin(), words.end()};
}

namespace {
std::vector<uint32_t> link(const std::vector<GrammarFile>& files, GpgpCompileFlags flags,
                           std::vector<std::string>& messages) {
  std::vector<GpgpGrammarSource> sources;
  for (const GrammarFile& file : files) {
    GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
    source.name = file.name.c_str();
    if (file.text.starts_with("gppg"))
      source.baked = file.text.data();
    else
      source.text = file.text.data();
    source.alias = file.alias;
    source.size = file.text.size();
    source.variables = file.variables.data();
    source.variableCount = static_cast<uint32_t>(file.variables.size());
    source.flags = flags;
    source.messageUserData = &messages;
    source.messageFn = [](void* user, const GpgpCompileMessage* m) {
      const spawn::Diagnostic diagnostic{{m->line, m->column}, m->severity, m->text};
      static_cast<std::vector<std::string>*>(user)->push_back(spawn::format(diagnostic, m->file));
    };
    sources.push_back(source);
  }
  GpgpBlob blob{};
  const GpgpResult result = gpgpLinkGrammars(sources.data(), static_cast<uint32_t>(sources.size()), &blob);
  if (result != GPGP_SUCCESS && messages.empty()) messages.push_back("failed without a message");
  std::vector<uint32_t> words(blob.size / 4);
  if (blob.data) std::memcpy(words.data(), blob.data, blob.size);
  gpgpFreeBlob(&blob);
  return words;
}
} // namespace

std::vector<uint32_t> linked(const std::vector<GrammarFile>& files, GpgpCompileFlags flags) {
  std::vector<std::string> messages;
  auto words = link(files, flags, messages);
  std::string all;
  for (const std::string& message : messages) all += message + "\n";
  if (words.empty()) throw std::runtime_error(all);
  return words;
}

std::vector<std::string> linkMessages(const std::vector<GrammarFile>& files) {
  std::vector<std::string> messages;
  link(files, 0, messages);
  return messages;
}

GrammarFile bakedFile(const GrammarFile& file, GpgpCompileFlags flags) {
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  source.text = file.text.data();
  source.size = file.text.size();
  source.variables = file.variables.data();
  source.variableCount = static_cast<uint32_t>(file.variables.size());
  source.flags = flags;
  GpgpBlob blob{};
  if (gpgpCompileGrammar(&source, &blob) != GPGP_SUCCESS) throw std::runtime_error(file.name + " has errors");
  GrammarFile baked{file.name, {static_cast<const char*>(blob.data), blob.size}};
  gpgpFreeBlob(&blob);
  return baked;
}

std::string textOf(const std::string& path) {
  auto text = readText(path);
  if (!text) throw std::runtime_error("there is no " + path);
  return *text;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  if (at == std::string::npos) throw std::runtime_error("the text has no \"" + from + "\"");
  return text.replace(at, from.size(), to);
}

} // namespace gpgp::test
