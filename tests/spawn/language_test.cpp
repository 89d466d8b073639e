// The PGA-shape front end: what is accepted, and every error with its exact place.
#include "grammars.h"
#include "spawn/language/print.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using Messages = std::vector<std::string>;

constexpr const char* kHead = "axiom Box A;\nterminal T (1,0);\n"; // rules begin in line 3

Messages ofRules(const std::string& rules) { return messagesOf(kHead + rules); }

TEST(Language, AcceptsEveryArrow) {
  for (const char* arrow : {"-->", "->", "==>", "=>", "=", ">>"})
    EXPECT_EQ(ofRules("A " + std::string(arrow) + " T;"), Messages{}) << arrow;
}

TEST(Language, NamesMayBeginWithDigits) {
  EXPECT_EQ(messagesOf("axiom Box 2A; terminal 3rd_Floor (1,0); 2A = 3rd_Floor;"), Messages{});
}

TEST(Language, CommentsAndLayout) {
  EXPECT_EQ(ofRules("/* a\n * b */ A // c\n=\r\n\tT // d"),
            Messages{"6:8: error: expected ';' at the end of the rule, found the end of the file"});
  EXPECT_EQ(ofRules("A = T; /* no end"), Messages{"3:8: error: this comment has no end; expected '*/'"});
}

TEST(Language, ReportsAllErrorsInOrder) {
  EXPECT_EQ(messagesOf("axiom Box A;\n"
                       "terminal T (1,0);\n"
                       "A = Translate(1,2) T;\n"
                       "B = Nowhere;\n"
                       "C = { T };\n"
                       "D = Translate(1,0,0) T\n"
                       "E = SubDiv(W) { 1: T | T };\n"
                       "F = Translate(1,0,0) Q;\n"),
            (Messages{"3:5: error: Translate takes 3 arguments, found 2",
                      "4:5: error: there is no rule or terminal 'Nowhere'",
                      "5:5: error: expected an operator, a rule or a terminal, found '{'",
                      "7:1: error: expected ';' at the end of the rule, found 'E'",
                      "7:12: error: expected an axis: X, Y or Z",
                      "7:24: error: expected a value before the successor of SubDiv",
                      "8:22: error: there is no rule or terminal 'Q'"}));
}

TEST(Language, WarningsHideNoErrorsAndWhatIsLeftOutIsCounted) {
  std::string doubtful = "A = T;\n", wrong;
  for (int i = 0; i < 1005; ++i) doubtful += "R" + std::to_string(i) + " = 60%: T 60%: T;\n";
  for (int i = 0; i < 1500; ++i) wrong += "B = $\n";
  const Messages both = ofRules(doubtful + "Z = Nowhere;");
  ASSERT_EQ(both.size(), 1002u);
  EXPECT_EQ(both[1000], "1009:5: error: there is no rule or terminal 'Nowhere'");
  EXPECT_EQ(both[1001], "warning: 5 more warnings are left out");

  spawn::Diagnostics diagnostics;
  spawn::compile(wrong, {}, diagnostics, std::pmr::new_delete_resource());
  const std::vector<spawn::Diagnostic> errors = diagnostics.sorted();
  ASSERT_EQ(errors.size(), 1001u);
  EXPECT_EQ(1000 + errors[1000].omitted, diagnostics.errorCount());
  EXPECT_EQ(messageOf(errors[1000]), "error: " + std::to_string(errors[1000].omitted) + " more errors are left out");
}

// What was meant by a missing ';' is clear where another statement begins: it is the only error.
TEST(Language, MissingSemicolonsSwallowNothing) {
  EXPECT_EQ(messagesOf("var a = 1\nvar b = 2;\naxiom Box A;\nterminal T (1,0);\nA = Translate(a,b,0) T;"),
            Messages{"2:1: error: expected ';' after the variable, found 'var'"});
  EXPECT_EQ(messagesOf("axiom Box A\nterminal T (1,0);\nA = T;"),
            Messages{"2:1: error: expected ';' after the axiom, found 'terminal'"});
  EXPECT_EQ(messagesOf("axiom Box A;\nterminal T (1,0)\nterminal U (1,1);\nA = Replicate() { T | U };"),
            Messages{"3:1: error: expected ';' after the terminal, found 'terminal'"});
  EXPECT_EQ(messagesOf(
                "terminal T (1,0)\naxiom DynamicPolygon { (0,0),(.5,0),(0,.5) } A\nvar c = 1\nA = Translate(c,0,0) T;"),
            (Messages{"2:1: error: expected ';' after the terminal, found 'axiom'",
                      "3:1: error: expected ';' after the axiom, found 'var'",
                      "4:1: error: expected ';' after the variable, found 'A'"}));
  EXPECT_EQ(messagesOf("axiom Box A;\nterminal T\nterminal U (1,1);\nA = Replicate() { T | U };"),
            Messages{"3:1: error: expected '(' with kind and index after the names of terminals, found 'terminal'"});
  EXPECT_EQ(ofRules("A = Replicate() { T | B\nB =\nC = Translate(1,0,0)\n2D = T"),
            (Messages{"4:1: error: expected '|' or '}' after a successor, found 'B'",
                      "5:1: error: expected an operator, a rule or a terminal, found 'C'",
                      "5:5: error: Translate needs a successor; shapes end in a terminal or Discard()",
                      "6:1: error: expected ';' at the end of the rule, found '2D'",
                      "6:7: error: expected ';' at the end of the rule, found the end of the file"}));
  // Rules, terminals and vars may be called so.
  EXPECT_EQ(messagesOf("axiom Box axiom; terminal terminal var (1,0);\naxiom = Replicate() { terminal | var };"),
            Messages{});
}

