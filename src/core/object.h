// Objects behind handles. A handle is the address of a slot with a generation in its low bits. Slots are never given
// back while the context lives, so a destroyed handle is never followed. A slot whose generations are used up begins
// anew behind kWornSlots others: a destroyed handle is recognised until at least as many more objects were destroyed,
// mostly until 64 times as many were.
#pragma once
#include "core/host_memory.h"
#include "core/result.h"

namespace gpgp::core {

class Context;

enum class Kind : uint32_t {
  none,
  grammar,
  lsystem,
  drawing,
  glyphSet,
  geometrySet,
  spawner,
  lsystemRecorder,
  canvas,
  patchRecorder,
  visibilityRecorder,
  atlasRecorder,
  canvasHistory,
  cameraHistory,
  atlas,
  tileSet,
  list
};
const char* kindName(Kind kind);

constexpr uint32_t kWornSlots = 1024; ///< that wait before they begin anew: 64 KiB of a context

class Object;
struct alignas(64) Slot {
  static constexpr uint64_t kMagic = 0x67706770'736c6f74; // "gpgpslot"
  uint64_t magic = kMagic;
  Object* object = nullptr; // null: free
  Context* context = nullptr;
  uint32_t generation = 0;
  Slot* nextFree = nullptr;
};

/// A label of at most 63 bytes, copied, so that recording never allocates for it.
struct Label {
  char text[64] = {};
  explicit Label(const char* source) { std::snprintf(text, sizeof text, "%s", source ? source : ""); }
};

class Object {
public:
  Object(Context& owner, Kind objectKind, const char* name) : context(owner), kind(objectKind), label(name) {}
  virtual ~Object() = default;
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;
  /// Called when the object has its handle, with the context's objects locked.
  virtual void attach() {}
  /// Called when the handle is destroyed and frames may still use the object: no new work may find it.
  virtual void retire() {}
  /// What messages call the object.
  const char* name() const { return label.text[0] ? label.text : kindName(kind); }

  Context& context;
  const Kind kind;
  const Label label;
  Slot* handle = nullptr;

  // owned by Context
  PmrDelete deleter;
  size_t livingIndex = 0; // in the context's list
  Object* next = nullptr; // graveyard list
  uint64_t destroyedInFrame = 0;
};

} // namespace gpgp::core
