#include "live_cga.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <thread>

namespace mini {
namespace {

/// The engine's job system, where there is one; here, threads for the time of a call.
void GPGP_CALL parallelFor(void*, uint32_t count, GpgpJobFn job, void* argument) {
  std::atomic<uint32_t> next{0};
  const auto work = [&] {
    for (uint32_t i = next++; i < count; i = next++) job(argument, i);
  };
  std::vector<std::thread> threads;
  for (uint32_t i = 1; i < std::min(count, std::thread::hardware_concurrency()); ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
}
constexpr GpgpJobSystem kJobs = {nullptr, &parallelFor};

/// Errors are kept, warnings printed.
void GPGP_CALL onMessage(void* user, const GpgpCompileMessage* m) {
  if (m->severity == GPGP_SEVERITY_ERROR)
    static_cast<std::vector<LiveError>*>(user)->push_back(
        {m->file, m->text, m->line, m->column, lineOf(readText(m->file).value_or(""), m->line)});
  else if (m->severity == GPGP_SEVERITY_WARNING)
    std::fprintf(stderr, "%s:%u:%u: %s\n", m->file, m->line, m->column, m->text);
}

/// Those that a panel can show, in the order in which the file wants them.
std::vector<LiveAttribute> attributesOf(const gpgp::CgaProgram& program) {
  uint32_t count = 0;
  if (program.attributes(count, nullptr) < 0) return {};
  std::vector<GpgpCgaAttribute> all(count);
  if (program.attributes(count, all.data()) < 0) return {};
  std::stable_sort(all.begin(), all.end(), [](const GpgpCgaAttribute& a, const GpgpCgaAttribute& b) {
    return std::pair(a.groupOrder, a.order) < std::pair(b.groupOrder, b.order);
  });
  std::vector<LiveAttribute> attributes;
  for (const GpgpCgaAttribute& from : all) {
    if (from.flags & GPGP_CGA_ATTRIBUTE_HIDDEN) continue;
    LiveAttribute to;
    to.name = from.name;
    to.description = from.description;
    to.written = from.text;
    for (uint32_t g = 0; g < from.groupCount; ++g) to.group += (g ? " / " : "") + std::string(from.groups[g]);
    to.choices.assign(from.choices, from.choices + from.choiceCount);
    if (!to.choices.empty() && from.type != GPGP_CGA_BOOLEAN) {
      to.kind = LiveAttribute::choice;
    } else if (from.type == GPGP_CGA_BOOLEAN) {
      to.kind = LiveAttribute::boolean;
    } else if (from.type == GPGP_CGA_NUMBER) {
      const float value = static_cast<float>(from.number), reach = value != 0 ? 2 * value : 1;
      to.min = std::isnan(from.min) ? std::min(reach, 0.0f) : static_cast<float>(from.min);
      to.max = std::isnan(from.max) ? std::max({reach, to.min + 1}) : static_cast<float>(from.max);
      to.step = std::isnan(from.step) ? 0 : static_cast<float>(from.step);
      to.value = std::clamp(value, to.min, std::max(to.min, to.max));
      if (!(to.min < to.max)) continue;
    } else if (from.type == GPGP_CGA_STRING && (from.flags & GPGP_CGA_ATTRIBUTE_COLOR)) {
      to.kind = LiveAttribute::colour;
    } else {
      continue;
    }
    if (to.kind != LiveAttribute::number && !to.parse(from.text) && to.kind == LiveAttribute::colour) continue;
    attributes.push_back(std::move(to));
  }
  // Of groups without an order, each together.
  std::vector<std::string> groups;
  for (const LiveAttribute& attribute : attributes)
    if (std::find(groups.begin(), groups.end(), attribute.group) == groups.end()) groups.push_back(attribute.group);
  const auto place = [&](const LiveAttribute& a) { return std::find(groups.begin(), groups.end(), a.group); };
  std::stable_sort(attributes.begin(), attributes.end(),
                   [&](const LiveAttribute& a, const LiveAttribute& b) { return place(a) < place(b); });
  return attributes;
}

TownMesh meshOf(const GpgpCgaDerivationResult& result) {
  TownMesh mesh;
  mesh.vertices.resize(result.vertexCount);
  for (uint32_t v = 0; v < result.vertexCount; ++v) {
    std::copy_n(result.vertices[v].position, 3, mesh.vertices[v].position);
    std::copy_n(result.vertices[v].normal, 3, mesh.vertices[v].normal);
  }
  mesh.indices.assign(result.indices, result.indices + result.indexCount);
  for (uint32_t l = 0; l < result.leafCount; ++l) { // a vertex belongs to one leaf
    const GpgpCgaLeaf& leaf = result.leaves[l];
    for (uint32_t i = 0; i < leaf.indexCount; ++i)
      std::copy_n(leaf.color, 3, mesh.vertices[mesh.indices[leaf.firstIndex + i]].colour);
  }
  mesh.hash = hashOf(result);
  return mesh;
}

} // namespace

uint64_t hashOf(const GpgpCgaDerivationResult& result) {
  uint64_t hash = 14695981039346656037u;
  const auto add = [&](uint32_t word) { hash = (hash ^ word) * 1099511628211u; };
  for (uint32_t v = 0; v < result.vertexCount; ++v) {
    uint32_t words[3];
    std::memcpy(words, result.vertices[v].position, sizeof words);
    for (const uint32_t word : words) add(word);
  }
  for (uint32_t i = 0; i < result.indexCount; ++i) add(result.indices[i]);
  return hash;
}

LiveCga::LiveCga(std::string file, std::vector<GpgpCgaLot> lots) : LiveFile(std::move(file)), lots_(std::move(lots)) {}

GpgpResult LiveCga::read(void* user, const char* path, void* data, size_t capacity, size_t* size) {
  const std::optional<std::string> text = readText(path);
  if (!text) return GPGP_ERROR_IO;
  *size = text->size();
  if (!data) return GPGP_SUCCESS;
  static_cast<LiveCga*>(user)->imports_[path] = *text;
  std::memcpy(data, text->data(), std::min(capacity, text->size()));
  return GPGP_SUCCESS;
}

std::string LiveCga::stamp() const {
  std::string all = text_;
  for (const auto& [path, before] : imports_)
    if (path != file_) all += '\0' + readText(path).value_or(before);
  return all;
}

std::optional<TownMesh> LiveCga::update() {
  if (std::optional<std::string> text = readText(file_)) text_ = *std::move(text);
  if (const std::string now = stamp(); now != tried_) {
    auto mesh = derive(true);
    tried_ = stamp(); // with what is imported now
    if (mesh) {
      errors_.clear();
      changed_ = false;
      ++version_;
      return mesh;
    }
  } else {
    showErrors();
  }
  if (!program_ || !std::exchange(changed_, false)) return std::nullopt;
  std::vector<LiveError> ofFile = std::move(found_);
  auto mesh = derive(false);
  if (!mesh) { // as beyond a limit
    errors_ = std::move(found_);
    ++version_;
  }
  found_ = std::move(ofFile);
  if (mesh) ++version_;
  return mesh;
}

/// again: by the file as it is; else by the program that is shown, with other values.
std::optional<TownMesh> LiveCga::derive(bool again) {
  const auto start = std::chrono::steady_clock::now();
  found_.clear();
  heard_.clear();
  const auto failed = [&](GpgpResult code) {
    found_ = std::exchange(heard_, {});
    if (found_.empty()) found_.push_back({file_, gpgpResultString(code), 0, 0, {}});
    return std::nullopt;
  };
  gpgp::CgaProgram made;
  if (again) {
    auto info = gpgp::init<GpgpCgaProgramCreateInfo>();
    info.name = file_.c_str();
    info.text = text_.data();
    info.size = text_.size();
    info.fileSystem = &files_;
    info.jobSystem = &kJobs;
    info.messageFn = &onMessage;
    info.messageUserData = &heard_;
    gpgp::Result<gpgp::CgaProgram> program = gpgp::CgaProgram::create(info);
    if (!program) return failed(program.code());
    made = *std::move(program);
  }
  gpgp::CgaProgram& program = again ? made : program_;
  std::vector<LiveAttribute> attributes = again ? attributesOf(program) : attributes_;
  if (again) keepValues(attributes);
  std::vector<std::string> texts;
  for (const LiveAttribute& attribute : attributes) texts.push_back(attribute.text());
  std::vector<GpgpCgaValue> values;
  for (size_t i = 0; i < attributes.size(); ++i)
    if (attributes[i].given) values.push_back({attributes[i].name.c_str(), texts[i].c_str()});
  gpgp::Result<gpgp::CgaDerivation> derivation = program.derivation();
  if (!derivation) return failed(derivation.code());
  auto info = gpgp::init<GpgpCgaDerivationInfo>();
  info.lots = lots_.data();
  info.lotCount = static_cast<uint32_t>(lots_.size());
  info.values = values.data();
  info.valueCount = static_cast<uint32_t>(values.size());
  info.messageFn = &onMessage;
  info.messageUserData = &heard_;
  if (const GpgpResult code = derivation->derive(info); code < 0) return failed(code);
  const GpgpCgaDerivationResult result = *derivation->result();
  if (result.status != GPGP_SUCCESS) return failed(result.status);
  TownMesh mesh = meshOf(result);
  derivation = gpgp::Result<gpgp::CgaDerivation>(GPGP_SUCCESS, gpgp::CgaDerivation()); // before its program
  if (again) {
    program_ = std::move(made);
    attributes_ = std::move(attributes);
  }
  compileMilliseconds_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return mesh;
}

} // namespace mini