TEST(Language, AnErrorHidesNoOtherOne) {
  EXPECT_EQ(ofRules("A = SubDiv(X) { 1: T | -1: U | -1 V | 2 2: T | : T | -1: W };\nV = ;\nB = Q;"),
            (Messages{"3:28: error: there is no rule or terminal 'U'",
                      "3:35: error: expected ':' between a value and its successor, found 'V'",
                      "3:41: error: expected ':' between a value and its successor, found '2'",
                      "3:48: error: expected a value, found ':'", "3:58: error: there is no rule or terminal 'W'",
                      "4:5: error: expected an operator, a rule or a terminal, found ';'",
                      "5:5: error: there is no rule or terminal 'Q'"}));
  EXPECT_EQ(
      ofRules("A = Rotate(1, , 2) Scale(1 2, x, Rand(1)) Repeat(W, q, FILL) Foo(zz, zz + 1) Nope;"),
      (Messages{"3:15: error: expected a value, found ','",
                "3:28: error: expected ',' or ')' after an argument, found '2'",
                "3:31: error: there is no var 'x'; expected a value", "3:34: error: Rand takes 2 arguments, found 1",
                "3:50: error: expected an axis: X, Y or Z", "3:53: error: there is no var 'q'; expected a value",
                "3:56: error: expected ADJUST_TO_FILL, ANCHOR_TO_START or ANCHOR_TO_END",
                "3:62: error: there is no operator 'Foo'", "3:70: error: there is no var 'zz'; expected a value",
                "3:78: error: there is no rule or terminal 'Nope'"}));
  EXPECT_EQ(
      ofRules("A = If(Exp(a = 1)) { U | Translate(b,0 T };\nB = Translate(c,0,0) Scale(1,1 W;\nC = V;"),
      (Messages{"3:14: error: expected ',' or ')' after an argument, found '='",
                "3:22: error: there is no rule or terminal 'U'", "3:36: error: there is no var 'b'; expected a value",
                "3:40: error: expected ',' or ')' after an argument, found 'T'",
                "4:15: error: there is no var 'c'; expected a value",
                "4:32: error: expected ',' or ')' after an argument, found 'W'",
                "5:5: error: there is no rule or terminal 'V'"}));
  // Parentheses and braces within what is wrong are passed by.
  EXPECT_EQ(ofRules("A = Replicate() { Translate(1 (2),(3),4) T | T { U | V } | W };"),
            (Messages{"3:31: error: expected ',' or ')' after an argument, found '('",
                      "3:48: error: expected '|' or '}' after a successor, found '{'",
                      "3:60: error: there is no rule or terminal 'W'"}));
}

TEST(Language, WrongCountsHideNoArguments) {
  EXPECT_EQ(ofRules("A = Translate(nosuch, 1) T;"),
            (Messages{"3:5: error: Translate takes 3 arguments, found 2",
                      "3:15: error: there is no var 'nosuch'; expected a value"}));
  EXPECT_EQ(ofRules("A = Repeat(X, ADJUST_TO_FILL) T;"), Messages{"3:5: error: Repeat takes 3 arguments, found 2"});
  EXPECT_EQ(ofRules("A = Discard(Unknown3) { Unknown4 };"),
            (Messages{"3:5: error: Discard() takes neither arguments nor successors",
                      "3:13: error: there is no var 'Unknown3'; expected a value",
                      "3:25: error: there is no rule or terminal 'Unknown4'"}));
  EXPECT_EQ(ofRules("A = Translate(ShapeRotation(Q, R), Rand(a,b,c), Sin(d + 1)) T;").size(), 8u);
  EXPECT_EQ(ofRules("A = SetAsDynamicConvexPolygon((p,0),1,(0,q)) T;"),
            (Messages{"3:32: error: there is no var 'p'; expected a value", "3:37: error: expected a corner as (x, y)",
                      "3:42: error: there is no var 'q'; expected a value"}));
}

TEST(Language, TheOrderOfCollidersIsCheckedBesideOtherErrors) {
  EXPECT_EQ(ofRules("A = IfCollides(w) { M | Nope };\nM = Collider(w) T;"),
            (Messages{"3:5: error: IfCollides(w) waits for all of Collider(w) in line 4, which comes after it",
                      "3:25: error: there is no rule or terminal 'Nope'"}));
  // Tags with an error are nobody's.
  EXPECT_EQ(ofRules("A = IfCollides(0.5) { M | T };\nM = Collider(-1) T;"),
            (Messages{"3:16: error: a tag is a name or a whole number from 0",
                      "4:14: error: a tag is a name or a whole number from 0"}));
}

TEST(Language, ProbabilitiesBeyondAHundredPercentAreToldOf) {
  EXPECT_EQ(ofRules("A = 120%: T 90%: T else: T;"),
            Messages{"3:1: warning: these probabilities add up to 210%; expected at most 100%: each counts as its "
                     "share of the sum, and nothing is left for 'else'"});
  EXPECT_EQ(ofRules("A = 33.4%: T 33.3%: T 33.3%: T;"), Messages{});
  std::string many = "A = ";
  for (int i = 0; i < 33; ++i) many += "1%: T ";
  EXPECT_EQ(ofRules(many + ";"), Messages{"3:1: error: a rule takes at most 32 alternatives, found 33"});
}

