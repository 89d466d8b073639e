// `gpgp bake`: grammars, drawings and fonts to the files that a game loads. Needs no GPU.
#include "cli/shared/command.h"
#include "host/files.h"
#ifdef GPGP_CLI_SPAWN
#include "cli/spawn/grammar_source.h"
#include "cli/tune/kernels.h"
#endif
#ifdef GPGP_CLI_TEXT
#include "cli/bake/font.h"
#endif
#ifdef GPGP_CLI_VECTOR
#include "cli/vector/svg_files.h"
#include "cli/vector/svg_messages.h"
#ifdef GPGP_CLI_TEXT
#include "cli/vector/svg_text.h"
#endif
#endif

#include <gpgp/gpgp.hpp>

#include <cctype>
#include <filesystem>
#include <span>
#include <sstream>
#include <variant>

namespace gpgp::cli {
namespace {

struct BakeOptions {
  std::vector<std::string> in, set, schedules;
  std::string out, type;
  bool kernel = true, link = false;
  float scale = 1;
  std::string method = "flattened";
#ifdef GPGP_CLI_SPAWN
  spawn::Heuristics heuristics;
  std::string queues = "mixed";
#endif
#ifdef GPGP_CLI_TEXT
  BakeFontOptions font;
  std::vector<std::string> textFonts; ///< of drawings
#endif
};

/// What bytes are: gzip or a tag begin a drawing, fonts say so in their first four bytes, and other text is a grammar.
/// Empty where they are none of these.
std::string typeOfBytes(std::string_view bytes) {
  const auto starts = [&bytes](std::string_view with) { return bytes.starts_with(with); };
  using namespace std::string_view_literals;
  for (const std::string_view font : {"\0\1\0\0"sv, "OTTO"sv, "ttcf"sv, "true"sv})
    if (starts(font)) return "font";
  for (const std::string_view drawing : {"\x1f\x8b"sv, "\xfe\xff\0<"sv, "\xff\xfe<\0"sv, "\0<"sv, "<\0"sv})
    if (starts(drawing)) return "drawing";
  if (bytes.find('\0') != bytes.npos) return {};
  if (starts("\xef\xbb\xbf")) bytes.remove_prefix(3);
  const size_t first = bytes.find_first_not_of(" \t\r\n\f");
  if (first == bytes.npos) return {};
  return bytes[first] == '<' ? "drawing" : "grammar";
}

/// grammar, drawing or font: as --type says, else by the file's ending, and of standard input by what it holds.
std::string typeOf(const BakeOptions& options, const std::string& file, std::string_view bytes) {
  if (!options.type.empty()) return options.type;
  if (file == kStandard) {
    const std::string type = typeOfBytes(bytes);
    if (type.empty()) throw Usage("standard input is not a drawing, font or grammar; state its type with --type");
    return type;
  }
  std::string ending = std::filesystem::path(file).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (ending == ".pga" || ending == ".gml" || ending == ".cga") return "grammar";
#ifdef GPGP_CLI_SPAWN
  expectGraphLanguage(file);
#endif
  if (ending == ".svg" || ending == ".svgz") return "drawing";
  if (ending == ".ttf" || ending == ".otf" || ending == ".ttc" || ending == ".otc") return "font";
  throw Usage(file + ": neither .pga nor .gml nor .cga nor .svg nor a font; state its type with --type");
}

/// Of the baked file.
const char* endingOf(std::string_view type) {
  return type == "drawing" ? ".gpgpv" : type == "font" ? ".gpgpf" : ".gpgp";
}

/// Of a baked file, without a copy of what a compiler made.
using Bytes = std::variant<std::string, Blob>;
std::string_view view(const Bytes& bytes) {
  if (const auto* text = std::get_if<std::string>(&bytes)) return *text;
  const Blob& blob = std::get<Blob>(bytes);
  return {static_cast<const char*>(static_cast<const void*>(blob.data())), blob.size()};
}

struct Baked {
  Bytes bytes;
  Json json = Json::object(); ///< what only this type tells
  std::string words;
  std::string refusal = {}; ///< the first part of it that was left out because it is too much
  size_t refusals = 0;
};

#ifdef GPGP_CLI_VECTOR
Baked bakeDrawing(const std::string& text, const std::string& file, const std::string& name,
                  const BakeOptions& options) {
  GpgpSvgSource source = GPGP_SVG_SOURCE_INIT;
  source.name = name.c_str();
  source.data = text.data();
  source.size = text.size();
  source.scale = options.scale;
  source.methods = options.method == "in-pass" ? GPGP_DRAWING_IN_PASS
                   : options.method == "both"  ? GPGP_DRAWING_FLATTENED | GPGP_DRAWING_IN_PASS
                                               : GPGP_DRAWING_FLATTENED;
  SvgMessages messages;
  messages.attach(source);
  const SvgFiles files(file);
  source.fileSystem = files.fileSystem();
#ifdef GPGP_CLI_TEXT
  SvgText fonts(options.textFonts);
  fonts.attach(source);
#endif
  Result<Blob> blob = compileSvg(source);
  if (!blob) throw Failure(messages.count() ? messages.failure() : name + ": " + blob.name());
  messages.finish();
  return {std::move(*blob), {{"messages", messages.json()}}, {}, messages.firstRefusal(), messages.refusals()};
}
#endif

#ifdef GPGP_CLI_SPAWN
/// names: of the files, as the command line has them.
Bytes bakeGrammars(const BakeOptions& options, std::span<const GrammarText> texts, bool linked,
                   const std::vector<std::string>& names) {
  if (options.schedules.empty() && options.queues == "mixed")
    return linked ? linkGrammars(texts, options.set, options.kernel)
                  : compileGrammar(texts[0], options.set, options.kernel);
  const std::vector<std::string> usual{"default"};
  const auto words =
      withKernels(bakeGraph(texts, linked, options.set), names, options.schedules.empty() ? usual : options.schedules,
                  options.heuristics, options.queues == "group" ? spawn::Queues::groups : spawn::Queues::mixed);
  return std::string(static_cast<const char*>(static_cast<const void*>(words.data())), words.size() * 4);
}
#endif

Baked bakeOne([[maybe_unused]] const BakeOptions& options, const std::string& file, const std::string& type,
              const std::string& bytes) {
  const std::string name = inputName(file);
#ifdef GPGP_CLI_SPAWN
  if (type == "grammar") {
    const GrammarText text{GrammarFile(name), bytes};
    return {bakeGrammars(options, {&text, 1}, false, {name}), Json::object(), {}};
  }
#endif
#ifdef GPGP_CLI_VECTOR
  if (type == "drawing") return bakeDrawing(bytes, file, name, options);
#endif
#ifdef GPGP_CLI_TEXT
  if (type == "font") {
    BakedFont font = bakeFont(bytes, name, options.font);
    return {std::move(font.blob), std::move(font.json), ", " + font.words};
  }
#endif
  throw Failure(name + ": this gpgp was built without what bakes a " + type);
}

/// All grammars to one file.
Outcome bakeLinked([[maybe_unused]] const BakeOptions& options) {
#ifdef GPGP_CLI_SPAWN
  if (std::filesystem::is_directory(options.out) || options.out.ends_with('/'))
    throw Usage("--link makes one file; " + options.out + " is a folder");
  std::vector<GrammarText> grammars;
  for (const std::string& argument : options.in) {
    const GrammarFile file(argument);
    if (file.path == kStandard && file.alias.empty())
      throw Usage("standard input has no name to be linked by; NAME=- gives it one");
    std::string text = readInput(file.path);
    if (!text.starts_with("gppg") && typeOf(options, file.path, text) != "grammar")
      throw Usage(file.path + " is not a grammar; --link is for grammars");
    grammars.push_back({file, std::move(text)});
  }
  const Bytes made = bakeGrammars(options, grammars, true, options.in);
  const std::string_view bytes = view(made);
  if (options.out == kStandard) return {Json::object(), std::string(bytes)};
  host::writeFile(options.out, bytes);
  std::ostringstream text;
  text << joined(options.in) << ": grammar, " << bytes.size() << " bytes, " << options.out << '\n';
  const Json line = {{"in", options.in}, {"type", "grammar"}, {"out", options.out}, {"bytes", bytes.size()}};
  return {{{"baked", Json::array({line})}}, text.str()};
#else
  throw Failure("this gpgp was built without what bakes a grammar");
#endif
}

Outcome bake(const BakeOptions& options, const CommonOptions& common) {
  if (options.out == kStandard && common.json) throw Usage("standard output takes the baked file or --json, not both");
  if (options.link) return bakeLinked(options);
  // With several inputs, or where OUT is a folder, each gets a file of its own name there, with its type's ending
  // behind it.
  const bool folder = options.in.size() > 1 || std::filesystem::is_directory(options.out) || options.out.ends_with('/');
  if (folder && options.out == kStandard) throw Usage("standard output takes one input");
  struct Input {
    std::string file, type, bytes; // of standard input, which tell its type
  };
  std::vector<Input> work; // all types are known before any file is written
  for (const std::string& file : options.in) {
    if (file == kStandard && folder) throw Usage("standard input has no name for a file in a folder; give it alone");
    std::string bytes = file == kStandard ? readInput(file) : std::string();
    std::string type = typeOf(options, file, bytes);
#ifdef GPGP_CLI_SPAWN
    if (type == "grammar" && !GrammarFile(file).alias.empty()) throw Usage(file + ": NAME=FILE is for --link");
#endif
    work.push_back({file, std::move(type), std::move(bytes)});
  }
  Outcome outcome{Json::object(), {}};
  Json list = Json::array();
  std::ostringstream text;
  std::vector<std::pair<std::string, Baked>> files; // all are made before any is written
  for (const auto& [file, type, input] : work) {
    Baked baked = bakeOne(options, file, type, file == kStandard ? input : readInput(file));
    const std::string_view bytes = view(baked.bytes);
    if (options.out == kStandard) {
      outcome.text = bytes;
      outcome.failure = baked.refusal;
      outcome.errorsShown = baked.refusals;
      return outcome;
    }
    const std::string out =
        folder ? (std::filesystem::path(options.out) / std::filesystem::path(file).filename()).string() + endingOf(type)
               : options.out;
    for (const Json& other : list)
      if (other["out"] == out) throw Usage(file + ": another input goes to " + out + " as well");
    list.push_back({{"in", file}, {"type", type}, {"out", out}, {"bytes", bytes.size()}});
    list.back().update(baked.json);
    if (outcome.failure.empty()) outcome.failure = baked.refusal;
    outcome.errorsShown += baked.refusals;
    text << file << ": " << type << baked.words << ", " << bytes.size() << " bytes, " << out << '\n';
    files.emplace_back(out, std::move(baked));
  }
  for (const auto& [out, baked] : files) host::writeFile(out, view(baked.bytes));
  outcome.text = text.str();
  outcome.json = {{"baked", list}};
  return outcome;
}

} // namespace

Work addBake(CLI::App& app) {
  auto options = std::make_shared<BakeOptions>();
  CLI::App* command = app.add_subcommand("bake", "Compile grammars, drawings and fonts to the files that a game loads");
  command
      ->add_option("IN", options->in,
                   "Grammars (.pga, .gml), drawings (.svg, .svgz), fonts (.ttf, .otf, .ttc); - is standard input")
      ->required();
  command->add_option("-o,--out", options->out, "The file, a folder, or - for standard output")
      ->type_name("FILE|FOLDER|-")
      ->required();
  command
      ->add_option("--type", options->type,
                   "Type of the inputs, whatever their names (standard input: detected from its bytes)")
      ->check(CLI::IsMember({"grammar", "drawing", "font"}));
  command
      ->add_option("--set", options->set, "Override a `var` of the grammars, with --link GRAMMAR.NAME; may be repeated")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  command->add_flag("--link", options->link,
                    "Link the grammars, baked ones too, to one file: names of a.pga become a.Name, and its start is a. "
                    "NAME=FILE renames a file");
  CLI::Option* noKernel = command->add_flag("!--no-kernel", options->kernel,
                                            "Grammars run on the interpreter: smaller files, slower derivation");
#ifdef GPGP_CLI_SPAWN
  command
      ->add_option("--schedule", options->schedules,
                   "Schedule of the kernels that are baked with grammars, as for `gpgp spawn`. default, sgl, rw, "
                   "rules, heuristic or "
                   "groups as `gpgp graph` prints them: for all devices, so at most one of these; tuned, or a file of "
                   "`gpgp tune -o`: for the devices and numbers of axioms that they were tuned for. May be repeated")
      ->type_name("NAME|FILE")
      ->allow_extra_args(false)
      ->excludes(noKernel);
  addQueues(*command, options->queues, "; of what --schedule compiles");
  command->get_option("--queues")->excludes(noKernel);
  addGroupSize(*command, options->heuristics);
#endif
#ifdef GPGP_CLI_VECTOR
  command
      ->add_option(
          "--scale", options->scale,
          "The largest scale at which drawings are shown, in pixels per pixel of their page: strokes are off by "
          "less than a twentieth of a pixel there")
      ->check(within(1e-6, 1e6))
      ->capture_default_str();
  command
      ->add_option("--method", options->method,
                   "What the drawings are for: canvases (flattened), draws inside a render pass (in-pass), or both")
      ->check(CLI::IsMember({"flattened", "in-pass", "both"}))
      ->capture_default_str();
#endif
#ifdef GPGP_CLI_TEXT
  addBakeFontOptions(*command, options->font);
#ifdef GPGP_CLI_VECTOR
  command->add_option("--font", options->textFonts, "Font of the text in drawings; may be given several times")
      ->check(CLI::ExistingFile)
      ->type_name("FILE");
#endif
#endif
  command->footer(R"(
Examples:
  gpgp bake city.pga -o city.gpgp
  gpgp bake city.pga -o city.gpgp --schedule tuned --schedule default   tuned kernels, and for other devices default ones
  gpgp bake house.pga tree.pga lamp.pga --link -o street.gpgp      one grammar: one recording derives all of them
  gpgp bake old=a/house.pga new=b/house.pga --link -o houses.gpgp  their starts are old and new
  gpgp bake DejaVuSans.ttf -o latin.gpgpf --ranges U+0020-007E,U+00A0-00FF --characters "€–…"
  gpgp bake NotoNaskhArabic-Regular.ttf -o arabic.gpgpf --characters-file strings.txt --outline 0.1
  gpgp bake *.pga *.svg -o assets/                   one file each: assets/city.pga.gpgp, hud.svg.gpgpv
  gpgp bake icon.svg --scale 40 -o icon.gpgpv        24 pixels, shown at up to 960
  cat icon.svg | gpgp bake - -o - > icon.gpgpv       bytes say what standard input is

Of a font, glyphs that shaping makes of the chosen characters (ligatures, Arabic forms, alternates) are baked, too. A
glyph's key is its number in the font, and 2^32 more for its outline. Shaping still needs the font file.

A baked file depends on its input and this command's version alone (with --schedule tuned, also on what was tuned here), so it
can be made on any machine and cached.)");
  return [options](const CommonOptions& common) { return bake(*options, common); };
}

} // namespace gpgp::cli
