/* gpgp spawn: grammars that are made in code instead of text. They become the same operator graphs as text. All
 * functions are in libgpgp_compiler.
 *
 *   gpgpCreateGrammarBuilder -> gpgpAdd... -> gpgpCompileGrammar (GpgpGrammarSource::builder) -> blob
 *
 * Everything is checked when the builder is compiled. Each error is one message, which names the rule and operator and
 * says what was expected. The functions that add something therefore return no errors. A NULL name, an unknown value or
 * a lack of memory is reported by the compilation, too. Rules and terminals are referred to by name, and a name may be
 * used before it is defined. The operators are those of the language: see docs/guide/grammars.md.
 *
 *   const GpgpGrammarValue axis = GPGP_GRAMMAR_VALUE(GPGP_VALUE_X);
 *   const GpgpGrammarSuccessor halves[] = {{GPGP_GRAMMAR_NUMBER(-1), "Wall", 0}, {GPGP_GRAMMAR_NUMBER(-1), "Door", 0}};
 *   gpgpAddRule(builder, "Front", NULL, gpgpAddOperator(builder, GPGP_OPERATOR_SUB_DIV, &axis, 1, halves, 2));
 *
 * adds the rule that is written in text as: Front = SubDiv(X) { -1: Wall | -1: Door };
 */
