// Any bytes as a baked grammar, the checksum made right first, so that the checks behind it are reached. What loads can
// be linked.
#include "spawn/graph/blob.h"
#include "spawn/language/append_graph.h"

#include <cstdlib>
#include <cstring>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace gpgp;
  std::vector<uint32_t> words(size / 4);
  if (!words.empty()) std::memcpy(words.data(), data, words.size() * 4);
  if (words.size() > shader::kHeaderSize) {
    words[shader::kHeaderMagic] = shader::kGraphMagic;
    words[shader::kHeaderVersion] = shader::kGraphVersion;
    words[shader::kHeaderWords] = static_cast<uint32_t>(words.size());
    words[shader::kHeaderChecksum] = spawn::checksum(std::span<const uint32_t>(words).subspan(shader::kHeaderChecked));
  }
  const auto graph = spawn::load(std::as_bytes(std::span(words)), std::pmr::get_default_resource());
  if (!graph) return 0;
  if (!spawn::validate(*graph)) std::abort(); // what loads is valid
  spawn::Graph linked(std::pmr::get_default_resource());
  spawn::addRegularPolygons(linked);
  spawn::Tags tags;
  spawn::Diagnostics diagnostics;
  for (const char* name : {"a", "b"}) spawn::appendGraph(*graph, name, linked, tags, diagnostics);
  spawn::analyse(linked);
  if (linked.buckets <= shader::kMaxBuckets && !spawn::validate(linked)) std::abort();
  return 0;
}
