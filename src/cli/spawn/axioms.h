// Axioms for `gpgp spawn`: a grid, or a file in CSV or JSON. Each stands on a place: its start shape's middle is half
// its height above that. Only a whole transform says where the middle is.
#pragma once
#include <gpgp/spawn.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace gpgp::cli {

/// What an axiom is where a file does not say.
struct AxiomDefaults {
  std::array<float, 3> size{1, 1, 1};
  uint32_t seed = 1;                                      ///< axiom i has seed + i
  std::vector<uint32_t> starts{GPGP_AXIOM_DEFAULT_START}; ///< a grid's axioms take them in turn
  float interval = 0;                                     ///< along lines of GeoJSON; 0: the size along X
};

/// A place that a derivation can start at, as a file names it.
struct NamedStart {
  std::string name, shape;
};

/// Standing at a place, turned about Y by degrees.
GpgpAxiom axiomAt(const std::array<float, 3>& place, float degrees, const std::array<float, 3>& size, uint32_t seed,
                  uint32_t id);

/// A square grid in the ground plane around the origin, row by row; spacing 0: 1.5 times the axioms' width.
std::vector<GpgpAxiom> axiomGrid(uint32_t count, float spacing, const AxiomDefaults& defaults);

/// GeoJSON, an object with a type: its points become axioms, and its lines become some at intervals, turned so that X
/// runs along the line. Coordinates are metres east and north, and a height. Else: a file whose first character is [ or
/// { is JSON, an array of objects with position [x, y, z], rotation (degrees) or quaternion [x, y, z, w], or transform
/// (the 12 numbers of a 3x4 matrix, row by row, from the object to the world) in place of these; size [x, y, z], seed,
/// rule, shape, attribute. Anything else is CSV: a first line that names the columns x y z rotation qx qy qz qw m00 m01
/// m02 m03 m10 ... m23 size_x size_y size_z seed rule shape attribute; # begins a comment. x and z are needed, or all
/// of m00 to m23. With a transform an axiom does not stand on its place: that is its middle. rule is the first of the
/// grammar's starts by that name, or with that shape. All errors are printed as FILE:LINE:COLUMN with what was
/// expected; then it throws Failure with the first.
std::vector<GpgpAxiom> readAxioms(const std::filesystem::path& file, const std::vector<NamedStart>& starts,
                                  const AxiomDefaults& defaults);

} // namespace gpgp::cli
