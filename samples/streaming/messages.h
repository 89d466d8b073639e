// What server and client say to each other. Each message begins with its type; whatever does not have exactly the
// shape described here, or holds a number out of range, is refused: its parse function returns nothing.
#pragma once
#include "bytes.h"
#include "world.h"

#include <optional>
#include <string>

namespace streaming {

enum class MessageType : uint8_t { hello = 1, welcome, refusal, pose, part, missing, refresh };
/// Of a message, or nothing where there is no such type.
std::optional<MessageType> typeOf(ByteSpan message);

enum class Codec : uint8_t { zstd = 0, x264 = 1 };

constexpr uint32_t kVersion = 1;
constexpr uint32_t kPartBytes = 1200;          ///< so that a part is one datagram
constexpr uint32_t kMaxFrameBytes = 32u << 20; ///< of a frame's parts together
constexpr uint32_t kMaxTriangles = 1u << 25;   ///< as the atlas has it
constexpr uint32_t kMaxNumbersInMissing = 256;

/// Client to server, first of all.
struct Hello {
  uint64_t world = 0; ///< World::hash
  uint32_t width = 0, height = 0;
  float fieldOfView = 1; ///< vertical, radians
};
/// Server to client: what frames will be like, and the fallback shade.
struct Welcome {
  uint32_t atlasWidth = 0, atlasHeight = 0, triangleCount = 0;
  uint8_t gutter = 0;
  Codec codec = Codec::zstd;
  std::vector<uint32_t> drawColours; ///< RGBA8, one for each draw
};
/// Client to server, once for each displayed frame.
struct PoseMessage {
  uint32_t number = 0;
  double seconds = 0; ///< the client's clock, and the scene's
  View view;
  float earliest = 0, latest = 0.3f; ///< in seconds after the pose: between which frames were displayed of late
};
/// Server to client: a piece of a frame.
struct Part {
  uint32_t frame = 0, bytes = 0; ///< bytes: of the whole frame
  uint16_t index = 0, count = 0;
  ByteSpan data;
};
/// Client to server: parts of a frame that did not come; none named: all of them.
struct Missing {
  uint32_t frame = 0;
  std::vector<uint16_t> parts;
};

Bytes write(const Hello& message);
Bytes write(const Welcome& message);
Bytes write(const PoseMessage& message);
Bytes write(const Part& message);
Bytes write(const Missing& message);
Bytes writeRefusal(const std::string& text);
/// The client cannot go on from what it has: the next frame is to be a key frame.
Bytes writeRefresh();

std::optional<Hello> parseHello(ByteSpan message);
std::optional<Welcome> parseWelcome(ByteSpan message);
std::optional<PoseMessage> parsePose(ByteSpan message);
std::optional<Part> parsePart(ByteSpan message);
std::optional<Missing> parseMissing(ByteSpan message);
std::optional<std::string> parseRefusal(ByteSpan message);

uint32_t partCount(size_t frameBytes);
Part partOf(ByteSpan frame, uint32_t number, uint32_t index);

} // namespace streaming
