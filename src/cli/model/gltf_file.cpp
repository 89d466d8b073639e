// tinygltf reads the JSON; the bytes around it are read here, because tinygltf accepts any container version and
// refuses resources that are longer than their buffers.
#include "cli/model/gltf_file.h"

#include "host/files.h"

#include <nlohmann/json.hpp>

#include <cctype>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace gpgp::cli {
namespace {

using Json = nlohmann::json;
using Bytes = std::vector<unsigned char>;

constexpr size_t kLongestExcerpt = 80, kLongestPath = 4096;
constexpr int kDeepestJson = 200; // readers of JSON call themselves

[[noreturn]] void fail(const std::string& what) { throw std::runtime_error(what); }

struct Container {
  std::string json;
  Bytes binary; ///< of a .glb
  bool hasBinary = false;
};

/// The chunks of a .glb (glTF 2.0, 4.4); the JSON alone is a .gltf.
Container chunksOf(const Bytes& bytes) {
  if (bytes.size() < 4 || std::memcmp(bytes.data(), "glTF", 4) != 0) return {{bytes.begin(), bytes.end()}, {}};
  const auto word = [&](size_t at) {
    return uint32_t{bytes[at]} | uint32_t{bytes[at + 1]} << 8 | uint32_t{bytes[at + 2]} << 16 |
           uint32_t{bytes[at + 3]} << 24;
  };
  if (bytes.size() < 12) fail("ends within the header of a binary glTF");
  if (word(4) != 2) fail("is a binary glTF of container version " + std::to_string(word(4)) + ", not 2");
  const size_t length = word(8);
  if (length > bytes.size())
    fail("has " + std::to_string(bytes.size()) + " bytes, but its header says " + std::to_string(length));
  Container container;
  size_t number = 0;
  for (size_t at = 12; at < length; ++number) {
    const std::string name = "chunk " + std::to_string(number);
    if (length - at < 8) fail(name + " has no whole header");
    const size_t size = word(at);
    const uint32_t type = word(at + 4);
    if (size % 4) fail(name + " has " + std::to_string(size) + " bytes, which is not a multiple of 4");
    if (size > length - at - 8)
      fail(name + " says that it has " + std::to_string(size) + " bytes, of which the file holds " +
           std::to_string(length - at - 8));
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at + 8);
    const auto end = begin + static_cast<std::ptrdiff_t>(size);
    if ((number == 0) != (type == 0x4e4f534a)) fail("its first chunk, and no other, has to be JSON");
    if (number == 0)
      container.json.assign(begin, end);
    else if (number == 1 && type == 0x004e4942) // others are to be passed over
      container.binary.assign(begin, end), container.hasBinary = true;
    at += 8 + size;
  }
  if (number == 0) fail("has no chunk of JSON");
  return container;
}

/// The bytes of a data URI (RFC 2397), in base64 as glTF has it; at most `most` of them.
Bytes decoded(const std::string& uri, size_t most) {
  const size_t comma = uri.find(',');
  constexpr std::string_view kBase64 = ";base64";
  if (comma == std::string::npos || comma < kBase64.size() ||
      uri.compare(comma - kBase64.size(), kBase64.size(), kBase64) != 0)
    fail("has a data URI that is not in base64: '" + excerpt(uri) + "'");
  Bytes bytes;
  uint32_t bits = 0, count = 0;
  for (size_t i = comma + 1; i < uri.size() && uri[i] != '=' && bytes.size() < most; ++i) {
    const char c = uri[i];
    const int value = c >= 'A' && c <= 'Z'   ? c - 'A'
                      : c >= 'a' && c <= 'z' ? c - 'a' + 26
                      : c >= '0' && c <= '9' ? c - '0' + 52
                      : c == '+'             ? 62
                      : c == '/'             ? 63
                                             : -1;
    if (value < 0) fail("has a data URI with a character that base64 has not, at " + std::to_string(i - comma));
    bits = bits << 6 | static_cast<uint32_t>(value);
    if (count += 6; count >= 8) bytes.push_back(static_cast<unsigned char>(bits >> (count -= 8)));
  }
  return bytes;
}

