// Frames from parts that come late, twice, out of order or not at all. Frames follow from each other, so they are given
// out in order; where one is lost for good, a key frame begins anew. All memory is bounded.
#pragma once
#include "messages.h"

#include <array>
#include <deque>
#include <map>

namespace streaming {

/// The client's side.
class FrameAssembly {
public:
  /// False: the part contradicts an earlier one of its frame, and is refused.
  bool add(const Part& part, double now);
  /// The next frame in order that is whole, or the first whole one of a new beginning (isKey); nothing: none is yet.
  std::optional<Bytes> take();
  /// What to ask for again. roundTrip: seconds, after which an answer should be there.
  std::vector<Missing> missing(double now, double roundTrip);
  /// Nothing has come out for `patience` seconds although later frames are there: ask for a key frame. True once in
  /// each `patience`.
  bool isStuck(double now, double patience);
  /// What was taken cannot be used: only a key frame helps.
  void waitForKey() { broken_ = true; }

  uint64_t requestedParts() const { return requested_; }
  uint64_t duplicates() const { return duplicates_; }
  size_t heldBytes() const { return heldBytes_; }
  static constexpr size_t kMaxFrames = 64, kMaxHeldBytes = 64u << 20;

private:
  struct Frame {
    Bytes bytes;
    std::vector<bool> there;
    uint32_t count = 0;
    double lastPart = 0, lastRequest = -1e9;
    bool isWhole() const { return count == there.size(); }
  };
  void drop(std::map<uint32_t, Frame>::iterator frame);
  std::map<uint32_t, Frame> frames_; // by number, none before next_
  uint32_t next_ = 0, newest_ = 0;
  bool broken_ = true; // no key frame yet
  size_t heldBytes_ = 0;
  double lastProgress_ = -1, newestTime_ = 0;
  std::array<double, 64> wholeRequest_{}; // when a frame of which nothing came was asked for
  uint64_t requested_ = 0, duplicates_ = 0;
};

/// The server's side: frames that were sent lately.
class FrameStore {
public:
  void add(uint32_t number, Bytes frame);
  /// Parts of the request that are still there, as messages.
  std::vector<Bytes> answer(const Missing& missing) const;
  static constexpr size_t kMaxFrames = 64, kMaxBytes = 32u << 20;

private:
  std::deque<std::pair<uint32_t, Bytes>> frames_;
  size_t bytes_ = 0;
};

/// Whether a frame's bytes begin a new sequence (frame_format.h).
bool isKeyFrame(ByteSpan frame);

} // namespace streaming
