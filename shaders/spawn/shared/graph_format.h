// The baked operator graph as words, the same in the file, in device memory and for the CPU evaluator.
//
// A baked grammar is an array of 32-bit words, little-endian: a header, then sections back to back in the header's
// order. References between sections are word offsets from the start, so that the interpreter follows them without
// looking anything up; 0 as an edge's target means that the shape is discarded. src/spawn/graph/blob.cpp writes and
// checks all of it; nothing here is checked again.
#ifndef GPGP_SHADERS_SPAWN_GRAPH_FORMAT_H
#define GPGP_SHADERS_SPAWN_GRAPH_FORMAT_H
#include "core/shared.h"
#include "spawn/shared/operator_table.h"

// How shared functions read the graph: a pointer in C++, the bound buffer graphWords[] in GLSL.
#ifdef __cplusplus
#define GPGP_GRAPH const ::gpgp::shader::uint *graphWords,
#define GPGP_G graphWords,
#else
#define GPGP_GRAPH
#define GPGP_G
#endif

GPGP_SHADER_BEGIN

GPGP_CONST uint kGraphMagic = 0x67707067u; // "gppg"
GPGP_CONST uint kGraphVersion = 10u;

// header words
GPGP_CONST uint kHeaderMagic = 0u;
GPGP_CONST uint kHeaderVersion = 1u;
GPGP_CONST uint kHeaderWords = 2u;    // of everything
GPGP_CONST uint kHeaderChecksum = 3u; // of all words from kHeaderChecked on
GPGP_CONST uint kHeaderChecked = 4u;
GPGP_CONST uint kHeaderSections = 4u; // count and offset of each section
GPGP_CONST uint kHeaderBuckets = 30u; // terminal lines
GPGP_CONST uint kHeaderPhases = 31u;  // of derivation, where there are Collider or IfCollides; else 0
GPGP_CONST uint kHeaderPieces = 32u;  // polygons that SubDiv makes, the last ones of all
GPGP_CONST uint kHeaderSize = 36u;    // a multiple of four

// sections, in order
GPGP_CONST uint kSectionNodes = 0u;
GPGP_CONST uint kSectionEdges = 1u;
GPGP_CONST uint kSectionParameters = 2u;
GPGP_CONST uint kSectionCode = 3u;
GPGP_CONST uint kSectionPolygons = 4u;
GPGP_CONST uint kSectionVertices = 5u;
GPGP_CONST uint kSectionTerminals = 6u;
GPGP_CONST uint kSectionRules = 7u;
GPGP_CONST uint kSectionNames = 8u; // bytes in words, each name ends in 0
GPGP_CONST uint kSectionDivisions = 9u;
GPGP_CONST uint kSectionQuads = 10u;
GPGP_CONST uint kSectionAxioms = 11u;
GPGP_CONST uint kSectionFields = 12u; // of the world: names, by their numbers
GPGP_CONST uint kSectionCount = 13u;

// node: eight words. What a terminal says lies in the first four, which are read at once.
GPGP_CONST uint kNodeOperator = 0u; // and kNodeFilter, kNodeDraws, kNodeSees, and its priority << kNodePriority
GPGP_CONST uint kNodeArgument = 1u;
GPGP_CONST uint kNodeArgument2 = 2u;
GPGP_CONST uint kNodeParameters = 3u; // offset of the first; of a terminal: kNodeRule
GPGP_CONST uint kNodeRule = 3u;       // in whose body the terminal stands, or kNoRule: an axiom line names it
GPGP_CONST uint kNodeParameterCount = 4u;
GPGP_CONST uint kNodeEdges = 5u; // offset of the first
GPGP_CONST uint kNodeEdgeCount = 6u;
GPGP_CONST uint kNodeShapes = 7u; // bit set of the GpgpShape values that can arrive
GPGP_CONST uint kNodeSize = 8u;
GPGP_CONST uint kOperatorMask = 0xffu;
GPGP_CONST uint kNoRule = 0xffffffffu;
/// The node could multiply shapes, but at most one of its successors is not discarded: it passes on one shape or none.
GPGP_CONST uint kNodeFilter = 0x100u;
/// Of an operator that passes on one shape: a parameter draws a random number, so the shape's path key changes here.
GPGP_CONST uint kNodeDraws = 0x200u;
/// A parameter asks what the camera sees of the shape.
GPGP_CONST uint kNodeSees = 0x400u;
GPGP_CONST uint kNodePriority = 16u;
GPGP_CONST uint kMaxPriority = 0xffffu;

