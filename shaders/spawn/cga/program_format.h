// What a compiled .cga program consists of: values, and the instructions of a small stack machine as 32-bit words.
//
// A program is one array of words. A chunk is the code of a rule, of a block's part, or of a function, behind a header
// of three words. Jumps and calls are offsets into the array. Strings, shapes' attributes and selectors are numbers.
#ifndef GPGP_SHADERS_SPAWN_CGA_PROGRAM_FORMAT_H
#define GPGP_SHADERS_SPAWN_CGA_PROGRAM_FORMAT_H
#include "core/shared.h"

GPGP_SHADER_BEGIN

/// bits: a float's, 0 or 1, a string's number, an array's handle, a word's number.
struct CgaValue {
  uint type;
  uint bits;
};
GPGP_CONST uint kCgaFloat = 0u;
GPGP_CONST uint kCgaBool = 1u;
GPGP_CONST uint kCgaString = 2u;
GPGP_CONST uint kCgaArray = 3u;
GPGP_CONST uint kCgaWord = 4u;     // a selector, such as world.up: the number of its string
GPGP_CONST uint kCgaRelative = 5u; // a float behind '
GPGP_CONST uint kCgaFloating = 6u; // a float behind ~
GPGP_CONST uint kCgaNothing = 7u;  // the end of a range that is left out

// A chunk's header, before its first instruction.
GPGP_CONST uint kCgaChunkName = 0u;       // string
GPGP_CONST uint kCgaChunkParameters = 1u; // values that it takes, of a block's part all that are visible in it
GPGP_CONST uint kCgaChunkLocals = 2u;     // values that it needs, parameters included
GPGP_CONST uint kCgaChunkHeader = 3u;

// Name, words of operands. What the machine leaves to its includer is marked (host).
#define GPGP_CGA_INSTRUCTIONS(X)                                                                                       \
  X(PushFloat, 1)  /* bits */                                                                                          \
  X(PushBool, 1)   /* 0 or 1 */                                                                                        \
  X(PushString, 1) /* number */                                                                                        \
  X(PushWord, 1)   /* number of a selector's string */                                                                 \
  X(PushNothing, 0)                                                                                                    \
  X(Local, 1)     /* number */                                                                                         \
  X(SetLocal, 1)  /* number; pops */                                                                                   \
  X(Attribute, 1) /* slot (host) */                                                                                    \
  X(Pop, 0)                                                                                                            \
  X(Add, 0)                                                                                                            \
  X(Subtract, 0)                                                                                                       \
  X(Multiply, 0)                                                                                                       \
  X(Divide, 0)                                                                                                         \
  X(Modulo, 0)                                                                                                         \
  X(Equal, 0)                                                                                                          \
  X(NotEqual, 0)                                                                                                       \
  X(Less, 0)                                                                                                           \
  X(LessEqual, 0)                                                                                                      \
  X(Greater, 0)                                                                                                        \
  X(GreaterEqual, 0)                                                                                                   \
  X(Each, 1) /* one of the six comparisons above, element by element (host) */                                         \
  X(Negate, 0)                                                                                                         \
  X(Not, 0)                                                                                                            \
  X(Relative, 0)                                                                                                       \
  X(Floating, 0)                                                                                                       \
  X(Jump, 1)       /* offset */                                                                                        \
  X(JumpUnless, 1) /* offset; pops */                                                                                  \
  X(And, 1)        /* offset to jump to if false, which stays; else pops */                                            \
  X(Or, 1)                                                                                                             \
  X(Draw, 0)   /* a random number of [0, 100) */                                                                       \
  X(Choose, 1) /* a number, a percentage: below it both go; else the difference stays and it jumps */                  \
  X(Call, 2)   /* chunk, arguments */                                                                                  \
  X(Return, 0)                                                                                                         \
  X(Math, 2)       /* function of GPGP_CGA_MATH, arguments */                                                          \
  X(Function, 2)   /* function, arguments (host) */                                                                    \
  X(Array, 1)      /* values (host) */                                                                                 \
  X(Index, 1)      /* dimensions (host) */                                                                             \
  X(Range, 0)      /* two values to a range (host) */                                                                  \
  X(Operation, 2)  /* operation, arguments (host) */                                                                   \
  X(Block, 3)      /* operation, values on the stack, offset of its table of parts (host) */                           \
  X(Invoke, 2)     /* chunk, arguments: a child (host) */                                                              \
  X(InvokeLast, 2) /* the same as the last thing that a rule does: it goes on there */                                 \
  X(Leaf, 1)       /* name: the shape as it is ends here (host) */                                                     \
  X(Nil, 0)        /* no shape comes of this rule (host) */                                                            \
  X(PushShape, 0)                                                                                                      \
  X(PopShape, 0)                                                                                                       \
  X(SetAttribute, 1) /* slot; pops (host) */                                                                           \
  X(End, 0)          /* a shape of which nothing came is a leaf (host) */

