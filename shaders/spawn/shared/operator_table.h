// What operators and the codes of expressions are, a row each. Whoever needs a column says with two macros what a row
// becomes: graph_format.h makes constants of it, chain.h the cases of the interpreter, src/spawn/graph/operator_info.h
// what the host looks up. LAST is the last row of its relation, as shaders tell relations by number; else it is as ROW.
#ifndef GPGP_SHADERS_SPAWN_OPERATOR_TABLE_H
#define GPGP_SHADERS_SPAWN_OPERATOR_TABLE_H

// ROW(name, number, relation, arguments, successors, multiplicity, shapes, kind, call)
//
//   name          of the operator in the language, in the printed form and in messages
//   number        kOp + name, in baked files. Rows are in the order of their numbers, and relations are together
//   relation      what becomes of a shape. Ending: a terminal. Passing: it goes on along the only edge. Choosing: it
//                 takes one of the edges. Context: either of both, by more than the shape and the graph.
//                 Multiplying: any number of shapes
//   arguments     a letter each, in the order in which they are written:
//                   a  axis: two bits of Node::argument each, the first in the lowest
//                   t  tag: Node::argument                 m  mode of Repeat: Node::argument2
//                   s  shape: Node::argument               p  polygon: Node::argument2
//                   v  value: a parameter                  :  at the end: each successor has a value, a parameter, too
//   successors    edges: so many, or kMany: 1 to kMaxSuccessors
//   multiplicity  of its edges, a kMultiplicity constant
//   shapes        bits of the types on which it has an effect
//   kind          GpgpOperatorKind, or kNotWritten: the language writes it in another way
//   call          of Passing: what it does to the shape s. GPGP_VALUES are its first three parameters as a vec3,
//                 GPGP_VALUE is the first one, GPGP_ARGUMENT and GPGP_ARGUMENT2 are the node's
#define GPGP_PASSING_OPERATORS(ROW, LAST)                                                                              \
  ROW(Translate, 1u, Passing, "vvv", 1, One, kAnyShape, GPGP_OPERATOR_TRANSLATE, translate(s, GPGP_VALUES))            \
  ROW(Rotate, 2u, Passing, "vvv", 1, One, kAnyShape, GPGP_OPERATOR_ROTATE, rotate(s, rotationOf(GPGP_VALUES)))         \
  ROW(Scale, 3u, Passing, "vvv", 1, One, kAnyShape, GPGP_OPERATOR_SCALE, resize(s, GPGP_VALUES))                       \
  ROW(Extrude, 4u, Passing, "v", 1, One, kPolygonShapes, GPGP_OPERATOR_EXTRUDE, extrude(s, GPGP_VALUE))                \
  ROW(SwapSize, 5u, Passing, "aaa", 1, One, kAnyShape, GPGP_OPERATOR_SWAP_SIZE, swapSizes(s, GPGP_ARGUMENT))           \
  ROW(ResizeCorner, 6u, Passing, "vvv", 1, One, kAnyShape, GPGP_OPERATOR_RESIZE_CORNER,                                \
      resizeAtCorner(s, GPGP_VALUES))                                                                                  \
  ROW(GrowAlong, 7u, Passing, "av", 1, One, kAnyShape, GPGP_OPERATOR_GROW_ALONG, grow(s, GPGP_ARGUMENT, GPGP_VALUE))   \
  ROW(TurnCorner, 8u, Passing, "vvv", 1, One, kAnyShape, GPGP_OPERATOR_TURN_CORNER, turnAtCorner(s, GPGP_VALUES))      \
  ROW(ToFace, 9u, Passing, "v", 1, One, kAnyShape, GPGP_OPERATOR_TO_FACE, toSideOf(s, GPGP_VALUE))                     \
  ROW(SetAttribute, 10u, Passing, "v", 1, One, kAnyShape, GPGP_OPERATOR_SET_ATTRIBUTE, setCustom(s, GPGP_VALUE))       \
  ROW(RaiseRoof, 11u, Passing, "vvv", 1, One, kRectangleShapes, GPGP_OPERATOR_RAISE_ROOF, raiseRoof(s, GPGP_VALUES))   \
  ROW(ToRoofFace, 12u, Passing, "vvv", 1, One, 1u << kShapeRoof, GPGP_OPERATOR_TO_ROOF_FACE,                           \
      toRoofFace(s, GPGP_VALUES))                                                                                      \
  LAST(SetGeometry, 13u, Passing, "sp", 1, One, kAnyShape, kNotWritten, setGeometry(s, GPGP_ARGUMENT, GPGP_ARGUMENT2))
#define GPGP_OPERATOR_TABLE(ROW, LAST)                                                                                 \
  LAST(Terminal, 0u, Ending, "", 0, One, kAnyShape, kNotWritten, )                                                     \
  GPGP_PASSING_OPERATORS(ROW, LAST)                                                                                    \
  ROW(If, 14u, Choosing, "v", 2, Optional, kAnyShape, GPGP_OPERATOR_IF, )                                              \
  ROW(IfSizeLess, 15u, Choosing, "av", 2, Optional, kAnyShape, GPGP_OPERATOR_IF_SIZE_LESS, )                           \
  LAST(RandomRule, 16u, Choosing, "v:", kMany, Optional, kAnyShape, GPGP_OPERATOR_RANDOM_RULE, )                       \
  ROW(Collider, 17u, Context, "t", 1, One, kAnyShape, GPGP_OPERATOR_COLLIDER, )                                        \
  LAST(IfCollides, 18u, Context, "t", 2, Optional, kAnyShape, GPGP_OPERATOR_IF_COLLIDES, )                             \
  ROW(CompSplit, 19u, Multiplying, "", 3, Fixed, ~kPolygonShapes, GPGP_OPERATOR_COMP_SPLIT, )                          \
  ROW(SubDiv, 20u, Multiplying, "a:", kMany, Optional, kAnyShape, GPGP_OPERATOR_SUB_DIV, )                             \
  ROW(Repeat, 21u, Multiplying, "avm", 1, Any, kAnyShape, GPGP_OPERATOR_REPEAT, )                                      \
  LAST(Replicate, 22u, Multiplying, "", kMany, One, kAnyShape, GPGP_OPERATOR_REPLICATE, )

