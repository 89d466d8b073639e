// Live editing of a .cga file, with its attributes: ranges, choices, colours and groups are those of its annotations.
//
// Every file derives, also those that the GPU has no operators for: lots become meshes on the CPU, on all its threads,
// in the frame in which update() finds a change. A file with errors, or one that exceeds a limit, changes nothing: the
// last good town stays, and errors() tells what is wrong and where. Imported files are followed as well.
//
// Attributes that nobody has set have the values that the file gives them, lot by lot. Arrays, and strings without
// choices, are not shown. Warnings go to standard error.
#pragma once
#include "live_file.h"

#include <gpgp/gpgp.hpp>

#include <filesystem>
#include <map>

namespace mini {

/// Triangles in world space.
struct TownMesh {
  struct Vertex {
    float position[3], normal[3], colour[3]; ///< the colour is sRGB
  };
  std::vector<Vertex> vertices;
  std::vector<uint32_t> indices;
  uint64_t hash = 0; ///< of positions and triangles
  uint32_t triangles() const { return static_cast<uint32_t>(indices.size() / 3); }
};

/// FNV-1a over positions and indices, a word at a time.
uint64_t hashOf(const GpgpCgaDerivationResult& result);

class LiveCga final : public LiveFile {
public:
  /// Of a .cga file by its name.
  static bool takes(const std::string& file) { return std::filesystem::path(file).extension() == ".cga"; }
  LiveCga(std::string file, std::vector<GpgpCgaLot> lots);

  /// Once a frame: the mesh to draw from this frame on, if it is another one.
  std::optional<TownMesh> update();

private:
  std::optional<TownMesh> derive(bool again);
  /// Of all files that the program has read.
  std::string stamp() const;
  static GpgpResult GPGP_CALL read(void* user, const char* path, void* data, size_t capacity, size_t* size);

  std::vector<GpgpCgaLot> lots_;
  std::string text_, tried_;                   ///< of the file, as it was found last; of all files
  std::map<std::string, std::string> imports_; ///< what was read, by path
  std::vector<LiveError> heard_;               ///< errors of the compilation or derivation at hand
  const GpgpFileSystem files_{this, &LiveCga::read};
  gpgp::CgaProgram program_; ///< that is shown
};

} // namespace mini