TEST(Language, AlternativesMayEndInACall) {
  for (const char* rules :
       {"A = 20%: Discard() else: T;", "A = 20%: Discard() 30%: T else: T;", "A = 20%: T 30%: Generate() else: T;",
        "A = 20%: Discard() | 30%: Discard() | else: T;", "A = 20%: Replicate() { T | T } 80%: Generate();",
        "A = 20%: 12 30%: 12 else: 12; 12 = Discard();", "A = 20%: else else: T; else = T;"})
    EXPECT_EQ(ofRules(rules), Messages{}) << rules;
  // and elsewhere a name behind a call is its successor, whatever it is called
  EXPECT_EQ(ofRules("A = Translate(1,0,0) else; else = Scale(1,1,1) 12; 12 = T;"), Messages{});
  EXPECT_EQ(ofRules("A = 20%: Translate(1,0,0) else: T;"),
            Messages{"3:10: error: Translate needs a successor; shapes end in a terminal or Discard()"});
}

TEST(Language, ProbabilitiesThatMeanNothingAreErrors) {
  EXPECT_EQ(ofRules("A = RandomRule(ShapeSeed()) { -1: T | 2: T };"),
            Messages{"3:31: error: a probability must not be negative"});
  EXPECT_EQ(messagesOf("var v = 1; axiom Box A; terminal T (1,0); A = RandomRule(0) { 1: T | v - 2: T };"),
            Messages{"1:72: error: a probability must not be negative"});
  const Messages allZero{"3:5: error: these probabilities are all 0; expected one that is more"};
  EXPECT_EQ(ofRules("A = RandomRule(ShapeSeed()) { 0: T | 0: T };"), allZero);
  EXPECT_EQ(ofRules("A = RandomRule(ShapeSeed()) { 0: T | ShapeSize(X): T };"), Messages{});
  EXPECT_EQ(ofRules("A = 0%: T 0%: T;"),
            Messages{"3:1: error: these probabilities are all 0; expected one that is more"});
  EXPECT_EQ(ofRules("A = 0%: T else: T;"), Messages{});
  // What could not be read is not 0.
  EXPECT_EQ(ofRules("A = RandomRule(0) { w: T | 0: T };"),
            Messages{"3:21: error: there is no var 'w'; expected a value"});
  EXPECT_EQ(ofRules("A = RandomRule(0) { };").size(), 1u);
}

TEST(Language, TheLastTerminalLineHasItsPlace) {
  std::string lines = "axiom Box A;\n";
  for (int i = 0; i < 1024; ++i) lines += "terminal T" + std::to_string(i) + " (1,0);\n";
  EXPECT_EQ(messagesOf(lines + "A = T0;"), Messages{});
  EXPECT_EQ(messagesOf(lines + "terminal U (1,0); terminal V (1,0);\nA = T0;"),
            Messages{"1026:1: error: more than 1024 terminal lines"});
  EXPECT_EQ(messagesOf(lines + "A = Generate();"),
            Messages{"1026:5: error: Generate() is a terminal line more than the 1024 that a grammar can have"});
}

// ---------------------------------------------------------------- numbers that are none

TEST(LanguageNumbers, WhatConstantsCannotBeIsAnError) {
  const std::string large = "numbers go up to 2^100, which is 1.2676506e30";
  EXPECT_EQ(ofRules("A = Translate(1 / 0,0,0) T;"), Messages{"3:17: error: this divides by 0"});
  EXPECT_EQ(ofRules("A = Translate(0 / 0,0,0) T;"), Messages{"3:17: error: this divides by 0"});
  EXPECT_EQ(ofRules("A = Translate(0,Exp(2 - ShapeSize(X) / (3 - 3)),0) T;"),
            Messages{"3:38: error: this divides by 0"});
  EXPECT_EQ(ofRules("A = SubDiv(X) { Rand(1,5/0): T | -1: T };"), Messages{"3:25: error: this divides by 0"});
  EXPECT_EQ(ofRules("var zero = 2 - 2; A = If(ShapeSize(X) > 1 / zero) { T | T };"),
            Messages{"3:43: error: this divides by 0"});
  EXPECT_EQ(ofRules("A = Translate(1e20 * 1e20,0,0) T;"), Messages{"3:20: error: this becomes too large; " + large});
  EXPECT_EQ(ofRules("A = Translate(0,1 / 1e-38 * 1,0) T;"),
            Messages{"3:19: error: this divides by 0"}); // it settles to 0
  EXPECT_EQ(ofRules("A = Translate(1e29 / 1e-20,0,0) T;"), Messages{"3:20: error: this becomes too large; " + large});
  EXPECT_EQ(ofRules("A = Translate(2e30,0,0) T;"), Messages{"3:15: error: this is too large; " + large});
  EXPECT_EQ(ofRules("A = Translate(1.2e30 + 1e29,0,0) T;"), Messages{"3:22: error: this becomes too large; " + large});
  EXPECT_EQ(ofRules("A = Translate(1.2e30,-1.2e30,1 / 1e-29) T;"), Messages{});
  EXPECT_EQ(ofRules("A = Translate(ShapeSize(X) / ShapePos(X),0,0) T;"), Messages{}); // a matter of the shape
}

