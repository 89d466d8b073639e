/* gpgp spawn: grammars made in code instead of text, with the same graph as the result. All of it is in
 * libgpgp_compiler.
 *
 *   gpgpCreateGrammarBuilder -> gpgpAdd... -> gpgpCompileGrammar (GpgpGrammarSource::builder) -> blob
 *
 * What is added is checked when it is compiled, all at once: every error is a message that says in which rule and
 * operator it is and what was expected. So the functions here return no errors: what went wrong in them (a NULL name,
 * a value that does not exist, no memory) is an error of compiling, too. Rules and terminals are named, and a name may
 * be used before it is defined. Operators and what they do are those of the language, see docs/spawn.md.
 *
 *   const GpgpGrammarValue axis = GPGP_GRAMMAR_VALUE(GPGP_VALUE_X);
 *   const GpgpGrammarSuccessor halves[] = {{GPGP_GRAMMAR_NUMBER(-1), "Wall", 0}, {GPGP_GRAMMAR_NUMBER(-1), "Door", 0}};
 *   gpgpAddRule(builder, "Front", NULL, gpgpAddOperator(builder, GPGP_OPERATOR_SUB_DIV, &axis, 1, halves, 2));
 *
 * is the rule Front = SubDiv(X) { -1: Wall | -1: Door }; of the language.
 */
