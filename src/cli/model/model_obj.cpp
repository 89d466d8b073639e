// Wavefront OBJ: vertices and faces; everything else in the file is of no use here and passed over.
//
// Not by tinyobjloader: it reads a number that is none as 0, checks indices after the whole file, negative ones not at
// all, and knows no lines that go on. What is wrong in a file is to be said with its line.
#include "cli/model/ear_clipping.h"
#include "cli/model/model_formats.h"
#include "host/files.h"

#include <glm/vec3.hpp>

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

bool isEndOfWord(char c) { return c == 0 || c == ' ' || c == '\t' || c == '#'; }

/// Reads the texture's and the normal's number of a face's corner, which may be missing, and moves to the word's end;
/// false: something else is there.
bool skipOtherNumbers(char*& at) {
  for (int i = 0; i < 2 && *at == '/'; ++i)
    if (++at; *at == '-' || (*at >= '0' && *at <= '9')) std::strtoll(at, &at, 10);
  return isEndOfWord(*at);
}

} // namespace

void loadObj(const std::filesystem::path& file, Model& model) {
  const std::string text = host::readText(file);
  size_t lineNumber = 0;
  for (size_t begin = text.rfind("\xef\xbb\xbf", 0) == 0 ? 3 : 0, lines = 0; begin < text.size();) {
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
        const float value = static_cast<float>(std::strtod(at, &next) - model.origin[axis]);
        if (next == at || !isEndOfWord(*next) || !std::isfinite(value))
          fail(file, lineNumber, "a vertex needs three numbers");
        model.positions.push_back(value);
      }
    } else if (at[0] == 'f' && (at[1] == ' ' || at[1] == '\t')) {
      std::vector<uint32_t> corners;
      const auto vertexCount = static_cast<long long>(model.positions.size() / 3);
      for (at = skipBlanks(at + 1); *at && *at != '#'; at = skipBlanks(next)) {
        const long long number = std::strtoll(at, &next, 10);
        const long long index = number < 0 ? vertexCount + number : number - 1;
        const bool isNumber = next != at && skipOtherNumbers(next);
        if (!isNumber || index < 0 || index >= vertexCount) fail(file, lineNumber, "a face names no vertex above it");
        corners.push_back(static_cast<uint32_t>(index));
      }
      if (corners.size() < 3) fail(file, lineNumber, "a face needs three vertices");
      std::vector<glm::dvec3> outline;
      for (const uint32_t corner : corners) {
        const float* p = &model.positions[size_t{corner} * 3];
        outline.emplace_back(p[0], p[1], p[2]);
      }
      for (const size_t corner : clipEars(outline)) model.indices.push_back(corners[corner]);
    }
  }
  addDraw(model, addMesh(model, {0, static_cast<uint32_t>(model.indices.size()), 0}), kIdentityRows);
}

} // namespace gpgp::cli
