#include "cli/visibility/options.h"
#include "cli/shared/command.h"

#include <cmath>
#include <cstdio>
#include <sstream>

namespace gpgp::cli {
namespace {

/// "ABS,DYN"
void parseEpsilon(const std::string& text, VisibilityOptions& options) {
  char rest = 0;
  float values[2];
  if (std::sscanf(text.c_str(), "%f,%f%c", &values[0], &values[1], &rest) != 2 || !(values[0] >= 0 && values[1] >= 0) ||
      !(values[0] < 1e30f && values[1] < 1e30f))
    throw CLI::ValidationError("--epsilon", "'" + text + "' is not ABS,DYN, two numbers from 0 on");
  options.epsilonStatic = values[0];
  options.epsilonDynamic = values[1];
}

Motion parseMotion(const std::string& text) {
  Motion motion;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%f,%f,%f%c", &motion.speed, &motion.turn, &motion.latency, &rest) != 3 ||
      !(std::abs(motion.speed) <= 1e6f) || !(motion.turn >= 0 && motion.turn <= 1080) ||
      !(motion.latency >= 0 && motion.latency <= 10000))
    throw CLI::ValidationError("--motion", "'" + text +
                                               "' is not SPEED,TURN,LATENCY: world units per second along the "
                                               "view, degrees per second up to 1080, milliseconds up to 10000");
  return motion;
}

Walk parseWalk(const std::string& text) {
  Walk walk;
  char rest = 0;
  const int read =
      std::sscanf(text.c_str(), "%f,%f,%u,%f%c", &walk.speed, &walk.turn, &walk.frames, &walk.maxLate, &rest);
  if (read < 3 || read > 4 || !(std::abs(walk.speed) <= 1e6f) || !(std::abs(walk.turn) <= 1080) || walk.frames < 3 ||
      walk.frames > 100000 || !(walk.maxLate >= 0.0001f && walk.maxLate <= 0.05f))
    throw CLI::ValidationError("--walk", "'" + text +
                                             "' is not SPEED,TURN,FRAMES or SPEED,TURN,FRAMES,LATE: world units per "
                                             "second along the view, degrees per second up to 1080, 3 to 100000 "
                                             "frames, a share of 0.0001 to 0.05");
  return walk;
}

/// "N" or "WxH", multiples of 128 up to 8192.
Size parseAtlas(const std::string& text) {
  const Size size = parseSize(text.find('x') == std::string::npos ? text + 'x' + text : text);
  if (size.width % 128 || size.height % 128 || size.width > 8192 || size.height > 8192)
    throw CLI::ValidationError("--atlas", "'" + text + "' is not N or WxH, multiples of 128 up to 8192");
  return size;
}

/// Names of heuristics, or "none" alone.
uint32_t parseHeuristics(const std::string& text) {
  if (text == "none") return 0;
  uint32_t heuristics = 0;
  std::istringstream names(text + ','); // nothing, or nothing behind a comma, is a name that there is not
  for (std::string name; std::getline(names, name, ',');) {
    if (name == "in-circle")
      heuristics |= GPGP_HEURISTIC_IN_CIRCLE;
    else if (name == "depth")
      heuristics |= GPGP_HEURISTIC_DEPTH;
    else if (name == "front")
      heuristics |= GPGP_HEURISTIC_DEPTH | GPGP_HEURISTIC_KEEP_FRONT;
    else
      throw CLI::ValidationError("--heuristics",
                                 "'" + name + "' is none of in-circle, depth, front; none stands alone");
  }
  return heuristics;
}
} // namespace

GpgpSamplingMethod VisibilityOptions::sampling() const {
  return method == "standard"       ? GPGP_SAMPLING_STANDARD
         : method == "conservative" ? GPGP_SAMPLING_CONSERVATIVE
                                    : GPGP_SAMPLING_EXACT;
}

