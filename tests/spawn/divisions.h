// One grammar with a start for each way to divide a shape: all shapes that axioms have, and what Extrude and CompSplit
// make of them, along each axis, by each kind of SubDiv and by Repeat.
#pragma once
#include "grammars.h"
#include "spawn/evaluator/evaluator.h"

#include <string>
#include <vector>

namespace gpgp::test {

enum class Divide { nothing, byWeights, byLengths, byExpressions, keepFirst, repeat };

struct Division {
  std::string shape;    ///< of the axiom
  bool polygon = false; ///< what arrives at the operator
  bool keeps = false;   ///< a box, a quad or a sphere arrives: pieces have its shape along each axis
  char axis = 'X';
  Divide how = Divide::nothing;
};
struct Divisions {
  std::string text;
  std::vector<Division> all; ///< by axiom line
  std::vector<uint32_t> words;
  std::vector<GpgpAxiom> axioms; ///< one for each
};

inline Divisions makeDivisions() {
  struct Start {
    const char *shape, *corners;
    bool polygon, keeps;
  };
  // The concave ones have one piece on each side of a line along X or Y through their lower left corner's third.
  const char* convex = " { (-0.5,-0.5), (0.5,-0.4), (0.2,0.4), (-0.3,0.5) }";
  const char* concave = " { (-0.5,-0.5), (0.5,-0.5), (0.5,-0.3), (-0.3,-0.3), (-0.3,0.5), (-0.5,0.5) }";
  const Start starts[] = {{"Triangle", "", true, false},
                          {"Quad", "", true, true},
                          {"Pentagon", "", true, false},
                          {"Hexagon", "", true, false},
                          {"Heptagon", "", true, false},
                          {"Octagon", "", true, false},
                          {"DynamicConvexPolygon", convex, true, false},
                          {"DynamicPolygon", concave, true, false},
                          {"Prism3", "", false, false},
                          {"Box", "", false, true},
                          {"Prism5", "", false, false},
                          {"Prism6", "", false, false},
                          {"Prism7", "", false, false},
                          {"Prism8", "", false, false},
                          {"DynamicConvexRightPrism", convex, false, false},
                          {"DynamicRightPrism", concave, false, false},
                          {"Sphere", "", false, true}};
  Divisions result;
  std::string rules;
  const auto add = [&](const Start& start, bool changed, char axis, Divide how, const std::string& body) {
    const std::string rule = "R" + std::to_string(result.all.size());
    result.text += std::string("axiom ") + start.shape + start.corners + " " + rule + ";\n";
    const std::string before = !changed ? "" : start.polygon ? "Extrude(2) " : "CompSplit() { ";
    rules += rule + " = " + before + body + (changed && !start.polygon ? " | Discard() | Discard() };\n" : ";\n");
    result.all.push_back({start.shape, start.polygon != changed, start.keeps, axis, how});
  };
  for (const Start& start : starts)
    for (const bool changed : {false, true}) {
      if (changed && std::string(start.shape) == "Sphere") continue;
      add(start, changed, 'X', Divide::nothing, "T");
      for (const char axis : {'X', 'Y', 'Z'}) {
        const std::string divide = std::string("SubDiv(") + axis + ") { ", repeat = std::string("Repeat(") + axis;
        add(start, changed, axis, Divide::byWeights, divide + "-1: T | -2: U }");
        add(start, changed, axis, Divide::byLengths, divide + "0.5: T | -1: U }");
        add(start, changed, axis, Divide::byExpressions, divide + "Exp(0 - ShapeSize(X)): T | -1: U }");
        add(start, changed, axis, Divide::keepFirst, divide + "-1: T | -2: Discard() }");
        add(start, changed, axis, Divide::repeat, repeat + ", 0.7, ADJUST_TO_FILL) T");
      }
    }
  result.text += "terminal T (1,0);\nterminal U (1,1);\n" + rules;
  result.words = bake(result.text);
  const uint32_t ruleCount = result.words[shader::kHeaderSections + 2 * shader::kSectionRules];
  for (uint32_t i = 0; i < result.all.size(); ++i) {
    result.axioms.push_back(spawn::makeAxiom(2, 3, 4, 1, i));
    result.axioms.back().start = ruleCount + i;
  }
  return result;
}

} // namespace gpgp::test
