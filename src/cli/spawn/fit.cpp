// `gpgp fit`: searches for the axiom of a grammar whose derivation comes nearest to a silhouette or to sums.
#include "cli/shared/command.h"
#include "cli/shared/painter.h"
#include "cli/spawn/fields.h"
#include "cli/spawn/fit_scorer.h"
#include "cli/spawn/grammar_source.h"
#include "cli/spawn/measures.h"
#include "cli/spawn/scene_picture.h"
#include "cli/spawn/spawned_triangles.h"
#include "core/suggest.h"
#include "host/picture.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/schedule/measuring.h"

#include <gpgp/fit.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <sstream>

namespace gpgp::cli {
namespace {

struct FitOptions {
  std::vector<std::string> grammars, set, measures, vary, fields;
  std::string start, silhouette, image, compare;
  std::array<float, 3> size{1, 1, 1};
  float height = 0;
  uint32_t candidates = 512, rounds = 48, seed = 1, maxDepth = 0;
  std::string method = "annealing";
  std::array<float, 2> temperature{0.05f, 0.0005f};
};

/// A number that takes all of the text.
std::optional<double> numberIn(const std::string& text) {
  size_t used = 0;
  try {
    const double value = std::stod(text, &used);
    if (used == text.size() && std::isfinite(value)) return value;
  } catch (const std::exception&) { // no number
  }
  return {};
}

constexpr std::pair<const char*, GpgpFitField> kFields[] = {{"size-x", GPGP_FIT_SIZE_X},
                                                            {"size-y", GPGP_FIT_SIZE_Y},
                                                            {"size-z", GPGP_FIT_SIZE_Z},
                                                            {"attribute", GPGP_FIT_ATTRIBUTE},
                                                            {"seed", GPGP_FIT_SEED}};

/// FIELD=MIN..MAX, or FIELD=MIN..MAX/STEP.
GpgpFitParameter parameterOf(const std::string& text) {
  const size_t equals = text.find('='), dots = text.find("..", equals == std::string::npos ? 0 : equals);
  const size_t slash = text.find('/', dots == std::string::npos ? 0 : dots);
  const auto field = std::find_if(std::begin(kFields), std::end(kFields),
                                  [&](const auto& known) { return text.substr(0, equals) == known.first; });
  const auto part = [&](size_t from, size_t to) { return numberIn(text.substr(from, to - from)); };
  const auto wrong = [&](const std::string& why) { return Usage("--vary " + text + ": " + why); };
  if (field == std::end(kFields)) {
    core::Suggestion suggestion(text.substr(0, equals));
    for (const auto& known : kFields) suggestion.offer(known.first);
    throw wrong("expected size-x, size-y, size-z, attribute or seed" + suggestion.text());
  }
  if (equals == std::string::npos || dots == std::string::npos)
    throw wrong("expected FIELD=MIN..MAX or FIELD=MIN..MAX/STEP");
  const auto low = part(equals + 1, dots), high = part(dots + 2, std::min(slash, text.size()));
  const auto step = slash == std::string::npos ? std::optional(0.0) : part(slash + 1, text.size());
  if (!low || !high || !step) throw wrong("expected numbers");
  if (*low > *high) throw wrong("the least value is above the greatest");
  if (*step < 0) throw wrong("the step is negative");
  if (field->second <= GPGP_FIT_SIZE_Z && !(*low > 0)) throw wrong("sizes are more than 0");
  if (field->second == GPGP_FIT_SEED && (*low < 0 || *high > 16777215 || *low != std::floor(*low)))
    throw wrong("seeds are whole numbers from 0 to 16777215");
  return {field->second, static_cast<float>(*low), static_cast<float>(*high), static_cast<float>(*step)};
}

std::vector<GpgpFitParameter> parametersOf(const FitOptions& options) {
  std::vector<GpgpFitParameter> parameters;
  for (const std::string& text : options.vary) {
    const GpgpFitParameter parameter = parameterOf(text);
    for (const GpgpFitParameter& other : parameters)
      if (other.field == parameter.field) throw Usage("--vary " + text + ": this field was given before");
    parameters.push_back(parameter);
  }
  if (parameters.empty()) parameters.push_back({GPGP_FIT_SEED, 0, 16777215, 1});
  return parameters;
}

/// What is measured, and what of it is wanted.
struct Wanted {
  std::vector<GpgpMeasure> measures;
  std::vector<uint32_t> bits;
  GpgpOccupancy occupancy{};
  GpgpFitTarget target = GPGP_FIT_TARGET_INIT;

