// What the spawner's passes share with each other and with the CPU: counters, constants of a record, bindings.
#ifndef GPGP_SHADERS_SPAWN_LAYOUT_H
#define GPGP_SHADERS_SPAWN_LAYOUT_H
#include "spawn/graph_format.h"

GPGP_SHADER_BEGIN

/// Counters of one record, cleared at its start. The first eight words are the report.
struct SpawnState {
  uint terminals; // derived, those that did not fit included
  uint instancesWritten;
  uint peakShapes;
  uint droppedShapes;
  uint unfinishedShapes;
  uint rounds;
  uint keyHashX;
  uint keyHashY;
};
GPGP_CONST uint kSpawnReportWords = 8u;

/// One round of derivation: the arguments of its dispatch, and what its queue holds.
struct SpawnRound {
  uint groupsX, groupsY, groupsZ; // VkDispatchIndirectCommand
  uint shapes;                    // that the round before made, those that did not fit included
};

/// What the CPU says with each record.
struct SpawnConstants {
  uint axiomCount;
  uint instanceCapacity; // GpgpInstance
  uint drawCapacity;     // VkDrawIndexedIndirectCommand; 0: instances are not sorted
  uint writeCount;       // 1: the count buffer is there
  uint rounds;           // that were recorded
  uint maxGroups;        // workgroups that fill the device; shaders stride beyond them
};

GPGP_CONST uint kSpawnGroupSize = 64u;
GPGP_CONST uint kDrawWords = 5u; // VkDrawIndexedIndirectCommand

GPGP_SHADER_END
#endif
