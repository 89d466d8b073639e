// What a history remembers of the last recording, so that the next one draws only the tiles where anything changed.
//
// Of each thing that is placed (a drawing, a glyph, a shape, a clip) that is a hash of all that its pixels depend on,
// and its box of tiles. A tile of which all things are those of before, in the same order, shows the same picture.
// Things that are not, and those that have changed their order, damage the tiles of their boxes, old and new.
#pragma once
#include "vector/shared/layout.h"

#include <gpgp/vector.h>

#include <bit>
#include <cstring>
#include <memory_resource>
#include <span>
#include <vector>

namespace gpgp::vector {

/// A hash of values that are added one after another: numbers and structs without padding, by their bytes.
class StateHash {
public:
  StateHash& addBytes(const void* data, size_t size) {
    const auto* from = static_cast<const char*>(data);
    for (; size >= 8; from += 8, size -= 8) addWord(from, 8);
    if (size) addWord(from, size);
    return *this;
  }
  template <class T> StateHash& add(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    return addBytes(&value, sizeof value);
  }
  uint64_t value() const { // MurmurHash3's finaliser
    uint64_t h = state_;
    h = (h ^ h >> 33) * 0xff51afd7ed558ccdu;
    h = (h ^ h >> 33) * 0xc4ceb9fe1a85ec53u;
    return h ^ h >> 33;
  }

private:
  void addWord(const char* from, size_t size) {
    uint64_t word = 0;
    std::memcpy(&word, from, size);
    word = std::rotl(word * 0x87c37b91114253d5u, 31) * 0x4cf5ad432745937fu;
    state_ = std::rotl(state_ ^ word, 27) * 5 + 0x52dce729;
  }
  uint64_t state_ = 0x9e3779b97f4a7c15u;
};

struct TileBox {
  uint16_t left = 0, top = 0, right = 0, bottom = 0; ///< right and bottom exclusive
};

class KeptRecording {
public:
  /// Room for `most` things.
  KeptRecording(uint32_t most, std::pmr::memory_resource* memory);
  uint32_t most() const { return most_; }

  /// How many words the damage of so many tiles takes.
  static constexpr size_t damageWords(uint32_t tilesX, uint32_t tilesY) {
    return (size_t((tilesX + 31) / 32) * tilesY + 3) / 4 * 4;
  }
  /// A recording begins, whose things add() takes in painting order. `damage` has room for damageWords().
  void begin(uint32_t tilesX, uint32_t tilesY, std::span<uint32_t> damage);
  /// `tiles`: finds the thing's box where it is not known from before.
  template <class Tiles> void add(uint64_t hash, const Tiles& tiles) {
    if (next_.count == most_) {
      ++missed_;
      return;
    }
    const Thing* known = find(hash);
    next_.things[next_.count++] = {hash, known ? known->box : tiles()};
  }

  /// What a recording is, beside its things.
  struct Whole {
    uint64_t settings = 0; ///< size, target, background: of what lies in the picture
    uint64_t shaders = 0;  ///< which of them paint it: others may round differently
    uint64_t layers = 0;   ///< what composites it; 0: nothing
    uint32_t number = 0;   ///< of the recording, by its canvas
    bool complete = true;  ///< nothing was left out
  };
  /// Compares with the recording before. GPGP_CANVAS_REDRAW_NONE: damage() says which tiles change. `brokenSince`: the
  /// last recording that is known not to have been executed whole.
  GpgpCanvasRedraw compare(const Whole& whole, uint32_t brokenSince);
  /// The recording that began last is recorded: what comes next is compared with it.
  void commit(const Whole& whole, bool redrawn);

  uint32_t damagedTiles() const { return damaged_; }
  /// A bit for each tile, by rows of whole words, and zeros up to a multiple of four words.
  std::span<const uint32_t> damage() const { return bits_; }
  /// Whether a thing of the recording that began last meets damage.
  bool shows(uint32_t thing) const { return meets(next_.things[thing].box); }

private:
  struct Thing {
    uint64_t hash;
    TileBox box;
  };
  struct Things {
    explicit Things(uint32_t most, std::pmr::memory_resource* memory) : things(most, memory) {}
    std::pmr::vector<Thing> things;
    uint32_t count = 0;
  };
  const Thing* find(uint64_t hash);
  bool meets(const TileBox& box) const;
  void mark(const TileBox& box);
  void match(uint32_t begin, uint32_t lastEnd, uint32_t nextEnd);

  const uint32_t most_;
  Things last_, next_;
  Whole whole_;
  bool valid_ = false, fits_ = false; ///< fits_: the canvas is as large as before
  uint32_t redrawn_ = 0;              ///< number of the last recording that drew all tiles
  uint32_t cursor_ = 0, missed_ = 0;
  uint32_t tilesX_ = 0, tilesY_ = 0, lastX_ = 0, lastY_ = 0, inRow_ = 0, damaged_ = 0;
  std::span<uint32_t> bits_;
  // match()'s: a hash table of the things of before (1 + index; 0: empty), which of them a thing is, the increasing
  // runs of these, and what comes before each of a run.
  std::pmr::vector<uint32_t> cells_, matches_, runs_, before_;
};

} // namespace gpgp::vector
