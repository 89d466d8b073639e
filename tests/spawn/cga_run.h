// Compiles and derives .cga text, for tests.
#pragma once
#include "spawn/cga/compile.h"
#include "spawn/cga/derive.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

namespace gpgp::spawn::cga {

inline std::string allOf(const Messages& messages) {
  std::string text;
  for (const auto& m : messages.sorted()) text += format(m.diagnostic, m.file) + "\n";
  return text;
}

inline std::optional<Program> compiled(const std::string& text, Messages& messages,
                                       const std::map<std::string, std::string>& files = {},
                                       const std::string& style = {}) {
  CompileOptions options;
  options.path = "main.cga";
  options.style = style;
  options.read = [&](const std::string& path, std::string& into) {
    const auto found = files.find(path);
    if (found == files.end()) return false;
    into = found->second;
    return true;
  };
  return compile(text, options, messages);
}

inline Axiom lot(float x, float z, uint32_t seed = 1) {
  Axiom axiom;
  axiom.size = {x, 0, z};
  axiom.seed = seed;
  return axiom;
}

struct Derived {
  Derivation all;
  std::string messages;
  std::map<std::string, size_t> rules;
  double sum(const std::string& report) const {
    const auto found = all.reports.find(report);
    return found == all.reports.end() ? 0.0 : found->second.sum;
  }
};

inline Derived run(const std::string& text, const std::vector<Axiom>& axioms, const DeriveOptions& options = {},
                   const std::map<std::string, std::string>& files = {}) {
  Derived result;
  Messages messages;
  const auto program = compiled(text, messages, files);
  EXPECT_TRUE(program) << allOf(messages);
  if (program) result.all = derive(*program, axioms, options, messages);
  result.messages = allOf(messages);
  for (const Leaf& leaf : result.all.leaves) ++result.rules[result.all.names[leaf.name]];
  return result;
}
inline Derived run(const std::string& text) { return run(text, {lot(10, 20)}); }

inline std::vector<std::string> printed(const std::string& text) { return run(text).all.prints; }

} // namespace gpgp::spawn::cga