#ifndef GPGP_SPAWN_BUILDER_H
#define GPGP_SPAWN_BUILDER_H
#include <gpgp/spawn.h>
#ifdef __cplusplus
extern "C" {
#endif

/** Creates an empty builder. In libgpgp_compiler. Errors: INVALID_ARGUMENT, OUT_OF_HOST_MEMORY. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpCreateGrammarBuilder(GpgpGrammarBuilder* builder);

/** Destroys a builder. Grammars that were compiled from it are not affected. NULL is ignored. In libgpgp_compiler.
 *  @threads handle */
GPGP_API void GPGP_CALL gpgpDestroyGrammarBuilder(GpgpGrammarBuilder builder);

/* ---------------------------------------------------------------- values */

/** What a value is. gpgpAddVariable, gpgpAddTag and gpgpAddExpression return values with other ids. */
typedef uint32_t GpgpGrammarValueId;
enum {
  GPGP_VALUE_NONE = 0,
  GPGP_VALUE_NUMBER = 1, /**< The number in GpgpGrammarValue::number. */
  GPGP_VALUE_X = 2,      /**< X, Y and Z: axes, for operators that take one. */
  GPGP_VALUE_Y = 3,
  GPGP_VALUE_Z = 4,
  GPGP_VALUE_ADJUST_TO_FILL = 5, /**< This and the two that follow: modes of Repeat. */
  GPGP_VALUE_ANCHOR_TO_START = 6,
  GPGP_VALUE_ANCHOR_TO_END = 7,
  GPGP_VALUE_SHAPE_SEED = 8, /**< Seed of the shape as a number in [0, 1). All that follow are attributes too. */
  GPGP_VALUE_SHAPE_CUSTOM_ATTRIBUTE = 9,
  GPGP_VALUE_SHAPE_POS_X = 10, /**< Centre of the shape in object space, metres. */
  GPGP_VALUE_SHAPE_POS_Y = 11,
  GPGP_VALUE_SHAPE_POS_Z = 12,
  GPGP_VALUE_SHAPE_SIZE_X = 13, /**< Extents of the shape in metres. */
  GPGP_VALUE_SHAPE_SIZE_Y = 14,
  GPGP_VALUE_SHAPE_SIZE_Z = 15,
  GPGP_VALUE_SHAPE_NORMAL_X = 16, /**< Normal of the shape in object space. */
  GPGP_VALUE_SHAPE_NORMAL_Y = 17,
  GPGP_VALUE_SHAPE_NORMAL_Z = 18,
  /** ShapeRotation(X, X): component X of the shape's X axis in object space. Others: + 3 * axis + component. */
  GPGP_VALUE_SHAPE_ROTATION_XX = 19,
  /** Distance in metres from the recording's camera to the shape's centre. 0 without a camera. This value and the next
   *  two are not attributes of the shape: see GpgpSpawnCamera. */
  GPGP_VALUE_CAMERA_DISTANCE = 28,
  GPGP_VALUE_SCREEN_SIZE = 29, /**< Diameter in pixels of the sphere around the shape. 2^100 without a camera. */
  /** Distance in metres of the sphere from the frustum. 0 inside, and without a camera. */
  GPGP_VALUE_OUT_OF_VIEW = 30
};

/** A value that an operator takes: a number, or what its id stands for. */
typedef struct GpgpGrammarValue {
  GpgpGrammarValueId id; /**< An id from the list above, or one that a function of the builder returned. */
  float number;          /**< For GPGP_VALUE_NUMBER. It must be finite. */
} GpgpGrammarValue;
/* Initialisers of values: const GpgpGrammarValue width = GPGP_GRAMMAR_NUMBER(2.5); */
#define GPGP_GRAMMAR_NUMBER(value)                                                                                     \
  { GPGP_VALUE_NUMBER, (float)(value) }
#define GPGP_GRAMMAR_VALUE(id)                                                                                         \
  { (id), 0.0f }

/** Adds `var name = value;` and returns a value that stands for the variable. The value must not depend on the shape.
 *  GpgpGrammarSource::variables can override it. In libgpgp_compiler. @threads handle @lifetime call */
GPGP_API GpgpGrammarValue GPGP_CALL gpgpAddVariable(GpgpGrammarBuilder builder, const char* name,
                                                    GpgpGrammarValue value);

/** Returns a value that stands for a named tag of Collider and IfCollides. The name must not be a number, since numbers
 *  are tags themselves (GPGP_GRAMMAR_NUMBER). In libgpgp_compiler. @threads handle @lifetime call */
GPGP_API GpgpGrammarValue GPGP_CALL gpgpAddTag(GpgpGrammarBuilder builder, const char* name);

typedef uint32_t GpgpExpressionKind;
enum {
  GPGP_EXPRESSION_ADD = 0,
  GPGP_EXPRESSION_SUBTRACT = 1,
  GPGP_EXPRESSION_MULTIPLY = 2,
  GPGP_EXPRESSION_DIVIDE = 3,
  GPGP_EXPRESSION_EQUAL = 4, /**< Comparisons give 1 or 0. Equality tolerates one part in 100 000. */
  GPGP_EXPRESSION_NOT_EQUAL = 5,
  GPGP_EXPRESSION_LESS = 6,
  GPGP_EXPRESSION_GREATER = 7,
  GPGP_EXPRESSION_LESS_EQUAL = 8,
  GPGP_EXPRESSION_GREATER_EQUAL = 9,
  GPGP_EXPRESSION_AND = 10,
  GPGP_EXPRESSION_OR = 11,
  GPGP_EXPRESSION_RANDOM = 12, /**< Rand(left, right): a random number between them. */
  GPGP_EXPRESSION_CORNER = 13, /**< (left, right): a corner of a polygon, in [-0.5, 0.5]. */
  GPGP_EXPRESSION_MIN = 14,    /**< Min(left, right). */
  GPGP_EXPRESSION_MAX = 15,    /**< Max(left, right). */
  GPGP_EXPRESSION_FLOOR = 16,  /**< Floor(left, right): how many whole right fit into left, rounded down. */
  GPGP_EXPRESSION_NOISE = 17   /**< Noise(left, right): a number in [0, 1) that depends on both values alone. */
};

/** Returns a value that combines two others. It may be used any number of times. An expression holds at most 1024
 *  values. In libgpgp_compiler. @threads handle */
GPGP_API GpgpGrammarValue GPGP_CALL gpgpAddExpression(GpgpGrammarBuilder builder, GpgpExpressionKind kind,
                                                      GpgpGrammarValue left, GpgpGrammarValue right);

/* ---------------------------------------------------------------- operators */

/** The operators with their values and successors. */
typedef uint32_t GpgpOperatorKind;
enum {
  GPGP_OPERATOR_TRANSLATE = 0,                      /**< Values: x, y, z. One successor. */
  GPGP_OPERATOR_ROTATE = 1,                         /**< Values: x, y, z in degrees. One successor. */
  GPGP_OPERATOR_SCALE = 2,                          /**< Values: x, y, z. One successor. */
  GPGP_OPERATOR_EXTRUDE = 3,                        /**< Value: height. One successor. */
  GPGP_OPERATOR_SWAP_SIZE = 4,                      /**< Values: three axes. One successor. */
  GPGP_OPERATOR_COMP_SPLIT = 5,                     /**< No values. Top, bottom and sides, or one for all faces. */
  GPGP_OPERATOR_SUB_DIV = 6,                        /**< Value: axis. Up to 32 successors, each with a value. */
  GPGP_OPERATOR_REPEAT = 7,                         /**< Values: axis, extent, mode. One successor. */
  GPGP_OPERATOR_IF = 8,                             /**< Value: condition. Two successors. */
  GPGP_OPERATOR_IF_SIZE_LESS = 9,                   /**< Values: axis, length. Two successors. */
  GPGP_OPERATOR_RANDOM_RULE = 10,                   /**< Value: chance. Up to 32 successors, each with a value. */
  GPGP_OPERATOR_REPLICATE = 11,                     /**< No values. Up to 32 successors. */
  GPGP_OPERATOR_DISCARD = 12,                       /**< No values and no successors. */
  GPGP_OPERATOR_GENERATE = 13,                      /**< No values and no successors. */
  GPGP_OPERATOR_COLLIDER = 14,                      /**< Value: a tag or whole number. One successor. */
  GPGP_OPERATOR_IF_COLLIDES = 15,                   /**< Value: tag. Two successors. */
  GPGP_OPERATOR_SET_AS_DYNAMIC_CONVEX_POLYGON = 16, /**< Values: corners. One successor. */
  GPGP_OPERATOR_SET_AS_DYNAMIC_CONCAVE_POLYGON = 17,
  GPGP_OPERATOR_SET_AS_DYNAMIC_CONVEX_RIGHT_PRISM = 18,
  GPGP_OPERATOR_SET_AS_DYNAMIC_CONCAVE_RIGHT_PRISM = 19,
  GPGP_OPERATOR_RESIZE_CORNER = 20, /**< Values: x, y, z. One successor. */
  GPGP_OPERATOR_GROW_ALONG = 21,    /**< Values: axis, length. One successor. */
  GPGP_OPERATOR_TURN_CORNER = 22,   /**< Values: x, y, z in degrees. One successor. */
  GPGP_OPERATOR_TO_FACE = 23,       /**< Value: 0 top, 1 bottom, 2 back, 3 front, 4 left, 5 right. One successor. */
  GPGP_OPERATOR_SET_ATTRIBUTE = 24, /**< Value: the custom attribute. One successor. */
  /** Values: form, measure, value. One successor. Forms: 0 a gable with its ridge along x, 1 along z, 2 a hip roof, 3 a
   *  pyramid, 4 to 7 a shed roof that is low at the side with the highest z, the highest x, the lowest z, the lowest x.
   *  Measures: 0 the height, 1 the slope as rise by run, 2 the angle in degrees. */
  GPGP_OPERATOR_RAISE_ROOF = 25,
  /** Values: face, overhang, overhang at gables. One successor. Faces: 0 to 3 the sides in the order of shed roofs, 4
   *  the bottom. */
  GPGP_OPERATOR_TO_ROOF_FACE = 26
};

/** Returns the value of a field of the world (GpgpSpawnField) at x and z metres along the shape's axes from its centre.
 *  Both 0: at the centre. A grammar reads at most GPGP_MAX_FIELDS fields. In libgpgp_compiler. @threads handle
 *  @lifetime call */
GPGP_API GpgpGrammarValue GPGP_CALL gpgpAddField(GpgpGrammarBuilder builder, const char* name, GpgpGrammarValue x,
                                                 GpgpGrammarValue z);

typedef uint32_t GpgpGrammarOperator; /**< An operator of a builder. 0: none. */

/** Where an operator sends shapes: to a rule or terminal by name, or to another operator. */
typedef struct GpgpGrammarSuccessor {
  GpgpGrammarValue value; /**< The value before the successor in SubDiv and RandomRule. Else GPGP_VALUE_NONE. */
  const char* name;       /**< The name of a rule or terminal, or NULL. */
  GpgpGrammarOperator op; /**< The operator if name is NULL, else 0. */
} GpgpGrammarSuccessor;

/** Adds an operator. It becomes part of the grammar when it is used as the successor of an operator or as the body of a
 *  rule. It can be used once. To use it in several places, make it a rule. Operators nest at most 200 deep. In
 *  libgpgp_compiler. @threads handle @lifetime call */
GPGP_API GpgpGrammarOperator GPGP_CALL gpgpAddOperator(GpgpGrammarBuilder builder, GpgpOperatorKind kind,
                                                       const GpgpGrammarValue* values, uint32_t valueCount,
                                                       const GpgpGrammarSuccessor* successors, uint32_t successorCount);

/* ---------------------------------------------------------------- statements */

/** Adds a terminal line, which is the next bucket. names holds one name, or several that are separated by spaces and
 *  share the bucket. kind and index are those of GpgpGrammarTerminal. Names here and elsewhere consist of letters,
 *  digits and _. In libgpgp_compiler. @threads handle @lifetime call */
GPGP_API void GPGP_CALL gpgpAddTerminal(GpgpGrammarBuilder builder, const char* names, uint32_t kind, uint32_t index);

/** Adds a rule. Its body is the operator op. If successor is not NULL, op is 0 and the rule is another name for that
 *  rule or terminal. Rules are numbered in the order of the calls (GpgpAxiom::start). In libgpgp_compiler.
 *  @threads handle @lifetime call */
GPGP_API void GPGP_CALL gpgpAddRule(GpgpGrammarBuilder builder, const char* name, const char* successor,
                                    GpgpGrammarOperator op);

/** Gives a rule a priority, at most 65535. The default is 0. Priorities order the interactions of shapes: the Collider
 *  and IfCollides operators of a priority are derived after all of those of higher priorities. So an IfCollides does
 *  not see colliders of lower priorities, and does not wait for them. A priority applies to the operators in the body
 *  of the rule, not to the rules that they lead to. It also holds between linked grammars. See docs/guide/grammars.md.
 *  In libgpgp_compiler. @threads handle @lifetime call */
GPGP_API void GPGP_CALL gpgpSetRulePriority(GpgpGrammarBuilder builder, const char* rule, uint32_t priority);

/** Adds an axiom line: the type of a start shape, and the rule or terminal that it goes to. The first one is the
 *  default start. gpgpGetGrammarStarts lists them all. corners belongs to the GPGP_SHAPE_DYNAMIC_... types, and
 *  cornerCount is 0 for all others. In libgpgp_compiler. @threads handle @lifetime call */
GPGP_API void GPGP_CALL gpgpAddAxiom(GpgpGrammarBuilder builder, GpgpShape shape, const GpgpGrammarValue* corners,
                                     uint32_t cornerCount, const char* rule);

#ifdef __cplusplus
}
#endif
#endif
