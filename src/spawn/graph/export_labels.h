// The words that stand for the parts of an operator graph, in its printed form and in pictures. Numbers are written
// with as many digits as tell them apart.
#pragma once
#include "spawn/graph/graph.h"

#include <string>

namespace gpgp::spawn {

std::string numberText(float value);
/// As in -1, ShapeSize(X), (ShapeSize(X) * 0.5), Rand(1,2). A program that consists of one value is in Exp(...).
std::string parameterText(const Graph& graph, const Parameter& parameter);
/// An operator with what stands before its successors, as in Translate(0,1,0) or SubDiv(X); a terminal's name.
std::string nodeText(const Graph& graph, const Node& node);
/// A Collider's tag: a number or a name.
std::string tagText(const Graph& graph, uint32_t tag);
/// The value that belongs to an edge: the extent of a SubDiv's part, a probability. Empty where there is none.
std::string edgeValueText(const Graph& graph, const Node& node, uint32_t slot);
/// 1, n, / or *.
const char* multiplicityText(const Graph& graph, const Node& node, uint32_t slot);

/// The polygon that an axiom of this shape has unless another is named.
uint32_t usualPolygon(uint32_t shape);
/// The name that the only axiom has unless another is given: of the first rule that leads where it leads; else none.
std::string usualName(const Graph& graph, const Axiom& axiom);
/// An axiom's shape; behind its name, as in house: Box, where there are several axioms or it is not the usual one.
std::string axiomText(const Graph& graph, const Axiom& axiom);

const char* axisText(uint32_t axis);
const char* repeatModeText(uint32_t mode);

} // namespace gpgp::spawn