// Codes that take two values and leave one. ROW(name, number, spelling, precedence, kind, code)
//
//   name, number  kCode + name
//   spelling      between its values, or the name of a function
//   precedence    from 1 on, those that bind more are higher; 0: a function
//   kind          GpgpExpressionKind
//   code          of the values a and b; drawn is a random number from 0 to 1, which only LAST has
#define GPGP_BINARY_TABLE(ROW, LAST)                                                                                   \
  ROW(Add, 2u, "+", 5, GPGP_EXPRESSION_ADD, add(a, b))                                                                 \
  ROW(Subtract, 3u, "-", 5, GPGP_EXPRESSION_SUBTRACT, subtract(a, b))                                                  \
  ROW(Multiply, 4u, "*", 6, GPGP_EXPRESSION_MULTIPLY, multiply(a, b))                                                  \
  ROW(Divide, 5u, "/", 6, GPGP_EXPRESSION_DIVIDE, divide(a, b))                                                        \
  ROW(Equal, 6u, "==", 3, GPGP_EXPRESSION_EQUAL, fromBool(nearlyEqual(a, b)))                                          \
  ROW(NotEqual, 7u, "!=", 3, GPGP_EXPRESSION_NOT_EQUAL, fromBool(!nearlyEqual(a, b)))                                  \
  ROW(Less, 8u, "<", 4, GPGP_EXPRESSION_LESS, fromBool(a < b))                                                         \
  ROW(Greater, 9u, ">", 4, GPGP_EXPRESSION_GREATER, fromBool(a > b))                                                   \
  ROW(LessEqual, 10u, "<=", 4, GPGP_EXPRESSION_LESS_EQUAL, fromBool(a <= b))                                           \
  ROW(GreaterEqual, 11u, ">=", 4, GPGP_EXPRESSION_GREATER_EQUAL, fromBool(a >= b))                                     \
  ROW(And, 12u, "&&", 2, GPGP_EXPRESSION_AND, fromBool(a != 0.0f && b != 0.0f))                                        \
  ROW(Or, 13u, "||", 1, GPGP_EXPRESSION_OR, fromBool(a != 0.0f || b != 0.0f))                                          \
  ROW(Least, 14u, "Min", 0, GPGP_EXPRESSION_MIN, min(a, b))                                                            \
  ROW(Most, 15u, "Max", 0, GPGP_EXPRESSION_MAX, max(a, b))                                                             \
  ROW(Floor, 16u, "Floor", 0, GPGP_EXPRESSION_FLOOR, settle(floor(divide(a, b))))                                      \
  ROW(Noise, 17u, "Noise", 0, GPGP_EXPRESSION_NOISE, noise(a, b))                                                      \
  LAST(Random, 18u, "Rand", 0, GPGP_EXPRESSION_RANDOM, add(a, multiply(subtract(b, a), drawn)))

// A code reads a field of the world, kCodeField + its number: it takes x and z, in metres along the shape's axes from
// its centre, and leaves the field's value there (field.h).
#define GPGP_FIELD_SPELLING "Field"

// Codes that leave an attribute of the shape. ROW(name, number, spelling, axes, value, member)
//
//   name, number  kCode + name; with one axis + axis, with two + 3 * axis + component
//   spelling      the name of a function of so many axes
//   value         the first one's GpgpGrammarValueId; others are counted likewise
//   member        of Shape, where it begins
#define GPGP_ATTRIBUTE_TABLE(ROW)                                                                                      \
  ROW(Position, 32u, "ShapePos", 1, GPGP_VALUE_SHAPE_POS_X, position)                                                  \
  ROW(ShapeSize, 35u, "ShapeSize", 1, GPGP_VALUE_SHAPE_SIZE_X, size)                                                   \
  ROW(Rotation, 41u, "ShapeRotation", 2, GPGP_VALUE_SHAPE_ROTATION_XX, axisX)                                          \
  ROW(Normal, 38u, "ShapeNormal", 1, GPGP_VALUE_SHAPE_NORMAL_X, axisZ)                                                 \
  ROW(Seed, 50u, "ShapeSeed", 0, GPGP_VALUE_SHAPE_SEED, seed)                                                          \
  ROW(Custom, 51u, "ShapeCustomAttribute", 0, GPGP_VALUE_SHAPE_CUSTOM_ATTRIBUTE, custom)

// Codes that leave what the recording's camera sees of the shape. ROW(name, number, spelling, value, member)
//
//   number        kCode + name, behind the attributes
//   spelling      the name of a function of nothing
//   value         GpgpGrammarValueId
//   member        of Seen (view.h)
#define GPGP_VIEW_TABLE(ROW)                                                                                           \
  ROW(CameraDistance, 52u, "CameraDistance", GPGP_VALUE_CAMERA_DISTANCE, distance)                                     \
  ROW(ScreenSize, 53u, "ScreenSize", GPGP_VALUE_SCREEN_SIZE, size)                                                     \
  ROW(OutOfView, 54u, "OutOfView", GPGP_VALUE_OUT_OF_VIEW, outside)

#endif
