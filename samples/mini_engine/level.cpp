#include "level.h"

#include <cstdio>
#include <filesystem>

namespace mini {

Model levelModel(const std::string& dataFolder) {
  const std::string file = dataFolder + "/fetched/models/2CylinderEngine.glb";
  Model model;
  if (std::error_code ignored; std::filesystem::exists(file, ignored)) {
    model = loadGltf(file);
  } else {
    std::fprintf(stderr, "mini_engine: %s is not there (tests/data/fetch.sh fetches it); using a model made here\n",
                 file.c_str());
    model = makeFallbackModel();
  }
  model.place(54.0f, 0.2f); // metres
  return model;
}

} // namespace mini
