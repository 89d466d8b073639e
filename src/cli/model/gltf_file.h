// The container of a glTF 2 file: .gltf, or .glb, whichever its first bytes say; its JSON and its buffers.
#pragma once
#include <tiny_gltf.h>

#include <filesystem>
#include <string>
#include <vector>

namespace gpgp::cli {

/// A text from a file as messages show it: a long one, such as a data URI, is cut.
std::string excerpt(const std::string& text);

/// The bytes of one of a model's images, as its file or its buffer has them. Throws std::runtime_error.
std::vector<unsigned char> imageBytes(const tinygltf::Model& gltf, int index, const std::filesystem::path& folder);

/// Reads a file but for its images, of which it says where they lie (imageBytes). Buffers hold byteLength bytes; their
/// files and data URIs may hold more (glTF 2.0, 3.6.1.1). A buffer that has no bytes of its own, as the fallback of a
/// compression may not, is empty. Throws std::runtime_error without the file's name: what is broken, of another
/// version, or needs an extension that `isRead` does not know.
tinygltf::Model readGltf(const std::filesystem::path& file, bool (*isRead)(const std::string& extension));

} // namespace gpgp::cli
