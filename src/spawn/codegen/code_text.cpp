#include "spawn/codegen/code_text.h"

#include "spawn/graph/operator_info.h"

#include <cstdio>

namespace gpgp::spawn {
using namespace shader;

std::string literal(float value) {
  char text[64];
  std::snprintf(text, sizeof text, "%.9gf", static_cast<double>(value));
  std::string result = text;
  if (result.find_first_of(".en") == std::string::npos) result.insert(result.size() - 1, ".0");
  if (value < 0) result = "(" + result + ")";
  return result;
}
std::string number(uint32_t value) { return std::to_string(value) + "u"; }
std::string component(uint32_t axis) { return std::string("s.size.") + "xyz"[axis]; }

std::string attribute(uint32_t code) {
  if (code == kCodeSeed) return "unitFloat(s.seed)";
  const Attribute& attribute = attributeAt(code);
  const uint32_t place = code - attribute.code;
  std::string member = attribute.member;
  if (code >= kCodeView) return "seenOf(s)." + member;
  if (attribute.axes == 2) member.back() = "XYZ"[place / 3]; // of axisX
  return "s." + member + (attribute.axes ? std::string(".") + "xyz"[place % 3] : std::string());
}

std::string operation(uint32_t code, const std::string& a, const std::string& b, uint32_t draw) {
  return replaced(binaryOf(code).text, [&](std::string_view word) {
    return word == "a"       ? a
           : word == "b"     ? b
           : word == "drawn" ? "drawnNumber(s.key, " + number(draw) + ")"
                             : std::string(word);
  });
}

} // namespace gpgp::spawn
