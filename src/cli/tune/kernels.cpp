#include "cli/tune/kernels.h"

#include "cli/shared/command.h"
#include "cli/shared/messages.h"
#include "cli/shared/processors.h"
#include "host/files.h"
#include "spawn/codegen/compile_kernel.h"
#include "spawn/graph/blob.h"
#include "spawn/language/print.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace gpgp::cli {
namespace {

std::pmr::memory_resource* memory() { return std::pmr::new_delete_resource(); }

/// Subgroup arithmetic, ballots and shuffles in compute shaders.
bool hasSubgroups(const host::HeadlessDevice& device) {
  VkPhysicalDeviceSubgroupProperties subgroups{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &subgroups};
  device.vki().getPhysicalDeviceProperties2(device.physicalDevice(), &properties);
  constexpr VkSubgroupFeatureFlags kWanted =
      VK_SUBGROUP_FEATURE_ARITHMETIC_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT | VK_SUBGROUP_FEATURE_SHUFFLE_BIT;
  return (subgroups.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) &&
         (subgroups.supportedOperations & kWanted) == kWanted;
}
bool canRun(const host::HeadlessDevice& device, spawn::KernelTarget target) {
  return target == spawn::KernelTarget::any ||
         (hasSubgroups(device) && (target == spawn::KernelTarget::subgroups || device.isSoftware()));
}

/// Software devices compare by vendor and model like all others.
bool isFor(const spawn::KernelInfo& info, const host::HeadlessDevice& device) {
  const auto& properties = device.properties();
  return (info.vendor == 0 || info.vendor == properties.vendorID) &&
         (info.device == 0 || info.device == properties.deviceID) && canRun(device, info.target);
}

} // namespace

std::vector<NamedStart> BakedGraph::namedStarts() const {
  std::vector<NamedStart> starts;
  for (uint32_t i = 0; i < spawn::startCount(graph); ++i) {
    const spawn::Start start = spawn::startAt(graph, i);
    starts.push_back({start.name, spawn::shapeName(start.axiom->shape)});
  }
  return starts;
}

std::vector<uint32_t> BakedGraph::starts() const {
  const auto isLinked = [&](const auto& entry) { return std::strchr(graph.nameAt(entry.name), '.') != nullptr; };
  if (std::none_of(graph.terminals.begin(), graph.terminals.end(), isLinked) &&
      std::none_of(graph.rules.begin(), graph.rules.end(), isLinked))
    return {GPGP_AXIOM_DEFAULT_START};
  std::vector<uint32_t> starts;
  for (size_t a = 0; a < graph.axioms.size(); ++a) // a grammar's first axiom has its name alone
    if (!isLinked(graph.axioms[a])) starts.push_back(static_cast<uint32_t>(graph.rules.size() + a));
  return starts;
}

BakedGraph bakeGraph(const std::vector<std::string>& files, const std::vector<std::string>& set) {
  std::vector<GrammarText> texts;
  for (const std::string& argument : files) {
    const GrammarFile file(argument);
    texts.push_back({file, host::readText(file.path)});
  }
  return bakeGraph(texts, files.size() > 1 || !texts.at(0).file.alias.empty(), set);
}

BakedGraph bakeGraph(std::span<const GrammarText> texts, bool linked, const std::vector<std::string>& set) {
  const Blob blob = linked ? linkGrammars(texts, set, false) : compileGrammar(texts[0], set, false);
  const auto* bytes = static_cast<const std::byte*>(blob.data());
  auto graph = spawn::load({bytes, blob.size()}, memory());
  if (!graph) throw Failure(texts[0].file.path + ": " + graph.error().text);
  std::pmr::vector<uint32_t> words(blob.size() / sizeof(uint32_t), memory());
  std::memcpy(words.data(), bytes, blob.size());
  return {std::move(words), std::move(*graph)};
}

BakedGraph bakeText(const std::string& file, const std::string& text) {
  GrammarText grammar{GrammarFile(file), text};
  grammar.file.path += ".pga"; // what it is now
  return bakeGraph({&grammar, 1}, false, {});
}