TEST(LanguageNumbers, RoofsHaveFormsMeasuresAnglesAndFaces) {
  const std::string form = "the form of a roof is 0 to 7; this is ", face = "the face of a roof is 0 to 4; this is ",
                    measure = "the measure of a roof is 0 (height), 1 (rise by run) or 2 (degrees); this is ",
                    angle = "the angle of a roof is less than 90 degrees; this is ";
  const auto roof = [](const char* values) { return ofRules(std::string("A = RaiseRoof(") + values + ") T;"); };
  EXPECT_EQ(roof("8,0,1"), Messages{"3:15: error: " + form + "8"});
  EXPECT_EQ(roof("-1,0,1"), Messages{"3:15: error: " + form + "-1"});
  EXPECT_EQ(roof("2 * 5,0,1"), Messages{"3:17: error: " + form + "10"});
  EXPECT_EQ(roof("0,3,1"), Messages{"3:17: error: " + measure + "3"});
  EXPECT_EQ(roof("0,2,90"), Messages{"3:19: error: " + angle + "90"});
  EXPECT_EQ(roof("0,2,-120.5"), Messages{"3:19: error: " + angle + "-120.5"});
  EXPECT_EQ(roof("9,7,1"), (Messages{"3:15: error: " + form + "9", "3:17: error: " + measure + "7"}));
  EXPECT_EQ(roof("0,1,90"), Messages{}) << "a slope";
  EXPECT_EQ(roof("7,2,89"), Messages{});
  EXPECT_EQ(roof("ShapeSize(X),ShapeSize(Y),ShapeSize(Z)"), Messages{}) << "a matter of the shape";
  const auto side = [](const char* n) {
    return ofRules(std::string("A = RaiseRoof(0,0,1) ToRoofFace(") + n + ",0,0) T;");
  };
  EXPECT_EQ(side("4"), Messages{});
  EXPECT_EQ(side("5"), Messages{"3:33: error: " + face + "5"});
  EXPECT_EQ(side("-0.5"), Messages{"3:33: error: " + face + "-0.5"});
  EXPECT_EQ(side("ShapeSize(X)"), Messages{});
}

TEST(LanguageNumbers, WhatIsSetHasToBeOne) {
  const std::string text = "var v = 1;\naxiom Box A;\nterminal T (1,0);\nA = Translate(1 / v,0,0) T;";
  const auto said = [&](float value) {
    GpgpVariable variable{};
    variable.name = "v";
    variable.value = value;
    return messagesOf(text, {variable});
  };
  EXPECT_EQ(said(2), Messages{});
  EXPECT_EQ(said(0), Messages{"4:17: error: this divides by 0"});
  for (const float value : {INFINITY, -INFINITY, NAN, 3e38f}) {
    const Messages messages = said(value);
    ASSERT_FALSE(messages.empty());
    EXPECT_EQ(messages[0].substr(0, 30), "error: var 'v' cannot be set t") << messages[0];
  }
}

// ---------------------------------------------------------------- did you mean

TEST(LanguageSuggestions, NameWhatIsMeant) {
  const auto only = [](const std::string& rules) {
    const Messages messages = ofRules(rules);
    EXPECT_EQ(messages.size(), 1u) << rules;
    return messages.empty() ? std::string() : messages[0];
  };
  const std::string operators = "3:5: error: there is no operator ",
                    functions =
                        " is not a function; expected Exp, Min, Max, Floor, Noise, Rand, Field, ShapePos, ShapeSize, "
                        "ShapeRotation, ShapeNormal, ShapeSeed, "
                        "ShapeCustomAttribute, CameraDistance, ScreenSize or OutOfView; did you mean ";
  EXPECT_EQ(only("A = translate(1,0,0) T;"), operators + "'translate'; did you mean 'Translate'?");
  EXPECT_EQ(only("A = Tarnslate(1,0,0) T;"), operators + "'Tarnslate'; did you mean 'Translate'?");
  EXPECT_EQ(only("A = Subdivide(1,0,0) T;"), operators + "'Subdivide'; did you mean 'SubDiv'?");
  EXPECT_EQ(only("A = Replicat() { T | T };"), operators + "'Replicat'; did you mean 'Replicate'?");
  EXPECT_EQ(only("A = SetAsDynamicConvexPrism((0,0),(0.5,0),(0,0.5)) T;"), operators + "'SetAsDynamicConvexPrism'");
  EXPECT_EQ(only("A = SetAsDynamicConvexRightPrsm((0,0),(0.5,0),(0,0.5)) T;"),
            operators + "'SetAsDynamicConvexRightPrsm'; did you mean 'SetAsDynamicConvexRightPrism'?");
  EXPECT_EQ(only("A = Wnidow; Window = T;").substr(0, 75),
            "3:5: error: there is no rule or terminal 'Wnidow'; did you mean 'Window'?");
  EXPECT_EQ(only("A = t;"), "3:5: error: there is no rule or terminal 't'; did you mean 'T'?");
  EXPECT_EQ(only("A = discard;"), "3:5: error: there is no rule or terminal 'discard'; did you mean 'Discard'?");
  EXPECT_EQ(only("A = Translate(ShapSize(X),0,0) T;"), "3:15: error: 'ShapSize'" + functions + "'ShapeSize'?");
  EXPECT_EQ(only("A = Translate(rand(0,1),0,0) T;"), "3:15: error: 'rand'" + functions + "'Rand'?");
  EXPECT_EQ(only("var height = 3; A = Translate(hieght,0,0) T;"),
            "3:31: error: there is no var 'hieght'; expected a value; did you mean 'height'?");
  EXPECT_NE(messagesOf("axiom box A; terminal T (1,0); A = T;")[0].find("; did you mean 'Box'?"), std::string::npos);
  GpgpVariable variable{};
  variable.name = "Heigth";
  EXPECT_EQ(messagesOf("var height = 1; axiom Box A; terminal T (1,0); A = Translate(height,0,0) T;", {variable}),
            Messages{"error: there is no var 'Heigth' that could be set; did you mean 'height'?"});
  // What is like nothing, or longer than names are, stays alone.
  EXPECT_EQ(only("A = Zq;"), "3:5: error: there is no rule or terminal 'Zq'");
  EXPECT_EQ(only("A = " + std::string(100, 'T') + ";"),
            "3:5: error: there is no rule or terminal '" + std::string(100, 'T') + "'");
}