#define GPGP_CGA_COUNT(name, operands) +1 // NOLINT(bugprone-macro-parentheses): a term of a sum
GPGP_CONST uint kCgaInstructions = 0u GPGP_CGA_INSTRUCTIONS(GPGP_CGA_COUNT);

// A table of parts: count, then the offset of each part's record.
GPGP_CONST uint kCgaPartKind = 0u;     // kCgaPart... below
GPGP_CONST uint kCgaPartSelector = 1u; // which of the block's values is its size or selector
GPGP_CONST uint kCgaPartBody = 2u;     // chunk, or the offset of a nested table
GPGP_CONST uint kCgaPartWords = 3u;
GPGP_CONST uint kCgaPartEach = 0u;      // a part; of components, a shape each
GPGP_CONST uint kCgaPartTogether = 1u;  // components as one shape
GPGP_CONST uint kCgaPartConnected = 2u; // of components as one shape, one for each that hang together
GPGP_CONST uint kCgaPartGroup = 3u;     // a nested table
GPGP_CONST uint kCgaPartRepeated = 4u;  // a nested table that repeats
GPGP_CONST uint kCgaNoSelector = 0xffffffffu;

// How a run ended.
GPGP_CONST uint kCgaDone = 0u;
GPGP_CONST uint kCgaStackFull = 1u; // more values than the machine has places for
GPGP_CONST uint kCgaTooDeep = 2u;   // functions call each other deeper than the limit
GPGP_CONST uint kCgaTooLong = 3u;   // more instructions than the limit
GPGP_CONST uint kCgaStopped = 4u;   // by the includer
GPGP_CONST uint kCgaBadCode = 5u;   // no instruction

// Functions of numbers that need nothing but them.
#define GPGP_CGA_MATH(X)                                                                                               \
  X(Abs, "abs", 1, 1)                                                                                                  \
  X(Acos, "acos", 1, 1)                                                                                                \
  X(Asin, "asin", 1, 1)                                                                                                \
  X(Atan, "atan", 1, 1)                                                                                                \
  X(Atan2, "atan2", 2, 2)                                                                                              \
  X(Ceil, "ceil", 1, 1)                                                                                                \
  X(Cos, "cos", 1, 1)                                                                                                  \
  X(Exp, "exp", 1, 1)                                                                                                  \
  X(Floor, "floor", 1, 1)                                                                                              \
  X(Isinf, "isinf", 1, 1)                                                                                              \
  X(Isnan, "isnan", 1, 1)                                                                                              \
  X(Ln, "ln", 1, 1)                                                                                                    \
  X(Log10, "log10", 1, 1)                                                                                              \
  X(Max, "max", 2, 2)                                                                                                  \
  X(Min, "min", 2, 2)                                                                                                  \
  X(Pow, "pow", 2, 2)                                                                                                  \
  X(Rint, "rint", 1, 1)                                                                                                \
  X(Sin, "sin", 1, 1)                                                                                                  \
  X(Sqrt, "sqrt", 1, 1)                                                                                                \
  X(Tan, "tan", 1, 1)                                                                                                  \
  X(Rand, "rand", 0, 2)                                                                                                \
  X(P, "p", 1, 1)