/// A relative URI as a path: %20 is a blank.
std::string pathOf(const std::string& uri) {
  std::string path;
  const auto digit = [](char c) { return c >= '0' && c <= '9' ? c - '0' : (c | 32) - 'a' + 10; };
  for (size_t i = 0; i < uri.size(); ++i)
    if (uri[i] == '%' && i + 2 < uri.size() && std::isxdigit(static_cast<unsigned char>(uri[i + 1])) &&
        std::isxdigit(static_cast<unsigned char>(uri[i + 2])))
      path += static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2])), i += 2;
    else
      path += uri[i];
  return path;
}

Bytes bytesOf(const Json& buffer, size_t index, Container& container, const std::filesystem::path& folder) {
  const auto length = buffer.at("byteLength").get<uint64_t>();
  Bytes bytes;
  const bool stored = !buffer.contains("uri");
  if (stored && index == 0 && container.hasBinary) {
    bytes = std::move(container.binary);
  } else if (!stored) {
    const auto uri = buffer["uri"].get<std::string>();
    if (uri.rfind("data:", 0) == 0)
      bytes = decoded(uri, length);
    else if (uri.find("://") != std::string::npos || uri.size() > kLongestPath)
      fail("lies at '" + excerpt(uri) + "', which is not a file beside the model");
    else
      bytes = host::readFile(folder / pathOf(uri));
  } else { // of a compression, which may leave it empty
    return bytes;
  }
  if (bytes.size() < length)
    fail("has " + std::to_string(bytes.size()) + " bytes of " + std::to_string(length) + " that it should have");
  bytes.resize(length);
  return bytes;
}

/// What nlohmann-json says of a broken text is cut.
Json parsed(const std::string& text) {
  try {
    return Json::parse(text, [](int depth, Json::parse_event_t, Json&) {
      if (depth > kDeepestJson) fail("its JSON is nested deeper than " + std::to_string(kDeepestJson));
      return true;
    });
  } catch (const Json::exception& problem) {
    fail("is not a glTF file: " + excerpt(problem.what()));
  }
}

/// "2.1" as 2001; -1: no version.
int versionOf(const std::string& text) {
  int major = 0, minor = 0;
  char rest = 0;
  return std::sscanf(text.c_str(), "%3d.%3d%c", &major, &minor, &rest) == 2 ? major * 1000 + minor : -1;
}

void checkVersion(const Json& json) {
  const Json none = Json::object();
  const Json& asset = json.is_object() && json.contains("asset") ? json["asset"] : none;
  const auto text = [&](const char* name) {
    return asset.is_object() && asset.contains(name) && asset[name].is_string() ? asset[name].get<std::string>() : "";
  };
  const std::string version = text("version"), least = text("minVersion");
  if (version.empty()) fail("does not say which version of glTF it is");
  if (versionOf(version) / 1000 != 2) fail("is of glTF version '" + excerpt(version) + "', not 2");
  if (!least.empty() && versionOf(least) != 2000)
    fail("asks for glTF version '" + excerpt(least) + "' at least; 2.0 is read");
}

void checkExtensions(const Json& json, bool (*isRead)(const std::string& extension)) {
  if (!json.contains("extensionsRequired")) return;
  for (const auto& extension : json["extensionsRequired"].get<std::vector<std::string>>())
    if (!isRead(extension)) fail("requires the extension " + excerpt(extension) + ", which is not supported");
}

/// Draco's bytes are not decoded; a primitive may have the same uncompressed (KHR_draco_mesh_compression, "Fallback").
void checkDraco(const Json& json) {
  constexpr const char* kDraco = "KHR_draco_mesh_compression";
  if (!json.contains("meshes")) return;
  const Json accessors = json.value("accessors", Json::array());
  const auto isEmpty = [&](const Json& primitive, const char* name) {
    const uint64_t index = primitive.contains(name) ? primitive[name].get<uint64_t>() : accessors.size();
    return index < accessors.size() && !accessors[index].contains("bufferView") && !accessors[index].contains("sparse");
  };
  for (size_t mesh = 0; mesh < json["meshes"].size(); ++mesh)
    for (const Json& primitive : json["meshes"][mesh].at("primitives"))
      if (primitive.contains("extensions") && primitive["extensions"].contains(kDraco) &&
          (isEmpty(primitive, "indices") || isEmpty(primitive.at("attributes"), "POSITION")))
        fail("mesh " + std::to_string(mesh) + " has its triangles in " + kDraco +
             " alone, which is not supported; save it without compression");
}

} // namespace