std::string joined(const std::vector<std::string>& files) {
  std::string text;
  for (const std::string& file : files) text += (text.empty() ? "" : " + ") + file;
  return text;
}

Json jsonOf(const std::vector<std::string>& files) { return files.size() == 1 ? Json(files[0]) : Json(files); }

void addGroupSize(CLI::App& command, spawn::Heuristics& heuristics) {
  command
      .add_option("--group-size", heuristics.minimumGroupSize,
                  "heuristic: nodes that a group should have, t of the thesis's H3; 0 switches that off")
      ->check(CLI::Range(0u, 1000000u))
      ->capture_default_str();
}

std::optional<spawn::Schedule> scheduleFor(const spawn::Graph& graph, const std::string& nameOrFile,
                                           const spawn::Heuristics& heuristics) {
  if (auto named = spawn::namedSchedule(graph, nameOrFile, heuristics)) return named;
  if (!std::filesystem::is_regular_file(nameOrFile)) return std::nullopt;
  spawn::Diagnostics diagnostics;
  const auto partition = spawn::parseGroups(host::readText(nameOrFile), graph, diagnostics);
  report(diagnostics, nameOrFile);
  spawn::Roots roots(graph.nodes.size(), spawn::kNoNode);
  for (size_t n = 0; n < roots.size(); ++n)
    if (partition->groupOf[n] != spawn::kNoGroup) roots[n] = partition->groups[partition->groupOf[n]].root;
  return spawn::scheduleOf(graph, spawn::makeFlow(graph), roots, std::filesystem::path(nameOrFile).stem().string());
}

void addQueues(CLI::App& command, std::string& queues, const std::string& unless) {
  std::vector<std::string> kinds{"group", "mixed"};
  if (queues == "both") kinds.push_back(queues);
  command
      .add_option("--queues", queues,
                  "Where the shapes of a workgroup wait. group: each execution group has a queue, and only shapes of "
                  "one group run together; mixed: all on one stack" +
                      unless)
      ->check(CLI::IsMember(kinds))
      ->capture_default_str();
}

spawn::KernelTarget targetFor(const host::HeadlessDevice& device, const spawn::Graph& graph, spawn::Queues queues) {
  for (const spawn::KernelTarget target : spawn::targetsOf(graph, queues))
    if (canRun(device, target)) return target;
  return spawn::KernelTarget::any;
}

std::vector<KernelCode> compileKernels(const spawn::Graph& graph, std::span<const spawn::Schedule> schedules,
                                       const host::HeadlessDevice& device, bool matching) {
  std::vector<KernelCode> kernels(schedules.size());
  onAllProcessors(schedules.size(), [&](size_t i) {
    const spawn::Schedule& schedule = schedules[i];
    auto code =
        spawn::compileKernel(spawn::sourceOf(graph, schedule, matching), targetFor(device, graph, schedule.queues));
    if (!code) throw Failure(schedule.name + ": " + code.error().text);
    kernels[i] = std::move(*code);
  });
  return kernels;
}

std::vector<KernelCode> compileOrSay(const spawn::Graph& graph, const spawn::Schedule& schedule,
                                     std::span<const spawn::KernelTarget> targets, bool matching,
                                     const std::string& grammar) {
  const auto source = spawn::sourceOf(graph, schedule, matching);
  const auto say = [&](const char* kind, const std::string& text) {
    std::fprintf(stderr, "%s\n", printable(grammar + kind + text).c_str());
  };
  const bool compiles = spawn::isWorthCompiling(source);
  if (const std::string remark = spawn::remarkOn(source); !remark.empty())
    say(compiles ? ": note: " : ": warning: ", remark);
  std::vector<KernelCode> kernels(targets.size());
  for (size_t i = 0; compiles && i < targets.size(); ++i) {
    auto code = spawn::compileKernel(source, targets[i]);
    if (code)
      kernels[i] = std::move(*code);
    else
      say(": warning: ", spawn::kInterpreted + std::string(code.error().text));
  }
  return kernels;
}

