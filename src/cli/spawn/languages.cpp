#include "cli/spawn/languages.h"

#include "cli/spawn/axioms.h"
#include "cli/spawn/cga.h"
#include "cli/spawn/lsystem.h"

#include <algorithm>
#include <span>

namespace gpgp::cli {
namespace {

using Names = std::span<const char* const>;

constexpr const char* kOfAll[] = {"--axioms", "--axiom-file", "--axiom-size", "--spacing", "--seed", "--repeat",
                                  "--image",  "--yaw",        "--pitch",      "--zoom",    "--out",  "--image-size",
                                  "--device", "--json",       "--validate",   "--help"};
constexpr const char* kOfCga[] = {"--attr",         "--attributes",   "--field",     "--style",      "--geographic",
                                  "--start",        "--schedule",     "--max-depth", "--max-shapes", "--max-faces",
                                  "--max-vertices", "--max-geometry", "--max-work"};
constexpr const char* kOfLsystems[] = {"--set",           "--interval",  "--string",    "--max-modules",
                                       "--max-instances", "--out-nodes", "--instanced", "--start"};
/// Of both languages, what grammars do not have.
constexpr const char* kNotOfGrammars[] = {"--attr",      "--attributes",   "--style",        "--geographic",
                                          "--max-faces", "--max-vertices", "--max-geometry", "--max-work",
                                          "--string",    "--max-modules"};

bool isAmong(const std::string& name, Names names) {
  return std::any_of(names.begin(), names.end(), [&](const char* known) { return name == known; });
}

/// The first option that was given and is not among these.
void expectAmong(const SpawnOptions& options, Names names, const std::string& what) {
  for (const std::string& name : options.given)
    if (name.starts_with("--") && !isAmong(name, kOfAll) && !isAmong(name, names))
      throw Usage(name + " means nothing to " + what);
}

} // namespace

void expectOfGrammars(const SpawnOptions& options) {
  for (const std::string& name : options.given)
    if (isAmong(name, kNotOfGrammars))
      throw Usage(name + " is for " + (isAmong(name, kOfCga) ? ".cga files" : "L-systems (.lsys)"));
}

Outcome spawnCgaFile(const SpawnOptions& options, const CommonOptions& common) {
  if (options.grammars.size() > 1) throw Usage("a .cga file is derived alone; it imports others itself");
  if (!options.set.empty()) throw Usage("attributes of .cga files are set by --attr NAME=VALUE, not by --set");
  const char* const derives = "a .cga file; `gpgp bake` makes a grammar of it, which takes all options of grammars";
  expectAmong(options, kOfCga, derives);
  if (options.schedule != "default" && options.schedule != "interpreter")
    throw Usage("--schedule " + options.schedule + " means nothing to " + derives);
  CgaOptions cga;
  cga.file = options.grammars[0];
  cga.start = options.start;
  cga.style = options.style;
  cga.attributes = options.attributes;
  cga.listsAttributes = options.listsAttributes;
  cga.fields = options.fields;
  cga.axioms = options.axioms;
  cga.seed = options.seed;
  if (options.hasSize) cga.size = options.size;
  cga.spacing = options.spacing;
  cga.axiomFile = options.axiomFile;
  cga.geographic = options.geographic;
  cga.image = options.image;
  cga.out = options.out;
  cga.view = {options.imageSize, options.yaw, options.pitch, options.zoom, 0.003f};
  cga.maxDepth = options.maxDepth;
  cga.maxShapes = options.maxShapes;
  cga.maxFaces = options.maxFaces;
  cga.maxVertices = options.maxVertices;
  cga.maxGeometry = options.maxGeometry;
  cga.maxWork = options.maxWork;
  cga.repeat = options.repeat;
  cga.schedule = options.schedule;
  return spawnCga(cga, common);
}

Outcome spawnLsystemFile(const SpawnOptions& options, const CommonOptions& common) {
  if (options.grammars.size() > 1) throw Usage("an L-system (.lsys) is derived alone; it cannot be linked");
  expectAmong(options, kOfLsystems, "an L-system (.lsys)");
  const AxiomDefaults defaults{
      {options.size[0], 0, options.size[2]}, options.seed, {GPGP_AXIOM_DEFAULT_START}, options.interval};
  LsystemOptions own;
  own.file = options.grammars[0];
  own.start = options.start;
  own.set = options.set;
  own.axioms = options.axiomFile.empty() ? axiomGrid(std::max(options.axioms, 1u), options.spacing, defaults)
                                         : readAxioms(options.axiomFile, {}, defaults);
  own.repeat = options.repeat;
  own.maxInstances = options.maxInstances;
  own.maxModules = options.maxModules;
  own.string = options.string;
  own.image = options.image;
  own.out = options.out;
  own.imageSize = options.imageSize;
  own.yaw = options.yaw;
  own.pitch = options.pitch;
  own.zoom = options.zoom;
  own.instances = glbInstances(options);
  return spawnLsystem(own, common);
}

} // namespace gpgp::cli