// ---------------------------------------------------------------- names of names

/// Instructions that this thread takes are not asked for; chains that were followed from each rule would be 5 * 10^9
/// steps.
TEST(LanguageAliases, LongChainsAreFollowedOnce) {
  constexpr int kRules = 100000;
  std::string forward = "axiom Box R0;\nterminal T (1,0);\n", backward = forward, circle = forward;
  for (int i = 0; i < kRules; ++i) {
    const std::string name = "R" + std::to_string(i), next = "R" + std::to_string(i + 1);
    forward += name + " = " + (i + 1 < kRules ? next : "T") + ";\n";
    circle += name + " = " + (i + 1 < kRules ? next : "R" + std::to_string(kRules / 2)) + ";\n";
  }
  for (int i = kRules; i-- > 0;)
    backward += "R" + std::to_string(i) + " = " + (i + 1 < kRules ? "R" + std::to_string(i + 1) : "T") + ";\n";
  for (const std::string& text : {forward, backward}) {
    spawn::Diagnostics diagnostics;
    const spawn::Graph graph = spawn::compile(text, {}, diagnostics, std::pmr::new_delete_resource());
    EXPECT_FALSE(diagnostics.hasErrors());
    ASSERT_EQ(graph.rules.size(), size_t(kRules));
    for (const spawn::Rule& rule : graph.rules) ASSERT_EQ(rule.node, graph.rules[0].node);
    EXPECT_EQ(graph.nodes.size(), 1u);
  }
  const Messages messages = messagesOf(circle);
  ASSERT_EQ(messages.size(), 1001u);
  EXPECT_EQ(messages[0], std::to_string(3 + kRules / 2) + ":1: error: rule 'R" + std::to_string(kRules / 2) +
                             "' leads back to itself without any operator");
  EXPECT_EQ(messages[1000], "error: " + std::to_string(kRules / 2 - 1000) + " more errors are left out");
}

TEST(LanguageAliases, CirclesAreNamedAndWhatLeadsToThemIsNot) {
  const std::string back = "' leads back to itself without any operator";
  EXPECT_EQ(ofRules("A = B; B = C; C = B; D = D; E = Scale(1,1,1) A;"),
            (Messages{"3:8: error: rule 'B" + back, "3:15: error: rule 'C" + back, "3:22: error: rule 'D" + back}));
}