  GpgpMeasureInfo info() const {
    return {measures.data(), static_cast<uint32_t>(measures.size()), bits.empty() ? nullptr : &occupancy};
  }
};

/// TERMINAL:FACTORS=VALUE, of which the score is how far the sum is from it, in parts of it.
void addMeasure(const std::string& text, const spawn::Graph& graph, Wanted& wanted) {
  const size_t colon = text.find(':'), equals = text.find('=', colon == std::string::npos ? 0 : colon);
  const auto wrong = [&](const std::string& why) { return Usage("--measure " + text + ": " + why); };
  if (colon == std::string::npos || equals == std::string::npos) throw wrong("expected TERMINAL:FACTORS=VALUE");
  if (wanted.measures.size() == GPGP_MAX_MEASURES)
    throw wrong("there are at most " + std::to_string(GPGP_MAX_MEASURES) + " measures");
  const GpgpMeasure measure =
      measureNamed(text.substr(0, colon), text.substr(colon + 1, equals - colon - 1), graph, text);
  const auto value = numberIn(text.substr(equals + 1));
  if (!value) throw wrong("expected a number");
  const size_t m = wanted.measures.size();
  wanted.measures.push_back(measure);
  wanted.target.sums[m] = *value;
  wanted.target.sumWeights[m] = 1 / std::max(std::abs(*value), 1.0);
}

/// Dark pixels of a picture, as few of them as a grid has cells for. Its lower edge is the ground, its middle x = 0.
void addSilhouette(const FitOptions& options, Wanted& wanted) {
  const host::Picture mask = host::readPng(options.silhouette);
  uint32_t scale = 1; // pixels of a cell, along x and y
  const auto cellsOf = [&](uint32_t pixels) { return (pixels + scale - 1) / scale; };
  while (uint64_t((cellsOf(mask.width) + 31) / 32) * cellsOf(mask.height) > shader::kMostGridWords) ++scale;
  const uint32_t width = cellsOf(mask.width), height = cellsOf(mask.height), row = (width + 31) / 32;
  wanted.bits.assign(size_t(row) * height, 0);
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      uint32_t dark = 0, all = 0;
      for (uint32_t py = y * scale; py < std::min((y + 1) * scale, mask.height); ++py)
        for (uint32_t px = x * scale; px < std::min((x + 1) * scale, mask.width); ++px) {
          const uint8_t* const pixel = &mask.rgba[(size_t(py) * mask.width + px) * 4];
          dark += pixel[3] >= 128 && pixel[0] + pixel[1] + pixel[2] < 384;
          ++all;
        }
      if (2 * dark < all || !dark) continue;
      wanted.bits[size_t(height - 1 - y) * row + x / 32] |= 1u << x % 32; // cells count upwards
      ++wanted.target.targetCells;
    }
  if (!wanted.target.targetCells)
    throw Usage("--silhouette " + options.silhouette + ": no pixel is dark (below half of white) and opaque");
  const float metres = options.height > 0 ? options.height : options.size[1];
  const float cell = metres / static_cast<float>(height), half = 0.5f * cell * static_cast<float>(width);
  constexpr float kDepth = 1e6f; // whatever lies in front or behind
  wanted.occupancy = {{{-half, 0, -kDepth}, {half, metres, kDepth}}, {width, height, 1}, wanted.bits.data()};
  wanted.target.occupancyWeight = 1;
}

/// What the CPU measures of an axiom, and the cells that it occupies.
GpgpAxiomMeasures onCpu(const FitOptions& options, const BakedGraph& grammar, const Wanted& wanted,
                        const WorldFields& fields, const GpgpAxiom& axiom, std::vector<uint32_t>& cells) {
  return measureOnCpu(grammar.words, wanted.info(), static_cast<uint32_t>(grammar.graph.terminals.size()), axiom,
                      options.maxDepth, {nullptr, &fields.bound()}, cells);
}

/// Cells of 4 x 4 pixels: grey where target and axiom agree, red where something is missing, blue where it is too much.
void writeComparison(const std::string& file, const Wanted& wanted, const std::vector<uint32_t>& cells) {
  constexpr uint32_t kSide = 4;
  const uint32_t width = wanted.occupancy.cells[0], height = wanted.occupancy.cells[1], row = (width + 31) / 32;
  host::Picture picture{width * kSide, height * kSide, {}};
  picture.rgba.resize(size_t(picture.width) * picture.height * 4, 255);
  constexpr uint8_t kColours[4][3] = {{255, 255, 255}, {214, 64, 52}, {58, 110, 214}, {96, 96, 96}};
  for (uint32_t y = 0; y < picture.height; ++y)
    for (uint32_t x = 0; x < picture.width; ++x) {
      const size_t word = size_t(height - 1 - y / kSide) * row + x / kSide / 32;
      const uint32_t bit = x / kSide % 32;
      const uint8_t* const colour = kColours[(wanted.bits[word] >> bit & 1) | (cells[word] >> bit & 1) << 1];
      std::copy_n(colour, 3, &picture.rgba[(size_t(y) * picture.width + x) * 4]);
    }
  host::writePng(file, picture);
}

void writeImage(const FitOptions& options, const BakedGraph& grammar, const GpgpAxiom& axiom, DeriverOptions how,
                Session& session) {
  how.vertices = true;
  Deriver deriver(session, grammar, {axiom}, how);
  deriver.fit(deriver.prepare(std::pmr::vector<uint32_t>()));
  Triangles triangles{true, std::vector<uint64_t>(grammar.graph.terminals.size())};
  addTriangles(triangles, deriver.vertices(), deriver.indices());
  paintScene(options.image, {{960, 720}, 30, 15, 1, 0}, triangles.corners,
             [&](size_t i) { return paletteColour(grammar.graph.terminals[triangles.terminals[i]].index); });
}

Outcome fit(const FitOptions& options, const CommonOptions& common) {
  if (options.silhouette.empty() && options.measures.empty())
    throw Usage("there is nothing to fit to: give --silhouette or --measure");
  if (!options.compare.empty() && options.silhouette.empty()) throw Usage("--compare needs --silhouette");
  for (const std::string& file : options.grammars) expectGraphLanguage(file);
  const std::vector<GpgpFitParameter> parameters = parametersOf(options);
  const BakedGraph grammar = bakeGraph(options.grammars, options.set);
  Wanted wanted;
  for (const std::string& text : options.measures) addMeasure(text, grammar.graph, wanted);
  if (!options.silhouette.empty()) addSilhouette(options, wanted);
  if (grammar.graph.phases)
    throw Usage("candidates are derived together, and colliders would meet those of others: grammars with Collider or "
                "IfCollides cannot be fitted");

  Session session(common);
  const WorldFields fields(options.fields, grammar.graph);
  DeriverOptions how;
  how.maxDepth = options.maxDepth;
  fields.give(how);
  FitScorer scorer(session, grammar, wanted.info(), how);
  GpgpFit search = GPGP_FIT_INIT;
  search.base = axiomAt({0, 0, 0}, 0, options.size, options.seed, 0);
  search.base.start = options.start.empty() ? grammar.starts().front() : scorer.startNamed(options.start);
  search.parameters = parameters.data();
  search.parameterCount = static_cast<uint32_t>(parameters.size());
  search.candidates = options.candidates;
  search.rounds = options.rounds;
  search.method = options.method == "annealing" ? GPGP_FIT_ANNEALING : GPGP_FIT_MONTE_CARLO;
  search.seed = options.seed;
  search.startTemperature = options.temperature[0];
  search.endTemperature = options.temperature[1];

  std::vector<GpgpAxiom> proposed(search.candidates);
  std::vector<GpgpFitCandidate> current(search.candidates);
  std::vector<double> scores(search.candidates);
  GpgpFitCandidate best{};
  Json history = Json::array();
  const auto check = [](GpgpResult result) {
    if (result != GPGP_SUCCESS) throw Failure(std::string("the search was refused: ") + gpgpResultString(result));
  };
  uint32_t rounds = 0;
  for (; rounds < search.rounds && (rounds == 0 || best.score > 0); ++rounds) {
    check(gpgpProposeAxioms(&search, rounds, current.data(), proposed.data()));
    const std::vector<GpgpAxiomMeasures> measured = scorer.measure(proposed);
    check(gpgpScoreMeasures(&wanted.target, measured.data(), search.candidates, scores.data()));
    check(gpgpAcceptAxioms(&search, rounds, proposed.data(), scores.data(), current.data(), &best));
    history.push_back(best.score);
  }

  std::vector<uint32_t> cells;
  const GpgpAxiomMeasures found = onCpu(options, grammar, wanted, fields, best.axiom, cells);
  double score = 0;
  check(gpgpScoreMeasures(&wanted.target, &found, 1, &score));
  if (session.device().isSoftware() ? score != best.score : std::abs(score - best.score) > 0.01)
    throw Failure("the device scored the best axiom " + std::to_string(best.score) + ", the CPU " +
                  std::to_string(score) + "; please report this");
  if (!options.compare.empty()) writeComparison(options.compare, wanted, cells);
  if (!options.image.empty()) writeImage(options, grammar, best.axiom, how, session);
  session.checkValidation();

  Outcome outcome;
  std::ostringstream text;
  text << "best of " << uint64_t(rounds) * search.candidates << " candidates in " << rounds << " rounds on "
       << session.device().name() << ": score " << best.score << "\n  --axiom-size " << best.axiom.size[0] << ','
       << best.axiom.size[1] << ',' << best.axiom.size[2] << " --seed " << best.axiom.seed;
  if (!std::isnan(best.axiom.attribute)) text << ", attribute " << best.axiom.attribute;
  text << '\n';
  Json sums = Json::array();
  for (size_t m = 0; m < wanted.measures.size(); ++m) {
    const double sum = static_cast<double>(found.sums[m]) / 65536;
    sums.push_back({{"measure", options.measures[m]}, {"sum", sum}});
    text << "  " << options.measures[m] << ": " << sum << '\n';
  }
  const uint32_t missing = wanted.target.targetCells - found.matchingCells,
                 tooMany = found.occupiedCells - found.matchingCells;
  if (!options.silhouette.empty())
    text << "  silhouette of " << wanted.target.targetCells << " cells: " << missing << " missing, " << tooMany
         << " too many\n";
  char spent[32];
  std::snprintf(spent, sizeof spent, "%.1f", scorer.gpuMilliseconds());
  text << "  " << scorer.terminals() << " terminals derived and measured in " << spent << " ms of GPU time, "
       << scorer.recordings() << " recordings\n";
  outcome.text = text.str();
  outcome.json = {{"grammar", jsonOf(options.grammars)},
                  {"device", session.device().name()},
                  {"score", best.score},
                  {"size", {best.axiom.size[0], best.axiom.size[1], best.axiom.size[2]}},
                  {"seed", best.axiom.seed},
                  {"attribute", std::isnan(best.axiom.attribute) ? Json() : Json(best.axiom.attribute)},
                  {"rounds", rounds},
                  {"candidates", search.candidates},
                  {"best_by_round", history},
                  {"sums", sums},
                  {"target_cells", wanted.target.targetCells},
                  {"missing_cells", missing},
                  {"excess_cells", tooMany},
                  {"terminals", scorer.terminals()},
                  {"gpu_ms", scorer.gpuMilliseconds()},
                  {"recordings", scorer.recordings()},
                  {"image", options.image.empty() ? Json() : Json(options.image)},
                  {"compare", options.compare.empty() ? Json() : Json(options.compare)}};
  return outcome;
}

} // namespace

