// A compiled L-system: one table of 32-bit words, which the CPU checks once (src/spawn/lsystem/table.cpp) and the
// rewriting and turtle passes read.
//
// Header, then sections in the order of their numbers. Offsets are in words from the start of the table.
#ifndef GPGP_SHADERS_SPAWN_LSYSTEM_FORMAT_H
#define GPGP_SHADERS_SPAWN_LSYSTEM_FORMAT_H
#include "core/shared.h"

GPGP_SHADER_BEGIN

GPGP_CONST uint kLsysMagic = 0x736c7067u; // "gpls"
GPGP_CONST uint kLsysVersion = 2u;

// Words of the header.
GPGP_CONST uint kLsysHeadMagic = 0u;
GPGP_CONST uint kLsysHeadVersion = 1u;
GPGP_CONST uint kLsysHeadWords = 2u;
GPGP_CONST uint kLsysHeadChecksum = 3u; // of all words behind it
GPGP_CONST uint kLsysHeadIterations = 4u;
GPGP_CONST uint kLsysHeadDecompositions = 5u; // steps of decomposition behind each iteration
GPGP_CONST uint kLsysHeadHomomorphisms = 6u;  // steps of homomorphism at the end
GPGP_CONST uint kLsysHeadFlags = 7u;
GPGP_CONST uint kLsysHeadSeed = 8u;
GPGP_CONST uint kLsysHeadAngle = 9u; // floats from here: degrees
GPGP_CONST uint kLsysHeadStep = 10u;
GPGP_CONST uint kLsysHeadWidth = 11u;
GPGP_CONST uint kLsysHeadTaper = 12u;    // factor of !
GPGP_CONST uint kLsysHeadTropism = 13u;  // direction of unit length, then elasticity
GPGP_CONST uint kLsysHeadAxiom = 17u;    // production whose successor is the axiom
GPGP_CONST uint kLsysHeadSegment = 18u;  // shape of segments
GPGP_CONST uint kLsysHeadRows = 19u;     // of the table that code begins with: steps, then a value a row and step
GPGP_CONST uint kLsysHeadSections = 20u; // a count of entries and an offset for each
GPGP_CONST uint kLsysSectionSymbols = 0u;
GPGP_CONST uint kLsysSectionProductions = 1u;
GPGP_CONST uint kLsysSectionContexts = 2u;
GPGP_CONST uint kLsysSectionModules = 3u;
GPGP_CONST uint kLsysSectionTerminals = 4u;
GPGP_CONST uint kLsysSectionCode = 5u;
GPGP_CONST uint kLsysSectionNames = 6u; // bytes, each name ends in 0
GPGP_CONST uint kLsysSections = 7u;
GPGP_CONST uint kLsysHeadSize = 20u + 2u * 7u;

// Flags of the header.
GPGP_CONST uint kLsysContexts = 1u;   // a production has a context
GPGP_CONST uint kLsysCuts = 2u;       // there is a symbol that cuts
GPGP_CONST uint kLsysWalks = 4u;      // a turtle command depends on the heading
GPGP_CONST uint kLsysPolygons = 8u;   // there are polygons
GPGP_CONST uint kLsysCylinders = 16u; // there are generalised cylinders

// A symbol is a name with a number of parameters. Words of one:
GPGP_CONST uint kSymbolName = 0u; // byte in the names
GPGP_CONST uint kSymbolArity = 1u;
GPGP_CONST uint kSymbolTurtle = 2u;   // kTurtle...
GPGP_CONST uint kSymbolTerminal = 3u; // that it draws, or kNoTerminal
GPGP_CONST uint kSymbolFlags = 4u;
GPGP_CONST uint kSymbolPhases = 5u; // the first of its productions and their number, for each phase
GPGP_CONST uint kSymbolSize = 11u;
GPGP_CONST uint kSymbolIgnored = 1u; // contexts do not see it
GPGP_CONST uint kNoTerminal = 0xffffffffu;

// What a step applies.
GPGP_CONST uint kPhaseMain = 0u;
GPGP_CONST uint kPhaseDecomposition = 1u;
GPGP_CONST uint kPhaseHomomorphism = 2u;
GPGP_CONST uint kPhases3 = 3u;
GPGP_CONST uint kPhaseCut = 3u; // no production; what a cut removes goes

GPGP_CONST uint kProductionPredecessor = 0u;
GPGP_CONST uint kProductionLeft = 1u; // context elements, the nearest first; count
GPGP_CONST uint kProductionRight = 3u;
GPGP_CONST uint kProductionCondition = 5u;   // word of a program, 0: none
GPGP_CONST uint kProductionProbability = 6u; // the same
GPGP_CONST uint kProductionSuccessor = 7u;   // modules, count
GPGP_CONST uint kProductionParameters = 9u;  // of all modules of the successor
GPGP_CONST uint kProductionSize = 10u;

GPGP_CONST uint kContextSymbol = 0u;   // or one of these
GPGP_CONST uint kContextVariable = 1u; // where its parameters go among the production's variables
GPGP_CONST uint kContextSize = 2u;
GPGP_CONST uint kContextOpen = 0xfffffffeu;
GPGP_CONST uint kContextClose = 0xffffffffu;

GPGP_CONST uint kModuleSymbol = 0u;
GPGP_CONST uint kModuleCode = 1u; // word where the programs of its parameters begin, one behind the other
GPGP_CONST uint kModuleSize = 2u;

GPGP_CONST uint kTerminalNameAt = 0u;
GPGP_CONST uint kTerminalKind = 1u; // 0: a segment, polygon or cylinder; 1: an asset
GPGP_CONST uint kTerminalShape = 2u;
GPGP_CONST uint kTerminalWords = 3u;
GPGP_CONST uint kMostTerminals = 255u;

