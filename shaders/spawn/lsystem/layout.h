// What the passes of L-systems share with each other and with the CPU: bindings, counters, constants of a recording.
#ifndef GPGP_SHADERS_SPAWN_LSYSTEM_LAYOUT_H
#define GPGP_SHADERS_SPAWN_LSYSTEM_LAYOUT_H
#include "spawn/lsystem/format.h"

GPGP_SHADER_BEGIN

// Bindings of descriptor set 0, which are the numbers of the deriver's resources.
GPGP_CONST int kLsysBindTable = 0;
GPGP_CONST int kLsysBindAxioms = 1;
GPGP_CONST int kLsysBindInstances = 2;
GPGP_CONST int kLsysBindDraws = 3;
GPGP_CONST int kLsysBindCorners = 4;
GPGP_CONST int kLsysBindModulesOut = 5;
GPGP_CONST int kLsysBindParametersOut = 6;
GPGP_CONST int kLsysBindCount = 7;
GPGP_CONST int kLsysBindModules = 8;    // two strings of maxModules
GPGP_CONST int kLsysBindParameters = 9; // two of maxParameters
GPGP_CONST int kLsysBindChosen = 10;    // the production of each module; while drawing, the end of its path
GPGP_CONST int kLsysBindTiles = 11;     // sums of tiles; frames of tiles
GPGP_CONST int kLsysBindCounters = 12;
GPGP_CONST int kLsysBindConstants = 13;
GPGP_CONST int kLsysBindNodes = 14; // the pyramid of contexts
GPGP_CONST int kLsysBindMarks = 15; // of each module
GPGP_CONST int kLsysBindOrder = 16; // modules by depth, twice; the place of each there, and among instances
GPGP_CONST int kLsysBindHistogram = 17;
GPGP_CONST int kLsysBindFrames = 18;   // by place
GPGP_CONST int kLsysBindBranches = 19; // frames of branches, twice
GPGP_CONST int kLsysBindParents = 20;  // of branches, twice; the branch of each place; lists of walkers

GPGP_CONST uint kLsysTile = 256u;       // modules of a workgroup, one an invocation
GPGP_CONST uint kLsysFrameLanes = 128u; // of the passes that join frames,
GPGP_CONST uint kLsysFrameEach = 4u;    // with as many modules an invocation
GPGP_CONST uint kLsysFrameTile = 512u;
GPGP_CONST uint kLsysDigits = 256u;
GPGP_CONST uint kLsysWalkLanes = 64u;
GPGP_CONST uint kLsysWalkLength = 256u; // modules that a walker passes in a round
GPGP_CONST uint kLsysJumps = 16u;       // rounds in which branches find their root
GPGP_CONST uint kLsysMostSteps = 1024u;
GPGP_CONST uint kLsysMostModules = 8388480u; // 65535 workgroups of 128
GPGP_CONST uint kLsysMostDepth = 65535u;

/// Counters of one recording, and its report.
struct LsysState {
  uint modulesA, modulesB; // of the two strings
  uint parametersA, parametersB;
  uint stoppedAt; // the step whose string did not fit, or all bits
  uint modulesNeeded;
  uint parametersNeeded;
  uint last;                // which string is the last
  uint modules, parameters; // of it
  uint depth;
  uint branches; // and the root
  uint instances;
  uint instancesWritten;
  uint polygonCorners;
  uint sections;
  uint unwalked;     // walkers that were left after the last round
  uint deep;         // 1: depths take two digits
  uint jumps;        // rounds that branches take
  uint hashX, hashY; // of all modules, with their places
  uint cornersWritten;
  uint depthExceeded; // 1: brackets nest deeper than kLsysMostDepth
  uint steps;         // that were taken
};
// Arguments of indirect dispatches lie behind it, four words each.
GPGP_CONST uint kLsysArgsAt = 24u;    // words of LsysState
GPGP_CONST uint kLsysArgsString = 0u; // and 1: tiles of each string
GPGP_CONST uint kLsysArgsLast = 2u;   // tiles of the last string
GPGP_CONST uint kLsysArgsFrames = 3u; // its tiles of frames
GPGP_CONST uint kLsysArgsDeep = 4u;   // its tiles where depths take two digits
GPGP_CONST uint kLsysArgsJumps = 5u;  // branches, a round each
GPGP_CONST uint kLsysArgsWalks = 21u; // walkers, a round each

/// What the CPU says with each recording.
struct LsysConstants {
  uint axiomCount;
  uint steps;
  uint maxModules, maxParameters;
  uint leaves; // of the pyramid
  uint instanceCapacity, cornerCapacity;
  uint drawCapacity;
  uint moduleCapacity, parameterCapacity; // of the engine's buffers
  uint writesCount;
  uint rounds; // of walkers
  uint maxBranches;
  uint structured; // 1: steps may need contexts or cuts
  uint reserved0, reserved1;
  uvec4 phases[kLsysMostSteps / 64u]; // two bits a step
};

// Stages of shaders that have several.
GPGP_CONST uint kLsysSortCount = 0u;
GPGP_CONST uint kLsysSortRows = 1u;
GPGP_CONST uint kLsysSortScatter = 2u;
GPGP_CONST uint kLsysKeyDepth = 0u; // low digit
GPGP_CONST uint kLsysKeyDeep = 1u;  // high digit
GPGP_CONST uint kLsysKeyTerminal = 2u;
GPGP_CONST uint kLsysSumStep = 0u;      // what tiles hold: modules and parameters of a step
GPGP_CONST uint kLsysSumMarks = 1u;     // depth, brackets, polygons, axioms
GPGP_CONST uint kLsysSumPolygons = 2u;  // corners, and the last polygon
GPGP_CONST uint kLsysSumCylinders = 3u; // sections, and the last cylinder
GPGP_CONST uint kLsysSumDepths = 4u;    // as marks, of a step's string

GPGP_SHADER_END
#endif
