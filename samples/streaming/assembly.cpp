#include "assembly.h"

#include <algorithm>

namespace streaming {

void FrameAssembly::drop(std::map<uint32_t, Frame>::iterator frame) {
  heldBytes_ -= frame->second.bytes.size();
  frames_.erase(frame);
}

bool FrameAssembly::add(const Part& part, double now) {
  if (lastProgress_ < 0) lastProgress_ = now;
  if (part.frame < next_) {
    ++duplicates_;
    return true;
  }
  if (part.frame - next_ > 4096) return false; // no server is that far ahead of what it was asked for
  auto found = frames_.find(part.frame);
  if (found == frames_.end()) {
    // The oldest go first: a key frame comes in place of them.
    while (!frames_.empty() && (frames_.size() >= kMaxFrames || heldBytes_ + part.bytes > kMaxHeldBytes))
      drop(frames_.begin());
    found = frames_.try_emplace(part.frame).first;
    found->second.bytes.resize(part.bytes);
    found->second.there.resize(part.count);
    heldBytes_ += part.bytes;
  }
  Frame& frame = found->second;
  if (frame.bytes.size() != part.bytes) return false;
  if (frame.there[part.index]) {
    ++duplicates_;
    return true;
  }
  std::copy(part.data.begin(), part.data.end(),
            frame.bytes.begin() + static_cast<std::ptrdiff_t>(size_t{part.index} * kPartBytes));
  frame.there[part.index] = true;
  ++frame.count;
  frame.lastPart = now;
  if (part.frame >= newest_) {
    newest_ = part.frame;
    newestTime_ = now;
  }
  return true;
}

std::optional<Bytes> FrameAssembly::take() {
  auto found = broken_ ? frames_.end() : frames_.find(next_);
  if (found == frames_.end() || !found->second.isWhole())
    found = std::find_if(frames_.begin(), frames_.end(),
                         [](const auto& frame) { return frame.second.isWhole() && isKeyFrame(frame.second.bytes); });
  if (found == frames_.end()) return {};
  Bytes bytes = std::move(found->second.bytes);
  heldBytes_ -= bytes.size();
  next_ = found->first + 1;
  frames_.erase(frames_.begin(), std::next(found));
  heldBytes_ = 0;
  for (const auto& frame : frames_) heldBytes_ += frame.second.bytes.size();
  broken_ = false;
  lastProgress_ = -1;
  return bytes;
}

std::vector<Missing> FrameAssembly::missing(double now, double roundTrip) {
  constexpr double kReordering = 0.015; // seconds that datagrams may overtake each other by
  std::vector<Missing> requests;
  const uint32_t first = next_;
  for (uint32_t number = first; !frames_.empty() && number <= newest_ && number - first < kMaxFrames; ++number) {
    auto found = frames_.find(number);
    if (found == frames_.end()) {
      if (broken_) continue; // it may be no key frame: isStuck asks for one
      if (newest_ == number || now - newestTime_ < kReordering) continue;
      if (now - wholeRequest_[number % kMaxFrames] < roundTrip) continue;
      wholeRequest_[number % kMaxFrames] = now;
      requests.push_back({number, {}});
      ++requested_;
      continue;
    }
    Frame& frame = found->second;
    if (frame.isWhole() || now - frame.lastPart < kReordering || now - frame.lastRequest < roundTrip) continue;
    Missing request{number, {}};
    for (size_t i = 0; i < frame.there.size() && request.parts.size() < kMaxNumbersInMissing; ++i)
      if (!frame.there[i]) request.parts.push_back(static_cast<uint16_t>(i));
    frame.lastRequest = now;
    requested_ += request.parts.size();
    requests.push_back(std::move(request));
  }
  return requests;
}

bool FrameAssembly::isStuck(double now, double patience) {
  if (lastProgress_ < 0 || now - lastProgress_ < patience) return false;
  lastProgress_ = now;
  return true;
}

void FrameStore::add(uint32_t number, Bytes frame) {
  bytes_ += frame.size();
  frames_.emplace_back(number, std::move(frame));
  while (frames_.size() > kMaxFrames || (bytes_ > kMaxBytes && frames_.size() > 1)) {
    bytes_ -= frames_.front().second.size();
    frames_.pop_front();
  }
}

std::vector<Bytes> FrameStore::answer(const Missing& missing) const {
  std::vector<Bytes> messages;
  const auto found =
      std::find_if(frames_.begin(), frames_.end(), [&](const auto& frame) { return frame.first == missing.frame; });
  if (found == frames_.end()) return messages;
  const uint32_t count = partCount(found->second.size());
  if (missing.parts.empty())
    for (uint32_t i = 0; i < count; ++i) messages.push_back(write(partOf(found->second, missing.frame, i)));
  for (const uint16_t part : missing.parts)
    if (part < count) messages.push_back(write(partOf(found->second, missing.frame, part)));
  return messages;
}

} // namespace streaming