void addVisibilityOptions(CLI::App& command, VisibilityOptions& options) {
  command.add_option("MODEL", options.model, "glTF 2 (.glb, .gltf) or Wavefront (.obj)")
      ->required()
      ->check(CLI::ExistingFile);
  addSize(command, "--size", options.size, "Viewport in pixels (default 1280x720)");
  CLI::Option* yaw =
      command.add_option("--yaw", options.yaw, "Degrees around the model, for a camera that sees all of it")
          ->check(within(-1e6, 1e6))
          ->capture_default_str();
  CLI::Option* pitch = command.add_option("--pitch", options.pitch, "Degrees above the horizon, for the same camera")
                           ->check(within(-89.0, 89.0))
                           ->capture_default_str();
  command.add_flag("--two-sided", options.twoSided, "Back faces count as well");
  command
      .add_option_function<std::string>(
          "--grid", [&options](const std::string& text) { options.grid = parseSize(text); },
          "NxM copies of the model side by side, along X and Z")
      ->type_name("NxM");
  CLI::Option* orbit = command
                           .add_option("--orbit", options.orbit,
                                       "N cameras on a circle 20 degrees above the horizon; results are averages")
                           ->check(CLI::Range(1u, 4096u))
                           ->excludes(yaw)
                           ->excludes(pitch);
  command
      .add_option("--distance", options.distance,
                  "Distance of the orbit's cameras from the middle of the bounding box, in half diagonals")
      ->check(within(0.01, 1e6))
      ->capture_default_str()
      ->needs(orbit);
  command
      .add_option("--camera", options.camera,
                  "16 numbers: the matrix from world to clip space, column-major; a 17th other than 0: reversed depth")
      ->check(CLI::ExistingFile)
      ->excludes(orbit)
      ->excludes(yaw)
      ->excludes(pitch);
  command.add_option("--method", options.method, "standard, conservative, exact or cell (exact over a view cell)")
      ->check(CLI::IsMember({"standard", "conservative", "exact", "cell"}))
      ->capture_default_str();
  const std::vector<CLI::Option*> conservative = {
      command
          .add_option_function<std::string>(
              "--epsilon", [&options](const std::string& text) { parseEpsilon(text, options); },
              "Conservative: static and dynamic epsilon, in units along the view (default 0.05,0.05)")
          ->type_name("ABS,DYN"),
      command
          .add_option_function<std::string>(
              "--heuristics", [&options](const std::string& text) { options.heuristics = parseHeuristics(text); },
              "Conservative: list of in-circle, depth, front (depth, but keeps what lies in front), or none (default "
              "in-circle,depth)")
          ->type_name("LIST"),
      command.add_option("--resolution", options.resolution, "Conservative: factor of the viewport's size")
          ->check(within(0.25, 1.0))
          ->capture_default_str(),
      command.add_option("--refinements", options.refinements, "Conservative: at most N passes that close gaps")
          ->check(CLI::Range(0u, 4u))
          ->capture_default_str()};
  const CLI::Option* samples =
      command.add_option("--samples", options.samples, "Standard: N x N samples a pixel (exact has points of its own)")
          ->check(CLI::IsMember({1u, 2u, 4u, 8u}))
          ->capture_default_str();
  CLI::Option* cell = command.add_option(
      "--cell", options.cell,
      "View cell: COLUMNSxROWS[/SKIP] in pixels, or RADIUS:POINTS in world units, a square number of points");
  command
      .add_flag("--through-walls", options.throughWalls,
                "View points of the cell count even where a triangle lies between them and its middle")
      ->needs(cell);
  CLI::Option* motion =
      command
          .add_option_function<std::string>(
              "--motion", [&options](const std::string& text) { options.motion = parseMotion(text); },
              "What a viewer may see who walks and turns until the result is no longer shown: world units per second "
              "along the view, degrees per second, and milliseconds; gpgp chooses the view points. --reference "
              "compares with what viewers see at the picture's size")
          ->type_name("SPEED,TURN,LATENCY")
          ->excludes(cell);
  CLI::Option* walk =
      command
          .add_option_function<std::string>(
              "--walk", [&options](const std::string& text) { options.walk = parseWalk(text); },
              "Exact: a viewer who walks from the first camera's place, 60 frames a second; each frame takes over "
              "decisions of the previous one, and is compared with sampling that decides all. World units per second "
              "along the view, degrees per second to the right, frames; the share of the visible triangles that may "
              "be late (0.005)")
          ->type_name("SPEED,TURN,FRAMES[,LATE]")
          ->excludes(cell)
          ->excludes(motion);
  command.add_option("--eyes", options.eyes, "Distance between two eyes, in world units")
      ->check(within(0.0, 1e6))
      ->needs(motion);
  command.add_option("--viewers", options.viewers, "How many viewers --reference compares a motion with")
      ->check(CLI::Range(1u, 1024u))
      ->capture_default_str()
      ->needs(motion);
  CLI::Option* reference =
      command.add_option("--reference", options.reference, "Measure against N x N + 1 samples a pixel")
          ->check(CLI::IsMember({1u, 2u, 4u, 8u, 16u, 32u, 64u, 128u, 256u}));
  const CLI::Option* recheck =
      command.add_option("--recheck", options.recheck, "Sample claimed false positives again at N x N; 0: do not")
          ->check(CLI::IsMember({0u, 64u, 128u, 256u}))
          ->capture_default_str()
          ->needs(reference);
  command
      .add_option("--reference-device", options.referenceDevice,
                  "gpu, or cpu: rays in double precision, which share no rounding with the methods")
      ->check(CLI::IsMember({"gpu", "cpu"}))
      ->capture_default_str()
      ->needs(reference);
  command
      .add_option("--overlay", options.overlay,
                  "Write a picture of the first camera's view, 3 x 3 pixels for each of the viewport's. Green: found "
                  "by standard sampling, grey: added by the method, red: not in the reference, blue: missed")
      ->check(pngFile())
      ->type_name("FILE.png");
  command
      .add_option("--export-ids", options.exportIds,
                  "Write the triangles that any of the cameras sees, as little-endian uint32, ascending")
      ->type_name("FILE");
  command
      .add_option("--repeat", options.repeat,
                  "Sample N times and report the median time; a first run before them is not counted")
      ->check(CLI::Range(1u, 100000u))
      ->capture_default_str();
  command
      .add_option("--image", options.image, "Write a picture: what the first camera sees, from there and from the side")
      ->check(pngFile())
      ->type_name("FILE.png");
  CLI::Option* atlas = command
                           .add_option_function<std::string>(
                               "--atlas", [&options](const std::string& text) { options.atlas = parseAtlas(text); },
                               "Allocate a shading atlas of N x N texels (or WxH) for what the first camera sees; with "
                               "--repeat, every other recording leaves out one pair of triangles in 64")
                           ->type_name("N")
                           ->excludes(walk);
  command.add_option("--texels", options.texelsPerPixel, "Texels of the atlas for each pixel of a triangle's area")
      ->check(within(1.0 / 1024, 64.0))
      ->capture_default_str()
      ->needs(atlas);
  command.add_option("--out", options.out, "Write the atlas, shaded with a pattern in world space")
      ->check(pngFile())
      ->type_name("FILE.png")
      ->needs(atlas);
  command
      .add_option("--display", options.display,
                  "Write what the first camera sees with the pattern from the atlas (left) and shaded directly (right)")
      ->check(pngFile())
      ->type_name("FILE.png")
      ->needs(atlas);
  // What would have no effect is an error: who gives it expects one.
  command.callback([&options, conservative, samples, recheck, walk] {
    if (walk->count() && options.method != "exact")
      throw CLI::ValidationError(walk->get_name(), "belongs to --method exact");
    for (const CLI::Option* option : conservative)
      if (option->count() && options.method != "conservative")
        throw CLI::ValidationError(option->get_name(), "belongs to --method conservative");
    if (samples->count() && options.method == "conservative")
      throw CLI::ValidationError(samples->get_name(), "belongs to --method standard");
    options.needlessSamples = samples->count() && options.sampling() == GPGP_SAMPLING_EXACT;
    if (options.method == "cell" && options.cell.empty())
      throw CLI::ValidationError("--method cell", "needs --cell SPEC");
    if (recheck->count() && options.recheck && options.recheck <= options.reference)
      throw CLI::ValidationError(recheck->get_name(), "has to be finer than --reference");
  });
  command.footer(R"(
Examples:
  gpgp visibility engine.glb
  gpgp visibility bunny.obj --yaw 90 --image seen.png
  gpgp visibility engine.glb --size 1920x1080 --repeat 100 --json | jq .visible
  gpgp visibility engine.glb --method exact --orbit 8 --reference 64 --overlay seen.png
  gpgp visibility engine.glb --method exact --walk 1.5,0,120 --json
  gpgp visibility engine.glb --method exact --atlas 4096 --repeat 100 --out atlas.png --display shown.png

Without --camera and --orbit the camera looks at the middle of the model's bounding box from --yaw degrees around it (0:
along -Z) and --pitch above, from far enough to see all of it. Camera k of --orbit N stands 360 k / N degrees around, from
+Z towards +X, and 20 above, --distance halves of the box's diagonal away, with a vertical field of view of 60 degrees.

Triangles are numbered from 0: of OBJ files in the order of their f lines, a polygon of n corners as n - 2 triangles (convex
ones as the fan of corners 1 2 3, 1 3 4, ...; concave ones by ear clipping); of glTF files node after node, depth first,
and in each its instances, its primitives and their indices; of a grid copy after copy, along X first.

--reference 64 takes 65 recordings, and --recheck 256, the default, up to 1025 more: minutes on software devices. Standard
error says how long; --recheck 0, a smaller --reference or --size take less.

JSON: gpu_ms_median, gpuMilliseconds and passes are milliseconds of a view's recording (the median of --repeat), of a cell
the sum over its views, of an orbit the median over its cameras; gpu_ms_median is gpuMilliseconds.median, and passes
adds up those of gpuMilliseconds.passes that have one name. Counts and shares are averages over an orbit's cameras.)");
}

} // namespace gpgp::cli
