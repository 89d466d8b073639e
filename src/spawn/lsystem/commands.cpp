// The turtle commands of symbols, by their names.
#include "spawn/lsystem/format.h"
#include "spawn/lsystem/syntax.h"

namespace gpgp::spawn::lsystem {

uint32_t turtleOf(std::string_view name) {
  using namespace shader;
  if (name == "@Gs") return kTurtleCylinder;
  if (name == "@Gc") return kTurtleSection;
  if (name == "@Ge") return kTurtleCylinderEnd;
  if (name == "@o" || name == "@c" || name == "@O") return kTurtleAsset;
  if (name == "@v") return kTurtleUpright;
  if (name.size() == 2 && name[0] == '~') return kTurtleAsset;
  if (name.size() != 1) return kTurtleNone;
  switch (name[0]) {
  case 'F': return kTurtleDraw;
  case 'f': return kTurtleMove;
  case 'G': return kTurtleDrawOnly;
  case '+': return kTurtleLeft;
  case '-': return kTurtleRight;
  case '&': return kTurtleDown;
  case '^': return kTurtleUp;
  case '\\': return kTurtleRollLeft;
  case '/': return kTurtleRollRight;
  case '|': return kTurtleAround;
  case '[': return kTurtleOpen;
  case ']': return kTurtleClose;
  case '!': return kTurtleWidth;
  case ';':
  case '\'': return kTurtleColour;
  case '{': return kTurtlePolygon;
  case '.': return kTurtleCorner;
  case '}': return kTurtlePolygonEnd;
  case '%': return kTurtleCut;
  case '$': return kTurtleUpright;
  case 'T': return kTurtleTropism;
  case 'J':
  case 'K':
  case 'M': return kTurtleAsset;
  default: return kTurtleNone;
  }
}

} // namespace gpgp::spawn::lsystem