struct Case {
  const char* rules;
  const char* message;
};
class LanguageError : public testing::TestWithParam<Case> {};
TEST_P(LanguageError, HasItsPlace) { EXPECT_EQ(ofRules(GetParam().rules), Messages{GetParam().message}); }
INSTANTIATE_TEST_SUITE_P(
    All, LanguageError,
    testing::Values(
        Case{"A = B;", "3:5: error: there is no rule or terminal 'B'"},
        Case{"A = Foo(1) T;", "3:5: error: there is no operator 'Foo'"},
        Case{"A = T(1);", "3:5: error: 'T' is not an operator; expected no '(' after it"},
        Case{"A = T T;", "3:7: error: expected ';' at the end of the rule, found 'T'"},
        Case{"A = Translate;", "3:5: error: expected '(' after the operator Translate"},
        Case{"A = Translate(1,2) T;", "3:5: error: Translate takes 3 arguments, found 2"},
        Case{"A = Extrude(1);", "3:5: error: Extrude needs a successor; shapes end in a terminal or Discard()"},
        Case{"A = SubDiv(X) T;", "3:15: error: expected '{' after SubDiv(...)"},
        Case{"A = SubDiv(X) { 1: T | T };", "3:24: error: expected a value before the successor of SubDiv"},
        Case{"A = SubDiv(Q) { 1: T };", "3:12: error: expected an axis: X, Y or Z"},
        Case{"A = SubDiv(X) { 1: T | };", "3:24: error: expected an operator, a rule or a terminal, found '}'"},
        Case{"A = Repeat(X, 1, FILL) T;", "3:18: error: expected ADJUST_TO_FILL, ANCHOR_TO_START or ANCHOR_TO_END"},
        Case{"A = If(1) { T };", "3:5: error: If takes 2 successors, found 1"},
        Case{"A = If(1) T;", "3:11: error: expected '{' after If(...)"},
        Case{"A = CompSplit() { T | T };", "3:5: error: CompSplit takes 3 successors (top | bottom | sides), found 2"},
        Case{"A = Replicate() { 1: T };", "3:19: error: Replicate takes successors without a value before them"},
        Case{"A = Translate(x,0,0) T;", "3:15: error: there is no var 'x'; expected a value"},
        Case{"A = Translate((1,2),0,0) T;", "3:15: error: expected one value, found a pair (x, y)"},
        Case{"A = Translate(ShapeSize(),0,0) T;", "3:15: error: ShapeSize takes an axis, found 0 arguments"},
        Case{"A = Translate(ShapeRotation(X),0,0) T;",
             "3:15: error: ShapeRotation takes an axis and a component, found 1 argument"},
        Case{"A = Translate(Sin(1),0,0) T;",
             "3:15: error: 'Sin' is not a function; expected Exp, Min, Max, Floor, Noise, "
             "Rand, Field, ShapePos, ShapeSize, ShapeRotation, ShapeNormal, "
             "ShapeSeed, ShapeCustomAttribute, CameraDistance, ScreenSize or "
             "OutOfView; did you mean 'Min'?"},
        Case{"A = Translate(Field(),0,0) T;",
             "3:15: error: Field takes the name of a field, or that, x and z; found 0 arguments"},
        Case{"A = Translate(Field(h, 1),0,0) T;",
             "3:15: error: Field takes the name of a field, or that, x and z; found 2 arguments"},
        Case{"A = Translate(Field(1, 2, 3),0,0) T;",
             "3:15: error: Field takes the name of a field, or that, x and z; found no name"},
        Case{"A = Translate(Field(h, x, 3),0,0) T;", "3:24: error: there is no var 'x'; expected a value"},
        Case{"A = Translate(1 +,0,0) T;", "3:18: error: expected a value, found ','"},
        Case{"A = Translate(1,0,0 T;", "3:21: error: expected ',' or ')' after an argument, found 'T'"},
        Case{"A = Collider() T;", "3:5: error: Collider takes 1 argument, found 0"},
        Case{"A = Collider(-1) T;", "3:14: error: a tag is a name or a whole number from 0"},
        Case{"A = Collider(0.5) T;", "3:14: error: a tag is a name or a whole number from 0"},
        Case{"A = Collider(Rand(0,1)) T;", "3:14: error: a tag must not depend on the shape"},
        Case{"A = Collider(wall);", "3:5: error: Collider needs a successor; shapes end in a terminal or Discard()"},
        Case{"A = IfCollides(1) T;", "3:19: error: expected '{' after IfCollides(...)"},
        Case{"A = IfCollides(1) { T };", "3:5: error: IfCollides takes 2 successors, found 1"},
        Case{"A = Collider(wall) T;", "3:5: warning: Collider(wall) has no effect: there is no IfCollides(wall)"},
        Case{"A = IfCollides(3) { T | T };", "3:5: warning: IfCollides(3) has no effect: there is no Collider(3)"},
        Case{"A = IfCollides(wall) { T | Scale(1,1,1) Collider(wall) A };",
             "3:5: error: IfCollides(wall) waits for all of Collider(wall) in line 3, which comes after it"},
        Case{"A = A;", "3:1: error: rule 'A' leads back to itself without any operator"},
        Case{"A = T; A = T;", "3:8: error: 'A' is defined twice; the first time in line 3"},
        Case{"A = T; Scale = T;", "3:8: error: 'Scale' is the name of an operator; expected another name"},
        Case{"A = T; var x = 1; var x = 2;", "3:23: error: var 'x' is defined twice"},
        Case{"A = T; axiom Quad B;", "3:19: error: there is no rule or terminal 'B'"},
        Case{"A = T; terminal U (2,0);", "3:20: error: a terminal's kind is 0 (triangles) or 1 (an instanced mesh)"},
        Case{"A = T; terminal U (1,0.5);", "3:22: error: a terminal's index is a whole number from 0"},
        Case{"A = T; terminal U (1);", "3:8: error: a terminal needs (kind, index), found 1 value"},
        Case{"A = SetAsDynamicConvexPolygon((0,0),(.5,0)) T;", "3:5: error: expected 3 to 4096 corners, found 2"},
        Case{"A = SetAsDynamicConvexPolygon((0,0),(.2,0),(.4,0)) T;", "3:5: error: the polygon has no area"},
        Case{"A = SetAsDynamicConvexPolygon((0,0),(.2,0),(.1,.1),(.1,.3)) T;", "3:5: error: the polygon is not convex"},
        Case{"A = SetAsDynamicConcavePolygon((0,0),(.2,.2),(.2,0),(0,.1)) T;",
             "3:5: error: the polygon crosses itself"},
        Case{"A = SetAsDynamicConvexPolygon((0,.5),(-.3,-.4),(.5,.2),(-.5,.2),(.3,-.4)) T;",
             "3:5: error: the polygon crosses itself"},
        Case{"A = SetAsDynamicConvexPolygon((0,0),(ShapeSize(X),0),(.5,.5)) T;",
             "3:38: error: a corner must not depend on the shape"},
        Case{"A = SetAsDynamicConvexPolygon((0,.5),(-.5,-Exp(0.25*2)),(5,-.5)) T;",
             "3:57: error: x and y of a corner are from -0.5 to 0.5"},
        Case{"A = T; axiom DynamicPolygon { (0,.5),(-.5,0),(0,-.6) } A;",
             "3:46: error: x and y of a corner are from -0.5 to 0.5"},
        Case{"A = T; terminal U (1, 0, 3.5, 7);",
             "3:26: warning: a terminal has (kind, index); values behind them have no effect"},
        Case{"A = Discard() T;", "3:5: error: Discard() takes neither arguments nor successors"},
        Case{"A = $ T;", "3:5: error: '$' has no meaning here"},
        Case{"A = T; x", "3:9: error: expected '-->' or '=' after the name of a rule, found the end of the file"},
        Case{"A = Translate(1e99,0,0) T;", "3:15: error: the number is too large"}));

