// Wavefront OBJ: vertices and faces (polygons as fans); everything else in the file is of no use here and passed over.
//
// Not by tinyobjloader: it reads a number that is none as 0, checks indices after the whole file, negative ones not at
// all, and knows no lines that go on. What is wrong in a file is to be said with its line.
#include "cli/model_formats.h"
#include "host/files.h"

#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

namespace gpgp::cli {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, size_t line, const char* what) {
  throw std::runtime_error(file.string() + ":" + std::to_string(line) + ": " + what);
}

const char* skipBlanks(const char* at) {
  while (*at == ' ' || *at == '\t') ++at;
  return at;
}

} // namespace

Model loadObj(const std::filesystem::path& file) {
  const std::string text = host::readText(file);
  Model model;
  size_t lineNumber = 0;
  for (size_t begin = 0, lines = 0; begin < text.size();) {
    lineNumber = lines + 1; // where it begins
    std::string line;       // ends in 0, so that the number readers stop there
    for (bool goesOn = true; goesOn && begin < text.size(); ++lines) {
      const size_t end = std::min(text.find('\n', begin), text.size());
      line.append(text, begin, end - begin);
      begin = end + 1;
      if (!line.empty() && line.back() == '\r') line.pop_back();
      goesOn = !line.empty() && line.back() == '\\';
      if (goesOn) line.back() = ' ';
    }
    const char* at = skipBlanks(line.c_str());
    char* next = nullptr;
    if (at[0] == 'v' && (at[1] == ' ' || at[1] == '\t')) {
      ++at;
      for (int axis = 0; axis < 3; ++axis, at = next) {
        const float value = std::strtof(at, &next);
        if (next == at || !std::isfinite(value)) fail(file, lineNumber, "a vertex needs three numbers");
        model.positions.push_back(value);
      }
    } else if (at[0] == 'f' && (at[1] == ' ' || at[1] == '\t')) {
      std::vector<uint32_t> corners;
      const auto vertexCount = static_cast<long long>(model.positions.size() / 3);
      for (at = skipBlanks(at + 1); *at && *at != '#'; at = skipBlanks(next)) {
        const long long number = std::strtoll(at, &next, 10);
        const long long index = number < 0 ? vertexCount + number : number - 1;
        if (next == at || index < 0 || index >= vertexCount) fail(file, lineNumber, "a face names no vertex above it");
        corners.push_back(static_cast<uint32_t>(index));
        while (*next && *next != ' ' && *next != '\t') ++next; // texture and normal indices
      }
      if (corners.size() < 3) fail(file, lineNumber, "a face needs three vertices");
      for (size_t i = 1; i + 1 < corners.size(); ++i)
        model.indices.insert(model.indices.end(), {corners[0], corners[i], corners[i + 1]});
    }
  }
  addDraw(model, {0, static_cast<uint32_t>(model.indices.size()), 0}, kIdentityRows);
  return model;
}

} // namespace gpgp::cli