spawn::KernelInfo kernelInfo(const spawn::Schedule& schedule, spawn::KernelTarget target) {
  spawn::KernelInfo info;
  info.target = target;
  info.groups = static_cast<uint32_t>(schedule.groups);
  info.queues = schedule.queues;
  std::snprintf(info.schedule, sizeof info.schedule, "%s", schedule.name.c_str());
  return info;
}

std::pmr::vector<uint32_t> kernelWords(const BakedGraph& grammar, const spawn::KernelInfo& info,
                                       std::span<const uint32_t> code) {
  return spawn::serialize(info, code, grammar.words[shader::kHeaderChecksum], memory());
}

std::pmr::vector<uint32_t> withKernels(const BakedGraph& grammar, const std::vector<std::string>& files,
                                       const std::vector<std::string>& schedules, const spawn::Heuristics& heuristics,
                                       spawn::Queues queues) {
  std::pmr::vector<uint32_t> all(grammar.words);
  const auto append = [&](const spawn::KernelInfo& info, std::span<const uint32_t> code) {
    const auto words = kernelWords(grammar, info, code);
    all.insert(all.end(), words.begin(), words.end());
  };
  const std::string* forAll = nullptr;
  for (const std::string& name : schedules) {
    const bool tuned = name == "tuned";
    if (tuned || (!spawn::namedSchedule(grammar.graph, name) && isBaked(name))) {
      const std::filesystem::path file = tuned ? tunedFile(files, grammar) : std::filesystem::path(name);
      if (tuned && !std::filesystem::exists(file))
        throw Failure(joined(files) + ": no tuned schedule is stored; `gpgp tune` finds one");
      const auto kernels = kernelsIn(file, grammar);
      if (kernels.empty()) throw Failure(file.string() + " holds no kernel");
      for (const spawn::Kernel& kernel : kernels) append(kernel.info, kernel.code);
      continue;
    }
    auto schedule = scheduleFor(grammar.graph, name, heuristics);
    if (!schedule)
      throw Usage("--schedule takes default, sgl, rw, rules, heuristic, tuned or a file; there is no \"" + name + "\"");
    if (forAll)
      throw Usage("--schedule " + *forAll + " is for all devices, so " + name +
                  " would never run; one of them, and tuned ones, go into a file");
    forAll = &name;
    if (queues == spawn::Queues::groups) schedule = withQueues(std::move(*schedule));
    const auto targets = spawn::targetsOf(grammar.graph, queues); // the first that a device can run is taken
    const auto kernels = compileOrSay(grammar.graph, *schedule, targets, false, joined(files));
    for (size_t i = 0; i < targets.size(); ++i)
      if (!kernels[i].empty()) append(kernelInfo(*schedule, targets[i]), kernels[i]);
  }
  return all;
}

bool isBaked(const std::filesystem::path& file) {
  return std::filesystem::is_regular_file(file) && host::readText(file).starts_with("gppg");
}

std::pmr::vector<spawn::Kernel> kernelsIn(const std::filesystem::path& file, const BakedGraph& grammar) {
  const std::string text = host::readText(file);
  const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
  const size_t graphBytes = spawn::sizeOfGraph(bytes);
  const bool same =
      graphBytes == grammar.words.size() * 4 && std::memcmp(text.data(), grammar.words.data(), graphBytes) == 0;
  if (!same && (text.empty() || text.starts_with("gppg")))
    if (const auto other = spawn::load(bytes.first(graphBytes), memory()); !other)
      throw Unusable(file.string() + ": " + other.error().text);
  if (!same) throw Failure(file.string() + " is not a baking of this grammar, with the variables as they are set here");
  auto kernels = spawn::loadKernels(bytes.subspan(graphBytes), grammar.words[shader::kHeaderChecksum], memory());
  if (!kernels) throw Unusable(file.string() + ": " + kernels.error().text);
  return std::move(*kernels);
}

