// The files that an SVG refers to: those in its folder or below.
#pragma once
#include <gpgp/vector.h>

#include <string>

namespace gpgp::cli {

class SvgFiles {
public:
  /// Of an SVG that is read from this file, or from standard input, which has no folder.
  explicit SvgFiles(const std::string& file);
  SvgFiles(const SvgFiles&) = delete; // the source refers to it
  SvgFiles& operator=(const SvgFiles&) = delete;
  /// NULL for standard input.
  const GpgpFileSystem* fileSystem() const { return folder_.empty() ? nullptr : &fileSystem_; }

private:
  static GpgpResult GPGP_CALL read(void* userData, const char* path, void* data, size_t capacity, size_t* size);
  std::string folder_;
  GpgpFileSystem fileSystem_;
};

} // namespace gpgp::cli