GPGP_CONST uint kMostVariables = 24u; // of a production
GPGP_CONST uint kMostArity = 12u;     // of a symbol
GPGP_CONST uint kMostStackDepth = 16u;
GPGP_CONST uint kMostContext = 32u;       // elements on a side
GPGP_CONST uint kMostAlternatives = 256u; // productions of a symbol and phase
GPGP_CONST uint kMostSuccessor = 1024u;   // modules
GPGP_CONST uint kMostProgram = 1024u;     // words

// Turtle commands. Local ones are products of frames; the last two depend on the heading.
GPGP_CONST uint kTurtleNone = 0u;
GPGP_CONST uint kTurtleDraw = 1u;     // F: moves, draws; in a polygon it is an edge
GPGP_CONST uint kTurtleMove = 2u;     // f: moves; in a polygon it is an edge
GPGP_CONST uint kTurtleDrawOnly = 3u; // G: moves, draws, is never an edge
GPGP_CONST uint kTurtleMoveOnly = 4u; // g: moves, is never an edge
GPGP_CONST uint kTurtleLeft = 5u;
GPGP_CONST uint kTurtleRight = 6u;
GPGP_CONST uint kTurtleDown = 7u;
GPGP_CONST uint kTurtleUp = 8u;
GPGP_CONST uint kTurtleRollLeft = 9u;
GPGP_CONST uint kTurtleRollRight = 10u;
GPGP_CONST uint kTurtleAround = 11u;
GPGP_CONST uint kTurtleOpen = 12u;
GPGP_CONST uint kTurtleClose = 13u;
GPGP_CONST uint kTurtleWidth = 14u;
GPGP_CONST uint kTurtleColour = 15u;
GPGP_CONST uint kTurtlePolygon = 16u;
GPGP_CONST uint kTurtleCorner = 17u;
GPGP_CONST uint kTurtlePolygonEnd = 18u;
GPGP_CONST uint kTurtleAsset = 19u;
GPGP_CONST uint kTurtleCut = 20u;
GPGP_CONST uint kTurtleCylinder = 21u;
GPGP_CONST uint kTurtleSection = 22u;
GPGP_CONST uint kTurtleCylinderEnd = 23u;
GPGP_CONST uint kTurtleAxiom = 24u;   // begins an axiom's string; its parameter is the axiom's number, as bits
GPGP_CONST uint kTurtleUpright = 25u; // $
GPGP_CONST uint kTurtleTropism = 26u; // T
GPGP_CONST uint kTurtleCommands = 27u;

// Symbols that every table begins with.
GPGP_CONST uint kSymbolOpen = 0u;
GPGP_CONST uint kSymbolClose = 1u;
GPGP_CONST uint kSymbolAxiom = 2u;

// Programs for a stack machine. All values are settled floats; conditions are 1 and 0.
GPGP_CONST uint kLsysEnd = 0u;
GPGP_CONST uint kLsysNumber = 1u;   // a float follows
GPGP_CONST uint kLsysVariable = 2u; // its number follows
GPGP_CONST uint kLsysRandom = 3u;   // [0, 1); the draw's number follows
GPGP_CONST uint kLsysNormal = 4u;   // mean 0, deviation 1; the draw's number follows
GPGP_CONST uint kLsysByStep = 5u;   // a value of each step: the number of its row in the table of steps follows
GPGP_CONST uint kLsysNegate = 8u;   // of one value
GPGP_CONST uint kLsysNot = 9u;
GPGP_CONST uint kLsysSin = 10u; // angles in degrees
GPGP_CONST uint kLsysCos = 11u;
GPGP_CONST uint kLsysTan = 12u;
GPGP_CONST uint kLsysAsin = 13u;
GPGP_CONST uint kLsysAcos = 14u;
GPGP_CONST uint kLsysAtan = 15u;
GPGP_CONST uint kLsysSqrt = 16u;
GPGP_CONST uint kLsysExp = 17u;
GPGP_CONST uint kLsysLog = 18u;
GPGP_CONST uint kLsysAbs = 19u;
GPGP_CONST uint kLsysFloor = 20u;
GPGP_CONST uint kLsysCeil = 21u;
GPGP_CONST uint kLsysRound = 22u;
GPGP_CONST uint kLsysSign = 23u;
GPGP_CONST uint kLsysTruncate = 24u; // towards 0
GPGP_CONST uint kLsysAdd = 32u;      // of two
GPGP_CONST uint kLsysSubtract = 33u;
GPGP_CONST uint kLsysMultiply = 34u;
GPGP_CONST uint kLsysDivide = 35u;
GPGP_CONST uint kLsysModulo = 36u;
GPGP_CONST uint kLsysPower = 37u;
GPGP_CONST uint kLsysEqual = 38u;
GPGP_CONST uint kLsysNotEqual = 39u;
GPGP_CONST uint kLsysLess = 40u;
GPGP_CONST uint kLsysLessEqual = 41u;
GPGP_CONST uint kLsysGreater = 42u;
GPGP_CONST uint kLsysGreaterEqual = 43u;
GPGP_CONST uint kLsysAnd = 44u;
GPGP_CONST uint kLsysOr = 45u;
GPGP_CONST uint kLsysMin = 46u;
GPGP_CONST uint kLsysMax = 47u;
GPGP_CONST uint kLsysAtan2 = 48u;
GPGP_CONST uint kLsysSelect = 64u; // of three: condition, value if it holds, value if not

GPGP_SHADER_END
#endif