std::pmr::vector<spawn::Kernel> storedKernels(const std::filesystem::path& file, const BakedGraph& grammar,
                                              bool cache) {
  if (!std::filesystem::exists(file)) return {};
  try {
    return kernelsIn(file, grammar);
  } catch (const Unusable& error) {
    std::fprintf(stderr, "gpgp: %s; its contents are made anew\n", error.what());
  } catch (const Failure& error) { // not the command's own file
    if (!cache) throw;
    std::fprintf(stderr, "gpgp: %s; its contents are made anew\n", error.what());
  }
  return {};
}

std::optional<spawn::Kernel> kernelFor(std::span<const spawn::Kernel> kernels, const host::HeadlessDevice& device,
                                       uint32_t axioms) {
  const auto distance = [&](const spawn::Kernel& kernel) { // as the library's Grammar::kernelFor
    return kernel.info.axioms ? std::abs(static_cast<int>(std::bit_width(kernel.info.axioms)) -
                                         static_cast<int>(std::bit_width(axioms)))
                              : 64;
  };
  const spawn::Kernel* best = nullptr;
  for (const spawn::Kernel& kernel : kernels)
    if (isFor(kernel.info, device) && (!best || distance(kernel) < distance(*best))) best = &kernel;
  return best ? std::optional(*best) : std::nullopt;
}

bool isTunedFor(const spawn::KernelInfo& info, const host::HeadlessDevice& device, uint32_t axioms) {
  const auto& properties = device.properties();
  return info.vendor == properties.vendorID && info.device == properties.deviceID && info.axioms &&
         std::bit_width(info.axioms) == std::bit_width(axioms);
}

void keepKernel(const std::filesystem::path& file, const BakedGraph& grammar, const spawn::KernelInfo& info,
                std::span<const uint32_t> code, std::span<const spawn::Kernel> others) {
  std::pmr::vector<uint32_t> all(grammar.words);
  const auto append = [&](const spawn::KernelInfo& i, std::span<const uint32_t> kernel) {
    const auto words = kernelWords(grammar, i, kernel);
    all.insert(all.end(), words.begin(), words.end());
  };
  append(info, code);
  for (const spawn::Kernel& other : others)
    if (other.info.vendor != info.vendor || other.info.device != info.device ||
        std::bit_width(other.info.axioms) != std::bit_width(info.axioms))
      append(other.info, other.code);
  host::writeFile(file, {reinterpret_cast<const char*>(all.data()), all.size() * 4});
}

void checkWritable(const std::filesystem::path& file) {
  const bool there = std::filesystem::exists(file);
  std::error_code ignored; // opening the file says what is wrong
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  errno = 0;
  if (!std::ofstream(file, std::ios::app))
    throw Failure(file.string() + ": " + (errno ? std::strerror(errno) : "cannot be written"));
  if (!there) std::filesystem::remove(file, ignored);
}

std::filesystem::path tunedFile(const std::vector<std::string>& files, const BakedGraph& grammar) {
  const auto folder = [](const char* variable) {
    const char* value = std::getenv(variable);
    return std::filesystem::path(value ? value : "");
  };
  std::filesystem::path cache = folder("XDG_CACHE_HOME");
  if (cache.empty() && !folder("HOME").empty()) cache = folder("HOME") / ".cache";
  if (cache.empty()) cache = folder("LOCALAPPDATA");
  if (cache.empty())
    throw Failure("none of XDG_CACHE_HOME, HOME and LOCALAPPDATA says where tuned kernels could be kept");
  char sum[24];
  std::snprintf(sum, sizeof sum, "-%08x-%zu", grammar.words[shader::kHeaderChecksum], grammar.words.size());
  std::string names;
  for (const std::string& file : files)
    names += (names.empty() ? "" : "+") + std::filesystem::path(file).stem().string();
  names.resize(std::min<size_t>(names.size(), 128)); // the sum tells them apart
  return cache / "gpgp" / (names + sum + ".gpgp");
}

} // namespace gpgp::cli
