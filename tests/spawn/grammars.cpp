#include "grammars.h"

#include <algorithm>
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

std::vector<std::string> messagesOf(const std::string& text, const std::vector<GpgpVariable>& variables) {
  spawn::Diagnostics diagnostics;
  spawn::compile(text, variables, diagnostics, std::pmr::new_delete_resource());
  std::vector<std::string> result;
  for (const spawn::Diagnostic& d : diagnostics.sorted()) result.push_back(spawn::format(d, "").substr(1));
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

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  if (at == std::string::npos) throw std::runtime_error("the text has no \"" + from + "\"");
  return text.replace(at, from.size(), to);
}

} // namespace gpgp::test