// Numbers, in the order of the lists; GLSL has no enumerators.
GPGP_CONST uint kCgaPushFloatCode = 0u;
GPGP_CONST uint kCgaPushBoolCode = 1u;
GPGP_CONST uint kCgaPushStringCode = 2u;
GPGP_CONST uint kCgaPushWordCode = 3u;
GPGP_CONST uint kCgaPushNothingCode = 4u;
GPGP_CONST uint kCgaLocalCode = 5u;
GPGP_CONST uint kCgaSetLocalCode = 6u;
GPGP_CONST uint kCgaAttributeCode = 7u;
GPGP_CONST uint kCgaPopCode = 8u;
GPGP_CONST uint kCgaAddCode = 9u;
GPGP_CONST uint kCgaSubtractCode = 10u;
GPGP_CONST uint kCgaMultiplyCode = 11u;
GPGP_CONST uint kCgaDivideCode = 12u;
GPGP_CONST uint kCgaModuloCode = 13u;
GPGP_CONST uint kCgaEqualCode = 14u;
GPGP_CONST uint kCgaNotEqualCode = 15u;
GPGP_CONST uint kCgaLessCode = 16u;
GPGP_CONST uint kCgaLessEqualCode = 17u;
GPGP_CONST uint kCgaGreaterCode = 18u;
GPGP_CONST uint kCgaGreaterEqualCode = 19u;
GPGP_CONST uint kCgaEachCode = 20u;
GPGP_CONST uint kCgaNegateCode = 21u;
GPGP_CONST uint kCgaNotCode = 22u;
GPGP_CONST uint kCgaRelativeCode = 23u;
GPGP_CONST uint kCgaFloatingCode = 24u;
GPGP_CONST uint kCgaJumpCode = 25u;
GPGP_CONST uint kCgaJumpUnlessCode = 26u;
GPGP_CONST uint kCgaAndCode = 27u;
GPGP_CONST uint kCgaOrCode = 28u;
GPGP_CONST uint kCgaDrawCode = 29u;
GPGP_CONST uint kCgaChooseCode = 30u;
GPGP_CONST uint kCgaCallCode = 31u;
GPGP_CONST uint kCgaReturnCode = 32u;
GPGP_CONST uint kCgaMathCode = 33u;
GPGP_CONST uint kCgaFunctionCode = 34u;
GPGP_CONST uint kCgaArrayCode = 35u;
GPGP_CONST uint kCgaIndexCode = 36u;
GPGP_CONST uint kCgaRangeCode = 37u;
GPGP_CONST uint kCgaOperationCode = 38u;
GPGP_CONST uint kCgaBlockCode = 39u;
GPGP_CONST uint kCgaInvokeCode = 40u;
GPGP_CONST uint kCgaInvokeLastCode = 41u;
GPGP_CONST uint kCgaLeafCode = 42u;
GPGP_CONST uint kCgaNilCode = 43u;
GPGP_CONST uint kCgaPushShapeCode = 44u;
GPGP_CONST uint kCgaPopShapeCode = 45u;
GPGP_CONST uint kCgaSetAttributeCode = 46u;
GPGP_CONST uint kCgaEndCode = 47u;
GPGP_CONST uint kCgaAbsMath = 0u;
GPGP_CONST uint kCgaAcosMath = 1u;
GPGP_CONST uint kCgaAsinMath = 2u;
GPGP_CONST uint kCgaAtanMath = 3u;
GPGP_CONST uint kCgaAtan2Math = 4u;
GPGP_CONST uint kCgaCeilMath = 5u;
GPGP_CONST uint kCgaCosMath = 6u;
GPGP_CONST uint kCgaExpMath = 7u;
GPGP_CONST uint kCgaFloorMath = 8u;
GPGP_CONST uint kCgaIsinfMath = 9u;
GPGP_CONST uint kCgaIsnanMath = 10u;
GPGP_CONST uint kCgaLnMath = 11u;
GPGP_CONST uint kCgaLog10Math = 12u;
GPGP_CONST uint kCgaMaxMath = 13u;
GPGP_CONST uint kCgaMinMath = 14u;
GPGP_CONST uint kCgaPowMath = 15u;
GPGP_CONST uint kCgaRintMath = 16u;
GPGP_CONST uint kCgaSinMath = 17u;
GPGP_CONST uint kCgaSqrtMath = 18u;
GPGP_CONST uint kCgaTanMath = 19u;
GPGP_CONST uint kCgaRandMath = 20u;
GPGP_CONST uint kCgaPMath = 21u;
#ifdef __cplusplus
namespace cga_numbers { // that they are in the order of the lists
enum : uint {
#define GPGP_CGA_ENUMERATOR(name, operands) k##name,
  GPGP_CGA_INSTRUCTIONS(GPGP_CGA_ENUMERATOR)
#undef GPGP_CGA_ENUMERATOR
};
#define GPGP_CGA_CHECK(name, operands) static_assert(uint(k##name) == kCga##name##Code);
GPGP_CGA_INSTRUCTIONS(GPGP_CGA_CHECK)
#undef GPGP_CGA_CHECK
} // namespace cga_numbers
#endif

GPGP_SHADER_END
#endif