TEST(Language, MissingAxiomAndUnknownShape) {
  EXPECT_EQ(messagesOf("terminal T (1,0);"),
            Messages{"1:1: error: there is no axiom; expected a line as: axiom Box Start;"});
  const Messages shape = messagesOf("axiom Cube A;\nterminal T (1,0); A = T;");
  ASSERT_EQ(shape.size(), 1u);
  EXPECT_EQ(shape[0].substr(0, 43), "1:7: error: there is no shape 'Cube'; expec");
}

TEST(Language, WarnsOfWhatHasNoEffect) {
  EXPECT_EQ(
      ofRules("A = Extrude(1) T;\nB = T;"),
      (Messages{"3:5: warning: Extrude has no effect here: only Box arrives", "4:1: warning: rule 'B' is never used"}));
}

// The input-output relation of each operator, for each type that axioms bring to it.
TEST(Language, WarnsOfTypesThatEnd) {
  const auto of = [](const std::string& axioms, const std::string& rules) {
    return messagesOf(axioms + " terminal T (1,0);\n" + rules);
  };
  const std::string faces = "A = CompSplit() { T | T | T };";
  EXPECT_EQ(of("axiom Box A; axiom Sphere A;", faces),
            Messages{"2:5: warning: CompSplit passes on nothing of Sphere, which can arrive: such shapes end here"});
  EXPECT_EQ(of("axiom Sphere A;", faces),
            Messages{"2:5: warning: CompSplit passes on nothing of Sphere, which can arrive: such shapes end here"});
  EXPECT_EQ(
      of("axiom Box A; axiom Quad A; axiom Sphere B;", "A = B; B = CompSplit() { Discard() | Discard() | T };"),
      Messages{"2:12: warning: CompSplit passes on nothing of Quad, Sphere, which can arrive: such shapes end here"});
  EXPECT_EQ(of("axiom Box A; axiom Quad A;", faces), Messages{});
  EXPECT_EQ(of("axiom Box A; axiom Quad A;", "A = CompSplit() Discard();"), Messages{});
  EXPECT_EQ(of("axiom Quad A;", faces), Messages{"2:5: warning: CompSplit has no effect here: only Quad arrives"});
  // Nobody has said that a derivation should start at B, though it may.
  EXPECT_EQ(messagesOf("axiom Sphere A; terminal T (0,0);"
                       "A = SetAsDynamicConvexRightPrism((0,0),(.5,0),(0,.5)) B; B = CompSplit() Extrude(1) T;"),
            Messages{});
}

TEST(Language, TellsWhereInstancesHaveNoCorners) {
  const std::string rule = "A = Replicate() { T | SetAsDynamicConvexPolygon((0,0),(.5,0),(0,.5)) T };";
  EXPECT_EQ(messagesOf("axiom Box A; terminal T (1,0);\n" + rule),
            Messages{"2:19: note: instances of 'T' do not say the corners of DynamicConvexPolygon: its mesh must have "
                     "them, or a spawner for vertices write them"});
  EXPECT_EQ(messagesOf("axiom Box A; terminal T (0,0);\n" + rule), Messages{}); // vertices are what it is for
}

TEST(Language, VariablesCanBeSet) {
  const std::string text = "var h = 2; axiom Box A; terminal T (1,0); A = Translate(h,Exp(h*2),0) T;";
  const GpgpVariable set{"h", 5}, unknown{"k", 5};
  EXPECT_EQ(bake(text), bake(replaced(text, "h = 2", "h = 2")));
  EXPECT_EQ(bake(text, {set}), bake(replaced(text, "h = 2", "h = 5")));
  EXPECT_EQ(messagesOf(text, {unknown}), Messages{"error: there is no var 'k' that could be set"});
}

TEST(Language, DeepNestingIsAnErrorNotACrash) {
  std::string rules = "A = ", chain = "A = ", sum = "A = Translate(1";
  for (int i = 0; i < 20000; ++i) rules += "Replicate() { ", chain += "Translate(1,0,0) ", sum += "+(1";
  EXPECT_EQ(ofRules(rules).size(), 1u);
  EXPECT_EQ(ofRules(chain + "T;").size(), 1u);
  EXPECT_EQ(ofRules(sum).size(), 1u);
  std::string flat = "A = Translate(ShapeSize(X)";
  for (int i = 0; i < 60; ++i) flat += " + 1";
  EXPECT_EQ(ofRules(flat + ",0,0) T;"), Messages{}); // long, but never more than two values at once
}

TEST(Language, ConstantsAreFolded) {
  const std::string text = std::string(kHead) + "A = Translate(Exp(Exp(1+2)*3), Exp(7/2), Exp(1 < 2)) T;";
  const auto words = bake(text);
  EXPECT_EQ(words, bake(std::string(kHead) + "A = Translate(9, 3.5, 1) T;"));
}

TEST(Language, AllGrammarsCompileWithoutMessages) {
  const auto problemsOf = [](const std::string& text) {
    Messages all = messagesOf(text);
    std::erase_if(all, [](const std::string& m) { return m.find(": note: ") != std::string::npos; });
    return all;
  };
  for (const std::string& name : ownGrammarNames()) EXPECT_EQ(problemsOf(ownGrammar(name)), Messages{}) << name;
  for (const char* name : {"menger_sponge_3.pga", "3d_tree_4_3.pga", "3d_tree_8_3.pga", "balcony.pga", "commercial.pga",
                           "mc_skyscraper.pga"})
    if (const auto text = sharedGrammar(name)) {
      EXPECT_EQ(problemsOf(*text), Messages{}) << name;
    }
}