// edge: target, multiplicity, count
GPGP_CONST uint kEdgeTarget = 0u; // offset of a node, 0: discard; and kEdgeRecursive
GPGP_CONST uint kEdgeMultiplicity = 1u;
GPGP_CONST uint kEdgeShapes = 2u;
GPGP_CONST uint kEdgeSize = 3u;
/// The edge closes a cycle: every derivation without end passes such edges for ever, so they are what depth counts.
GPGP_CONST uint kEdgeRecursive = 0x80000000u;

GPGP_CONST uint kMultiplicityOne = 0u;      // always one shape
GPGP_CONST uint kMultiplicityFixed = 1u;    // a number known from the shape's type
GPGP_CONST uint kMultiplicityOptional = 2u; // none or one
GPGP_CONST uint kMultiplicityAny = 3u;      // any number

// parameter: kind, value
GPGP_CONST uint kParameterConstant = 0u;  // value: float bits
GPGP_CONST uint kParameterAttribute = 1u; // value: an attribute's code
GPGP_CONST uint kParameterProgram = 2u;   // value: offset of its first code word
GPGP_CONST uint kParameterView = 3u;      // the same, of a program that has codes from kCodeView on
GPGP_CONST uint kParameterSize = 2u;
GPGP_FN bool hasProgram(uint parameterKind) {
  return parameterKind == kParameterProgram || parameterKind == kParameterView;
}

// division: what a SubDiv with constant parts makes of them. Fixed length, parts with a fixed length and parts with a
// weight as bit sets (without those that are discarded), where its cuts begin, seen from its own start, or 0; then for
// each part four values. cuts: how many, then for each polygon that it cuts its number and one number a part.
GPGP_CONST uint kDivisionFixedParts = 1u;
GPGP_CONST uint kDivisionWeightedParts = 2u;
GPGP_CONST uint kDivisionCuts = 3u;
GPGP_CONST uint kDivisionParts = 4u;
GPGP_CONST uint kNoPiece = 0xffffffffu; // the polygon does not reach that far
GPGP_CONST uint kPartFixed = 0u;        // its length, or
GPGP_CONST uint kPartShare = 1u;        // its share of what fixed lengths leave
GPGP_CONST uint kPartFixedBefore = 2u;  // sums over the parts before it
GPGP_CONST uint kPartShareBefore = 3u;
GPGP_CONST uint kPartSize = 4u;

// polygon: first vertex (offset), vertex count, first quad (offset), quad count or 0. Polygons come in pairs, 2 k + 1
// is 2 k seen from behind: (x, -y) in reverse order. The first six pairs are the regular ones with 3 to 8 corners.
// Without quads it is convex: a fan. A quad is four corners as 16 bits each, and means the triangles 0 1 2 and 0 2 3.
GPGP_CONST uint kPolygonSize = 4u;
GPGP_CONST uint kQuadSize = 2u;
GPGP_CONST uint kMaxCorners = 4096u; // of a polygon
GPGP_CONST uint kRegularPolygons = 12u;
GPGP_CONST uint kQuadPolygon = 2u;

// terminal: name (byte offset in names), kind, index, bucket
GPGP_CONST uint kTerminalSize = 4u;
// rule: name (byte offset in names), node offset or 0, the axiom whose shape it starts with (offset)
GPGP_CONST uint kRuleSize = 3u;
// axiom: name (byte offset in names), node offset or 0, GpgpShape and its polygon << 8. The first is the default.
GPGP_CONST uint kAxiomSize = 3u;

// operators, and the last one of each relation
#define GPGP_OPERATOR(name, number, relation, arguments, successors, multiplicity, shapes, kind, call)                 \
  GPGP_CONST uint kOp##name = number;
#define GPGP_LAST(name, number, relation, arguments, successors, multiplicity, shapes, kind, call)                     \
  GPGP_CONST uint kOp##name = number;                                                                                  \
  GPGP_CONST uint kLast##relation = number;
GPGP_OPERATOR_TABLE(GPGP_OPERATOR, GPGP_LAST)
#undef GPGP_OPERATOR
#undef GPGP_LAST
GPGP_CONST uint kFirstMultiplying = kLastContext + 1u;
GPGP_CONST uint kOpCount = kLastMultiplying + 1u;

/// A tag is a number below this, or a name: this and its byte offset in names.
GPGP_CONST uint kTagName = 0x80000000u;

GPGP_CONST uint kRepeatAdjustToFill = 0u;
GPGP_CONST uint kRepeatAnchorToStart = 1u;
GPGP_CONST uint kRepeatAnchorToEnd = 2u;

