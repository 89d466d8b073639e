#include "cli/spawn/options.h"

#include "cli/spawn/axioms.h"
#include "cli/spawn/fields.h"
#include "cli/spawn/grammar_source.h"
#include "cli/tune/kernels.h"

namespace gpgp::cli {

GlbInstances glbInstances(const SpawnOptions& options) {
  return options.instanced ? GlbInstances::instanced : options.nodes ? GlbInstances::nodes : GlbInstances::triangles;
}

void addSpawnOptions(CLI::App& command, SpawnOptions& options) {
  addGrammars(command, options.grammars);
  CLI::Option* axioms =
      command
          .add_option("--axioms", options.axioms,
                      "Start shapes, on a square grid; linked grammars take turns (default: one of each)")
          ->check(CLI::Range(1u, 10000000u));
  command
      .add_option(
          "--axiom-file", options.axiomFile,
          "Start shapes from a file, CSV or JSON: position, rotation about Y or quaternion, or a whole transform; "
          "size, seed, rule, shape, attribute. Or GeoJSON: points, and lines with start shapes at intervals")
      ->check(CLI::ExistingFile)
      ->excludes(axioms);
  command
      .add_option("--interval", options.interval,
                  "Metres between start shapes along lines of GeoJSON (default: their size along X)")
      ->needs("--axiom-file")
      ->check(within(1e-3, 1e9));
  CLI::Option* scatter = command
                             .add_option("--scatter", options.scatter.distance,
                                         "Start shapes at points that are METRES apart at least (a Poisson-disk "
                                         "pattern), over --area around the origin")
                             ->type_name("METRES")
                             ->excludes("--axiom-file")
                             ->excludes(axioms)
                             ->check(within(1e-3, 1e6));
  command.add_option("--area", options.scatter.area, "Metres along X and Z (default 100,100)")
      ->needs(scatter)
      ->delimiter(',')
      ->type_name("X,Z")
      ->check(within(1e-3, 1e7));
  command
      .add_option("--density", options.scatter.density, "A picture over the area: black none of the points, white all")
      ->needs(scatter)
      ->check(CLI::ExistingFile)
      ->type_name("FILE.png");
  CLI::Option* terrain =
      command.add_option("--terrain", options.scatter.terrain, "Another one: how high the ground is, black 0")
          ->needs(scatter)
          ->check(CLI::ExistingFile)
          ->type_name("FILE.png");
  command.add_option("--terrain-height", options.scatter.terrainHeight, "Metres that white is high")
      ->needs(terrain)
      ->check(within(-1e5, 1e5))
      ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--axiom-size",
          [o = &options](const std::string& t) {
            o->size = parseTriple(t);
            o->hasSize = true;
          },
          "Extents of each start shape in metres (default 1,1,1; of .cga files rectangles X by Z, default 20,1,20)")
      ->type_name("X,Y,Z");
  command.add_option("--spacing", options.spacing, "Distance of the axioms in metres (default: 1.5 times their width)")
      ->excludes("--axiom-file")
      ->excludes(scatter)
      ->check(within(1e-6, 1e9));
  command.add_option("--seed", options.seed, "Random seed; axiom i has seed S + i")->capture_default_str();
  addVariables(command, options.set);
  command
      .add_option(
          "--start", options.start,
          "The rule to start at (default: the first axiom's; of a .cga file @StartRule's, else the first); of an "
          "L-system's file with several, its name")
      ->type_name("RULE");
  command.add_option("--attr", options.attributes, "Set an attr of a .cga file; may be repeated")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  command.add_flag(
      "--attributes", options.listsAttributes,
      "List the attributes of a .cga file with their values, ranges, choices and groups, and derive nothing");
  command.add_option("--style", options.style, "A style of the .cga file")->type_name("NAME");
  command.add_flag("--geographic", options.geographic, "Coordinates of a GeoJSON --axiom-file are longitude, latitude");
  command
      .add_option("--measure", options.measures,
                  "Sum up over the terminals of a name, or over all, for each axiom (in --json): the product of "
                  "FACTORS, letters of x y z (the sizes) and a (the attribute), or count; up to four")
      ->type_name("TERMINAL:FACTORS")
      ->allow_extra_args(false);
  addFields(command, options.fields);
  command.add_option("--repeat", options.repeat, "Derive N times, after 0.1 s to warm up, and report the median time")
      ->check(CLI::Range(1u, 100000u))
      ->capture_default_str();
  command
      .add_option("--schedule", options.schedule,
                  "How the derivation runs. sgl: as few execution groups as possible (with colliders: as few as a "
                  "bounded search finds); rw: one per operator; rules: one per rule; heuristic: the thesis's H1 to H3; "
                  "default: few groups, except where one SubDiv follows another "
                  "(execution_groups: of the partition with dynamic edges there); interpreter: "
                  "no kernel is compiled; tuned: the fastest that `gpgp tune` found for this grammar, this device and "
                  "a similar number of axioms; it is tuned first if nothing is stored yet (in $XDG_CACHE_HOME/gpgp or "
                  "~/.cache/gpgp); "
                  "FILE: a baked grammar with kernels, or groups as `gpgp graph` prints them")
      ->type_name("NAME|FILE")
      ->capture_default_str();
  addQueues(command, options.queues, "");
  addGroupSize(command, options.heuristics);
  command
      .add_option("--matching", options.matching,
                  "Execution groups that differ only in parameters share their code; not for baked kernels, nor for "
                  "the default, which is not a partition")
      ->check(CLI::IsMember({"on", "off"}))
      ->capture_default_str();
  command
      .add_option("--output", options.output,
                  "What the GPU writes. instances: 96 bytes for each terminal. vertices: 32 bytes each, position "
                  "float x 3, normal snorm8 x 4, uv float x 2, terminal and axiom id uint32; and 32-bit indices")
      ->check(CLI::IsMember({"instances", "vertices"}))
      ->capture_default_str();
  command.add_flag("--sorted", options.sorted, "Sort the instances by bucket, with a draw command for each bucket");
  CLI::Option* image = command.add_option("--image", options.image, "Write a picture of the result")
                           ->check(pngFile())
                           ->type_name("FILE.png");
  CLI::Option* yaw = command.add_option("--yaw", options.yaw, "Camera of that picture: degrees around the scene")
                         ->needs(image)
                         ->check(within(-36000.0, 36000.0))
                         ->capture_default_str();
  CLI::Option* pitch = command.add_option("--pitch", options.pitch, "Degrees above the horizon")
                           ->needs(image)
                           ->check(within(-89.0, 89.0))
                           ->capture_default_str();
  CLI::Option* zoom =
      command.add_option("--zoom", options.zoom, "How many times closer than a view of the whole scene")
          ->needs(image)
          ->check(within(0.01, 1000.0))
          ->capture_default_str();
  CLI::Option* camera =
      command
          .add_option("--camera", options.camera,
                      "A camera at the first X,Y,Z that looks at the second, for CameraDistance(), ScreenSize() and "
                      "OutOfView(); --image shows its view, which has the size of --image-size")
          ->delimiter(',')
          ->type_name("X,Y,Z,X,Y,Z")
          ->excludes(yaw)
          ->excludes(pitch)
          ->excludes(zoom)
          ->each([o = &options](const std::string&) { o->hasCamera = true; });
  command.add_option("--fov", options.fov, "The camera's vertical field of view, degrees")
      ->needs(camera)
      ->check(within(1, 170))
      ->capture_default_str();
  CLI::Option* detail = command
                            .add_option("--detail", options.detail,
                                        "Times ScreenSize() of that camera: less than 1 is coarser, more is finer")
                            ->needs(camera)
                            ->check(within(1e-6, 1e6))
                            ->capture_default_str();
  command
      .add_option("--budget", options.budget,
                  "Terminals at most: finds the --detail, at most 1, with which what the camera sees stays within them")
      ->needs(camera)
      ->excludes(detail)
      ->type_name("TERMINALS")
      ->check(CLI::Range(1u, 1u << 30));
  command
      .add_option("--changed", options.changed,
                  "Also derive PERCENT of the axioms again with other seeds, in place; reports the time, and checks "
                  "that all other instances are unchanged")
      ->type_name("PERCENT")
      ->check(within(1e-6, 100));
  CLI::Option* out = command
                         .add_option("--out", options.out,
                                     "Write the result as glTF: a node and mesh for each terminal, with normals, "
                                     "texture coordinates and its colour")
                         ->check(glbFile())
                         ->type_name("FILE.glb");
  command
      .add_flag(
          "--out-nodes", options.nodes,
          "In that file, a node for each instance that a node can place, below its terminal's; nodes share meshes")
      ->needs(out);
  command
      .add_flag("--instanced", options.instanced,
                "In that file, one node for all instances of a terminal and shape, by EXT_mesh_gpu_instancing")
      ->needs(out)
      ->excludes("--out-nodes");
  CLI::Option* imageSize =
      addSize(command, "--image-size", options.imageSize, "Size of that picture (default 1280x720)");
  command.parse_complete_callback([image, camera, imageSize, &command, &options] {
    options.given.clear();
    for (const CLI::Option* option : command.get_options())
      if (*option) options.given.push_back(option->get_name());
    if (*imageSize && !*image && !*camera) throw CLI::RequiresError("--image-size", "--image or --camera");
  });
  command
      .add_option("--max-instances", options.maxInstances,
                  "Budget: instances or vertices written (0: as many as there are, up to what the device can bind)")
      ->check(CLI::Range(0u, 1u << 30))
      ->capture_default_str();
  command.add_option("--max-shapes", options.maxShapes,
                     "Budget: shapes that wait for a round (0: the library's default, doubled until all fit)");
  command.add_option("--max-colliders", options.maxColliders,
                     "Budget: shapes that Collider registers (0: as many as there are)");
  command.add_option("--slice", options.slice,
                     "Most axioms of one recording (0: as many as the device binds); budgets are those of a recording");
  command.add_flag("--string", options.string, "Of an L-system: print the last string");
  command
      .add_option(
          "--max-modules", options.maxModules,
          "Of an L-system: budget of modules of a string (0: as many as there are, up to what the device can bind)")
      ->check(CLI::Range(0u, 1u << 23));
  command.add_option("--max-depth", options.maxDepth, "Budget: recursion depth of rules (0: the library's default)");
  command.add_option("--max-faces", options.maxFaces, "Of a .cga file: budget of faces of a shape (0: 250 000)");
  command.add_option("--max-vertices", options.maxVertices,
                     "Of a .cga file: budget of vertices of a shape (0: 1 000 000)");
  command
      .add_option("--max-geometry", options.maxGeometry,
                  "Of a .cga file: budget of the meshes of an axiom, and of its triangles, MiB (0: 2048)")
      ->check(CLI::Range(0u, 16383u));
  command.add_option("--max-work", options.maxWork,
                     "Of a .cga file: budget of an axiom's work on geometry, million steps (0: 1000)");
  command.footer(R"(
Examples:
  gpgp spawn sponge.pga                                 one axiom of 1 x 1 x 1
  gpgp spawn tower.pga --axioms 256 --axiom-size 24,34,24 --spacing 40
  gpgp spawn tower.pga --set floors=12 --seed 7 --image tower.png --out tower.glb
  gpgp spawn town.pga --axiom-file lots.csv             x,z,rotation,size_x,size_y,size_z,seed,rule on the first line;
                                                        also y, qx to qw, m00 to m23, shape, attribute
  gpgp spawn wood.pga --scatter 6 --area 400,400 --axiom-size 7,10,7 --density wood.png --terrain hills.png
  gpgp spawn wood.pga --axioms 4096 --axiom-size 7,10,7 --camera 0,4,300,0,3,0 --budget 50000 --image wood.png
  gpgp spawn hills.pga --axioms 400 --field terrain=hills.png,-256,-256,256,256,60
  gpgp spawn house.pga tree.pga --axiom-file lots.csv   as one grammar; in the rule column: house, tree, house.Wall
  gpgp spawn old=a/house.pga new=b/house.pga            two files of one name; in the rule column: old, new
  gpgp spawn castle.gml --axiom-size 40,12,40 --start roundTower    a program; it starts at its axiom, or at a rule
  gpgp spawn plant.lsys --set iterations=4 --string    an L-system: its string, and what its turtle draws
  gpgp spawn tower.pga --axioms 1024 --repeat 50 --json | jq .gpu_ms_median
  gpgp spawn tower.pga --axioms 1024 --schedule tuned --output vertices --repeat 50
  gpgp spawn house.cga --axiom-size 12,1,18 --attr floors=3 --image house.png --out house.glb
  gpgp spawn house.cga --axiom-file lots.geojson        polygons, with holes; their properties set attributes
  gpgp spawn house.cga --attributes                     its attributes, with ranges, choices and groups

An axiom stands on its position. The CPU evaluator derives the same on one thread, to check the device's result;
cpu_reference_ms is its time. Errors in the grammar and in axiom files are printed with their place. What exceeds a
budget is counted and reported with the size that would have fitted; it is never silently lost.)");
}

} // namespace gpgp::cli