TEST(Language, CutGrammarsNeverCrash) {
  for (const std::string& name : ownGrammarNames()) {
    const std::string text = ownGrammar(name);
    for (size_t cut = 0; cut < text.size(); cut += 7) messagesOf(text.substr(0, cut));
  }
  EXPECT_FALSE(messagesOf(ownGrammar("building.pga").substr(0, 900)).empty());
}

TEST(Language, RandomTextNeverCrashes) {
  const char* words[] = {"axiom ", "Box ", "A ", "= ", "; ", "SubDiv", "( ",        ") ",   "{ ",     "} ",
                         "| ",     ": ",   "1 ", "-",  "X ", ", ",     "terminal ", "T ",   "Exp",    "Rand",
                         "\"",     "/*",   "//", "\n", "%",  "else",   "==",        "\xff", "1e9999", "Replicate() "};
  uint32_t state = 1;
  size_t messages = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string text;
    for (int n = 0; n < 60; ++n) {
      state = state * 1664525u + 1013904223u;
      text += words[(state >> 8) % std::size(words)];
    }
    messages += messagesOf(text).size();
  }
  EXPECT_GT(messages, 3000u);
}

// ---------------------------------------------------------------- the C function

TEST(CompileGrammar, ReportsAndFreesNothingOnError) {
  std::vector<std::string> messages;
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  const std::string text = "axiom Box A;\nA = B;\n";
  source.name = "town.pga";
  source.text = text.data();
  source.size = text.size();
  source.messageUserData = &messages;
  source.messageFn = [](void* user, const GpgpCompileMessage* m) {
    static_cast<std::vector<std::string>*>(user)->push_back(std::string(m->file) + ":" + std::to_string(m->line) + ":" +
                                                            std::to_string(m->column) + ": " + m->text);
  };
  GpgpBlob blob{};
  EXPECT_EQ(gpgpCompileGrammar(&source, &blob), GPGP_ERROR_INVALID_DATA);
  EXPECT_EQ(blob.data, nullptr);
  EXPECT_EQ(messages, Messages{"town.pga:2:5: there is no rule or terminal 'B'"});
  source.sType = 0;
  EXPECT_EQ(gpgpCompileGrammar(&source, &blob), GPGP_ERROR_INVALID_STRUCT);
  EXPECT_EQ(gpgpCompileGrammar(nullptr, &blob), GPGP_ERROR_INVALID_ARGUMENT);
}

TEST(CompileGrammar, ReadsThePrintedForm) {
  const auto compiled = [](const std::string& text) {
    const std::vector<uint32_t> words = linked({{"a.pga", text}});
    return words;
  };
  for (const std::string& name : ownGrammarNames()) {
    const auto graphOf = [](const std::vector<uint32_t>& words) {
      return spawn::load(std::as_bytes(std::span(words)), std::pmr::new_delete_resource());
    };
    const auto words = compiled(ownGrammar(name));
    const std::string printed = "// of a file -> ;\n" + spawn::printGraph(*graphOf(words));
    ASSERT_TRUE(spawn::isPrinted(printed)) << printed;
    EXPECT_FALSE(spawn::isPrinted(ownGrammar(name)));
    const auto again = bake(ownGrammar(name));
    const std::string alone = spawn::printGraph(*graphOf(again));
    EXPECT_EQ(spawn::printGraph(*graphOf(compiled(alone))), spawn::printGraph(*graphOf(words))) << name;
  }
  for (const char* text : {"axiom Box A\nA -> T;", "axiom -> T;", "axiom Box A; A -> T;", "", "->", "axiom Box",
                           "axiom Box -> A;", "axiom Box -> 5;", "axiom Box(5) -> A;", "axiom Box -> Discard;"})
    EXPECT_FALSE(spawn::isPrinted(text)) << text;
  for (const char* text : {"axiom Box -> Discard", "axiom 5: Box(12) -> 0", "axiom 2e5: Box -> 10\n"})
    EXPECT_TRUE(spawn::isPrinted(text)) << text;
  EXPECT_EQ(linkMessages({{"a.pga", "axiom Box -> A; terminal T (1,0); A = T;"}}),
            Messages{"a.pga:1:11: error: expected the name of the rule that the axiom starts with, found '->'"});
  EXPECT_EQ(linkMessages({{"a.txt", "axiom Box -> 0\n0 Translate(1,0) { 1 -> Discard }\n1 Q"}}),
            (Messages{"a.txt:2:16: error: expected ',', found ')'",
                      "a.txt:3:3: error: there is no operator or terminal 'Q'"}));
}

TEST(CompileGrammar, IsAPureFunction) {
  const std::string text = ownGrammar("building.pga");
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  source.text = text.data();
  source.size = text.size();
  GpgpBlob a{}, b{};
  ASSERT_EQ(gpgpCompileGrammar(&source, &a), GPGP_SUCCESS);
  ASSERT_EQ(gpgpCompileGrammar(&source, &b), GPGP_SUCCESS);
  ASSERT_EQ(a.size, b.size);
  EXPECT_EQ(std::memcmp(a.data, b.data, a.size), 0);
  gpgpFreeBlob(&a);
  gpgpFreeBlob(&b);
  EXPECT_EQ(a.data, nullptr);
}

} // namespace