#ifndef GPGP_SPAWN_BUILDER_H
#define GPGP_SPAWN_BUILDER_H
#include <gpgp/spawn.h>
#ifdef __cplusplus
extern "C" {
#endif

/** Makes an empty builder. In libgpgp_compiler. Errors: INVALID_ARGUMENT, OUT_OF_HOST_MEMORY. @threads any */
GPGP_API GpgpResult GPGP_CALL gpgpCreateGrammarBuilder(GpgpGrammarBuilder* builder);
/** Destroys a builder; NULL is ignored. What was compiled from it stays. In libgpgp_compiler. @threads handle */
GPGP_API void GPGP_CALL gpgpDestroyGrammarBuilder(GpgpGrammarBuilder builder);

/* ---------------------------------------------------------------- values */

typedef uint32_t GpgpGrammarValueId;
enum {
  GPGP_VALUE_NONE = 0,
  GPGP_VALUE_NUMBER = 1, /**< GpgpGrammarValue::number */
  GPGP_VALUE_X = 2,      /**< axes, where an operator takes one */
  GPGP_VALUE_Y = 3,
  GPGP_VALUE_Z = 4,
  GPGP_VALUE_ADJUST_TO_FILL = 5, /**< modes of Repeat */
  GPGP_VALUE_ANCHOR_TO_START = 6,
  GPGP_VALUE_ANCHOR_TO_END = 7,
  GPGP_VALUE_SHAPE_SEED = 8, /**< attributes of the shape; [0, 1) */
  GPGP_VALUE_SHAPE_CUSTOM_ATTRIBUTE = 9,
  GPGP_VALUE_SHAPE_POS_X = 10, /**< metres, in the axiom's frame; + 1: Y, + 2: Z */
  GPGP_VALUE_SHAPE_POS_Y = 11,
  GPGP_VALUE_SHAPE_POS_Z = 12,
  GPGP_VALUE_SHAPE_SIZE_X = 13, /**< metres; + 1: Y, + 2: Z */
  GPGP_VALUE_SHAPE_SIZE_Y = 14,
  GPGP_VALUE_SHAPE_SIZE_Z = 15,
  GPGP_VALUE_SHAPE_NORMAL_X = 16, /**< + 1: Y, + 2: Z */
  GPGP_VALUE_SHAPE_NORMAL_Y = 17,
  GPGP_VALUE_SHAPE_NORMAL_Z = 18,
  GPGP_VALUE_SHAPE_ROTATION_XX = 19 /**< ShapeRotation(X, X); + 3 * axis + component */
};

/** A number, or what an id stands for: one of the above, or what gpgpAddVariable, gpgpAddTag or
 *  gpgpAddExpression returned. */
typedef struct GpgpGrammarValue {
  GpgpGrammarValueId id;
  float number; /**< of GPGP_VALUE_NUMBER */
} GpgpGrammarValue;
/* initialisers: const GpgpGrammarValue width = GPGP_GRAMMAR_NUMBER(2.5); */
#define GPGP_GRAMMAR_NUMBER(value)                                                                                     \
  { GPGP_VALUE_NUMBER, (float)(value) }
#define GPGP_GRAMMAR_VALUE(id)                                                                                         \
  { (id), 0.0f }

/** Adds `var name = value`, which GpgpGrammarSource::variables can override, and returns what stands for it. The value
 *  must not depend on the shape. In libgpgp_compiler. @threads handle @lifetime call */
GPGP_API GpgpGrammarValue GPGP_CALL gpgpAddVariable(GpgpGrammarBuilder builder, const char* name,
                                                    GpgpGrammarValue value);

/** Returns what stands for a tag of Collider and IfCollides by that name, which is no number: numbers are tags
 *  themselves. In libgpgp_compiler. @threads handle @lifetime call */
GPGP_API GpgpGrammarValue GPGP_CALL gpgpAddTag(GpgpGrammarBuilder builder, const char* name);

typedef uint32_t GpgpExpressionKind;
enum {
  GPGP_EXPRESSION_ADD = 0,
  GPGP_EXPRESSION_SUBTRACT = 1,
  GPGP_EXPRESSION_MULTIPLY = 2,
  GPGP_EXPRESSION_DIVIDE = 3,
  GPGP_EXPRESSION_EQUAL = 4, /**< conditions are 1 and 0; equality tolerates one part in 100 000 */
  GPGP_EXPRESSION_NOT_EQUAL = 5,
  GPGP_EXPRESSION_LESS = 6,
  GPGP_EXPRESSION_GREATER = 7,
  GPGP_EXPRESSION_LESS_EQUAL = 8,
  GPGP_EXPRESSION_GREATER_EQUAL = 9,
  GPGP_EXPRESSION_AND = 10,
  GPGP_EXPRESSION_OR = 11,
  GPGP_EXPRESSION_RANDOM = 12, /**< Rand(left, right) */
  GPGP_EXPRESSION_CORNER = 13  /**< (left, right): x and y of a polygon's corner, in [-0.5, 0.5] */
};

/** Makes a value of two others. It may be used any number of times. At most 1024 values in one expression.
 *  In libgpgp_compiler. @threads handle */
GPGP_API GpgpGrammarValue GPGP_CALL gpgpAddExpression(GpgpGrammarBuilder builder, GpgpExpressionKind kind,
                                                      GpgpGrammarValue left, GpgpGrammarValue right);

/* ---------------------------------------------------------------- operators */

typedef uint32_t GpgpOperatorKind;
enum {
  GPGP_OPERATOR_TRANSLATE = 0,                      /**< values x, y, z; one successor */
  GPGP_OPERATOR_ROTATE = 1,                         /**< x, y, z in degrees; one */
  GPGP_OPERATOR_SCALE = 2,                          /**< x, y, z; one */
  GPGP_OPERATOR_EXTRUDE = 3,                        /**< height; one */
  GPGP_OPERATOR_SWAP_SIZE = 4,                      /**< three axes; one */
  GPGP_OPERATOR_COMP_SPLIT = 5,                     /**< none; top, bottom, sides, or one for all faces */
  GPGP_OPERATOR_SUB_DIV = 6,                        /**< axis; any number, each with a value */
  GPGP_OPERATOR_REPEAT = 7,                         /**< axis, extent, mode; one */
  GPGP_OPERATOR_IF = 8,                             /**< condition; two */
  GPGP_OPERATOR_IF_SIZE_LESS = 9,                   /**< axis, length; two */
  GPGP_OPERATOR_RANDOM_RULE = 10,                   /**< chance; any number, each with a value */
  GPGP_OPERATOR_REPLICATE = 11,                     /**< none; any number */
  GPGP_OPERATOR_DISCARD = 12,                       /**< none; none */
  GPGP_OPERATOR_GENERATE = 13,                      /**< none; none */
  GPGP_OPERATOR_COLLIDER = 14,                      /**< tag, or a whole number; one */
  GPGP_OPERATOR_IF_COLLIDES = 15,                   /**< tag; two */
  GPGP_OPERATOR_SET_AS_DYNAMIC_CONVEX_POLYGON = 16, /**< corners; one */
  GPGP_OPERATOR_SET_AS_DYNAMIC_CONCAVE_POLYGON = 17,
  GPGP_OPERATOR_SET_AS_DYNAMIC_CONVEX_RIGHT_PRISM = 18,
  GPGP_OPERATOR_SET_AS_DYNAMIC_CONCAVE_RIGHT_PRISM = 19
};

typedef uint32_t GpgpGrammarOperator; /**< what gpgpAddOperator returned; 0: none */

/** Where an operator sends shapes: to a rule or terminal by name, or on to another operator. */
typedef struct GpgpGrammarSuccessor {
  GpgpGrammarValue value; /**< before it, in SubDiv and RandomRule; GPGP_VALUE_NONE elsewhere */
  const char* name;       /**< of a rule or terminal; or NULL: op */
  GpgpGrammarOperator op;
} GpgpGrammarSuccessor;

/** Adds an operator. It has no place in the grammar until it is used, and it is used once: as the successor of one
 *  operator or as one rule. What several places share is a rule. Operators nest at most 200 deep.
 *  In libgpgp_compiler. @threads handle @lifetime call */
GPGP_API GpgpGrammarOperator GPGP_CALL gpgpAddOperator(GpgpGrammarBuilder builder, GpgpOperatorKind kind,
                                                       const GpgpGrammarValue* values, uint32_t valueCount,
                                                       const GpgpGrammarSuccessor* successors, uint32_t successorCount);

/* ---------------------------------------------------------------- statements */

/** Adds terminals: one name, or several separated by spaces, which then share a bucket. Each call is the next bucket.
 *  kind, index: as GpgpGrammarTerminal. Names here and elsewhere are letters, digits and _.
 *  In libgpgp_compiler. @threads handle @lifetime call */
GPGP_API void GPGP_CALL gpgpAddTerminal(GpgpGrammarBuilder builder, const char* names, uint32_t kind, uint32_t index);

/** Adds a rule: another name for a rule or terminal, or, where successor is NULL, an operator. Rules are numbered in
 * the order of the calls, see GpgpAxiom::start. In libgpgp_compiler. @threads handle @lifetime call */
GPGP_API void GPGP_CALL gpgpAddRule(GpgpGrammarBuilder builder, const char* name, const char* successor,
                                    GpgpGrammarOperator op);

/** Gives a rule a priority, at most 65535; rules without have 0. It concerns shapes that take notice of others: what
 *  rules of a priority do with Collider and IfCollides comes after all of what rules of higher ones do with them. So an
 *  IfCollides does not see colliders of lower priorities, and waits for no Collider of its tag there. It holds for the
 *  operators of the rule itself, not for the rules that they lead to, and across linked grammars. See docs/spawn.md,
 *  Colliders. In libgpgp_compiler. @threads handle @lifetime call */
GPGP_API void GPGP_CALL gpgpSetRulePriority(GpgpGrammarBuilder builder, const char* rule, uint32_t priority);

/** Adds a start: a shape and the rule or terminal that it goes to. The first one is the default, for the others see
 *  gpgpGetGrammarStarts. Only dynamic shapes have corners. In libgpgp_compiler. @threads handle @lifetime call */
GPGP_API void GPGP_CALL gpgpAddAxiom(GpgpGrammarBuilder builder, GpgpShape shape, const GpgpGrammarValue* corners,
                                     uint32_t cornerCount, const char* rule);

#ifdef __cplusplus
}
#endif
#endif