// expression code: a stack machine without jumps
GPGP_CONST uint kCodeEnd = 0u;
GPGP_CONST uint kCodeNumber = 1u; // float bits follow
#define GPGP_BINARY(name, number, spelling, precedence, kind, code) GPGP_CONST uint kCode##name = number;
GPGP_BINARY_TABLE(GPGP_BINARY, GPGP_BINARY)
#undef GPGP_BINARY
#define GPGP_ATTRIBUTE(name, number, spelling, axes, value, member) GPGP_CONST uint kCode##name = number;
GPGP_ATTRIBUTE_TABLE(GPGP_ATTRIBUTE)
#undef GPGP_ATTRIBUTE
#define GPGP_SEEN(name, number, spelling, value, member) GPGP_CONST uint kCode##name = number;
GPGP_VIEW_TABLE(GPGP_SEEN)
#undef GPGP_SEEN
GPGP_CONST uint kCodeField = 24u; // the first field
GPGP_CONST uint kMaxFields = 8u;
GPGP_CONST uint kCodeAttributes = 32u; // the first attribute
GPGP_CONST uint kCodeView = 52u;       // the first one of what the camera sees
GPGP_CONST uint kCodeCount = 55u;

/// GPGP_AXIOM_DEFAULT_START. Other starts are counted: first the rules, then the axioms.
GPGP_CONST uint kDefaultRule = 0xffffffffu;

/// The numbers that an operator draws: of parameter p those from p << this on, in the order of its code.
GPGP_CONST uint kDrawsOfParameter = 16u;

// limits that the interpreter relies on
GPGP_CONST uint kMaxStack = 8u;       // of expressions
GPGP_CONST uint kMaxSuccessors = 32u; // of one operator
GPGP_CONST uint kMaxBuckets = 1024u;
GPGP_CONST uint kMaxPhases = 8u;
GPGP_CONST uint kMaxChain = 64u;       // operators that one shape passes before others get their turn
GPGP_CONST uint kMaxRepeat = 1048576u; // copies that one Repeat makes

// shape types, as GpgpShape
GPGP_CONST uint kShapeTriangle = 0u;
GPGP_CONST uint kShapeQuad = 1u;
GPGP_CONST uint kShapeOctagon = 5u;
GPGP_CONST uint kShapePrism3 = 6u;
GPGP_CONST uint kShapeBox = 7u;
GPGP_CONST uint kShapePrism8 = 11u;
GPGP_CONST uint kShapeDynamicConvexPolygon = 12u;
GPGP_CONST uint kShapeDynamicPolygon = 13u;
GPGP_CONST uint kShapeDynamicConvexRightPrism = 14u;
GPGP_CONST uint kShapeDynamicRightPrism = 15u;
GPGP_CONST uint kShapeSphere = 16u;
GPGP_CONST uint kShapeRoof = 17u;
GPGP_CONST uint kShapeTrapezoid = 18u;
GPGP_CONST uint kShapeCount = 19u;

GPGP_CONST uint kDynamicShapes = 0xf000u; // bits
GPGP_CONST uint kPolygonShapes = 0x303fu; // bits: triangle to octagon, the two dynamic ones
GPGP_CONST uint kFlatShapes = kPolygonShapes | (1u << kShapeTrapezoid);
GPGP_CONST uint kRectangleShapes = (1u << kShapeQuad) | (1u << kShapeBox);
/// Bits: shapes whose top CompSplit finds.
GPGP_CONST uint kFacedShapes = ~((1u << kShapeSphere) | (1u << kShapeRoof));
GPGP_FN bool isFlat(uint shape) { return ((kFlatShapes >> shape) & 1u) != 0u; }
GPGP_FN bool isPolygon(uint shape) { return ((kPolygonShapes >> shape) & 1u) != 0u; }
GPGP_FN bool isPrism(uint shape) { return !isPolygon(shape) && shape < kShapeSphere; }
/// What a polygon becomes when it is extruded.
GPGP_FN uint prismOf(uint polygon) { return polygon <= kShapeOctagon ? polygon + 6u : polygon + 2u; }
/// What the ends of a prism are.
GPGP_FN uint polygonOf(uint prism) { return prism <= kShapePrism8 ? prism - 6u : prism - 2u; }

/// Whether SubDiv along an axis makes something else of a shape's polygon. A sphere's pieces are spheres; of roofs and
/// trapezoids there are no pieces.
GPGP_FN bool isCut(uint shape, uint axis) {
  if (shape > kShapeSphere) return true;
  return shape != kShapeBox && shape != kShapeQuad && shape != kShapeSphere && axis != (isPolygon(shape) ? 2u : 1u);
}
/// What the piece is.
GPGP_FN uint pieceShape(uint shape) {
  if (shape >= kShapeDynamicConvexPolygon) return shape;
  return isPolygon(shape) ? kShapeDynamicConvexPolygon : kShapeDynamicConvexRightPrism;
}

GPGP_SHADER_END
#endif