Work addFit(CLI::App& app) {
  auto options = std::make_shared<FitOptions>();
  CLI::App* command = app.add_subcommand("fit", "Search for the axiom whose derivation is nearest to what is wanted");
  addGrammars(*command, options->grammars);
  addVariables(*command, options->set);
  addFields(*command, options->fields);
  command->add_option("--start", options->start, "The rule to start at (default: the first axiom's)")
      ->type_name("RULE");
  command
      ->add_option("--silhouette", options->silhouette,
                   "A picture whose dark, opaque pixels the derivation should cover, seen along -Z; its lower edge is "
                   "the ground, its middle x = 0")
      ->check(CLI::ExistingFile)
      ->type_name("FILE.png");
  command->add_option("--height", options->height, "Metres that the silhouette is high (default: Y of --axiom-size)")
      ->check(within(1e-3, 1e6));
  command
      ->add_option("--measure", options->measures,
                   "A sum over all terminals of a name, or over all, and what it should be. FACTORS: letters of x y z "
                   "(extents) and a (attribute) that are multiplied, or count; may be repeated")
      ->type_name("TERMINAL:FACTORS=VALUE")
      ->allow_extra_args(false);
  command
      ->add_option("--vary", options->vary,
                   "What the search may change: size-x, size-y, size-z, attribute, seed; may be repeated (default: "
                   "seed=0..16777215)")
      ->type_name("FIELD=MIN..MAX[/STEP]")
      ->allow_extra_args(false);
  command
      ->add_option_function<std::string>(
          "--axiom-size", [o = options.get()](const std::string& t) { o->size = parseTriple(t); },
          "Extents of the axiom in metres, as far as they do not vary (default 1,1,1)")
      ->type_name("X,Y,Z");
  command->add_option("--candidates", options->candidates, "Axioms of a round")
      ->check(CLI::Range(1u, 1u << 20))
      ->capture_default_str();
  command->add_option("--rounds", options->rounds, "Rounds at most; the search ends at a score of 0")
      ->check(CLI::Range(1u, 1000000u))
      ->capture_default_str();
  command->add_option("--method", options->method, "annealing: chains that improve; monte-carlo: draws alone")
      ->check(CLI::IsMember({"annealing", "monte-carlo"}))
      ->capture_default_str();
  command->add_option("--temperature", options->temperature, "Of annealing, first and last, in units of the score")
      ->delimiter(',')
      ->check(within(0, 1e9))
      ->type_name("FROM,TO")
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Of the search, and of the axiom where seed does not vary")
      ->capture_default_str();
  command
      ->add_option("--max-depth", options->maxDepth,
                   "Budget: how deep rules nest in themselves (0: the library's default)")
      ->check(CLI::Range(0u, 65535u));
  command->add_option("--image", options->image, "Write a picture of what was found")
      ->check(pngFile())
      ->type_name("FILE.png");
  command
      ->add_option("--compare", options->compare,
                   "Write the silhouettes: grey where they agree, red what is missing, blue what is too much")
      ->check(pngFile())
      ->type_name("FILE.png");
  command->footer(R"(
Examples:
  gpgp fit tower.pga --axiom-size 40,60,20 --silhouette skyline.png --image tower.png
  gpgp fit tower.pga --silhouette skyline.png --height 80 --vary size-x=20..60 --vary size-y=30..80 --vary seed=0..9999
  gpgp fit house.pga --axiom-size 12,9,24 --vary size-y=3..30 --measure Window:count=64 --measure all:xyz=2000

A score is, of each measure, how far the sum is from what it should be, in parts of that; and of a silhouette, cells
that are missing or too many, in parts of its own. The same options find the same axiom. The best one is measured by
the CPU as well, and compared.)");
  return [options](const CommonOptions& common) { return fit(*options, common); };
}

} // namespace gpgp::cli