std::string excerpt(const std::string& text) {
  return text.size() > kLongestExcerpt
             ? text.substr(0, kLongestExcerpt) + "... (" + std::to_string(text.size()) + " characters)"
             : text;
}

Bytes imageBytes(const tinygltf::Model& gltf, int index, const std::filesystem::path& folder) {
  if (index < 0 || static_cast<size_t>(index) >= gltf.images.size()) fail("a texture names no image");
  const tinygltf::Image& image = gltf.images[static_cast<size_t>(index)];
  if (image.uri.rfind("data:", 0) == 0) return decoded(image.uri, SIZE_MAX);
  if (!image.uri.empty()) {
    if (image.uri.find("://") != std::string::npos || image.uri.size() > kLongestPath)
      fail("image " + std::to_string(index) + " lies at '" + excerpt(image.uri) +
           "', which is not a file beside the model");
    return host::readFile(folder / pathOf(image.uri));
  }
  if (image.bufferView < 0 || static_cast<size_t>(image.bufferView) >= gltf.bufferViews.size())
    fail("image " + std::to_string(index) + " lies nowhere");
  const tinygltf::BufferView& view = gltf.bufferViews[static_cast<size_t>(image.bufferView)];
  const auto buffer = static_cast<size_t>(view.buffer);
  if (view.buffer < 0 || buffer >= gltf.buffers.size() || view.byteOffset > gltf.buffers[buffer].data.size() ||
      view.byteLength > gltf.buffers[buffer].data.size() - view.byteOffset)
    fail("image " + std::to_string(index) + " reaches beyond its buffer");
  const auto begin = gltf.buffers[buffer].data.begin() + static_cast<std::ptrdiff_t>(view.byteOffset);
  return {begin, begin + static_cast<std::ptrdiff_t>(view.byteLength)};
}

tinygltf::Model readGltf(const std::filesystem::path& file, bool (*isRead)(const std::string& extension)) {
  Container container = chunksOf(host::readFile(file));
  Json json = parsed(container.json);
  std::vector<Bytes> buffers;
  try {
    checkVersion(json);
    checkExtensions(json, isRead);
    checkDraco(json);
    if (json.contains("buffers"))
      for (const Json& buffer : json["buffers"]) try {
          buffers.push_back(bytesOf(buffer, buffers.size(), container, file.parent_path()));
        } catch (const std::runtime_error& problem) {
          fail("buffer " + std::to_string(buffers.size()) + " " + problem.what());
        }
  } catch (const Json::exception& problem) {
    fail("is not a glTF file: " + excerpt(problem.what()));
  }
  json.erase("buffers");
  std::vector<tinygltf::Image> images;
  if (json.contains("images") && json["images"].is_array())
    for (const Json& image : json["images"]) {
      tinygltf::Image& known = images.emplace_back();
      if (!image.is_object()) continue;
      if (image.contains("uri") && image["uri"].is_string()) known.uri = image["uri"].get<std::string>();
      if (image.contains("bufferView") && image["bufferView"].is_number_integer())
        known.bufferView = image["bufferView"].get<int>();
    }
  json.erase("images");
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  json = Json();
  tinygltf::TinyGLTF loader;
  tinygltf::Model gltf;
  std::string error, warning;
  const bool loaded = loader.LoadASCIIFromString(&gltf, &error, &warning, text.data(),
                                                 static_cast<unsigned int>(text.size()), std::string());
  gltf.images = std::move(images);
  for (Bytes& bytes : buffers) gltf.buffers.emplace_back().data = std::move(bytes);
  if (!loaded) fail(error.empty() ? "is not a glTF 2 file" : excerpt(error));
  return gltf;
}

} // namespace gpgp::cli
