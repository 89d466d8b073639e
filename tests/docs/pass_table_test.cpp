// docs/internals/passes.md lists what each pass reads and writes. It is made from the pass lists that recorders are
// made from, and this test fails where it is out of date:
//
//   pass_table_test          compares
//   pass_table_test --write  writes it
#include "pass_lists.h"

#include "host/files.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <tuple>

namespace {
using namespace gpgp;

/// From SPIR-V to its source below shaders/.
class ShaderFiles {
public:
  ShaderFiles() {
    std::ifstream list(GPGP_SHADER_FILES);
    for (std::string name, file; list >> name >> file;) {
      const std::vector<uint8_t> bytes = host::readFile(std::string(GPGP_SHADER_FOLDER "/") + name + ".spv");
      files_.try_emplace({bytes.begin(), bytes.end()}, Shader{name, file}); // the library's come before tests'
    }
  }
  std::string of(const core::ShaderDesc& shader) const { return at(shader).file; }
  std::string nameOf(const core::ShaderDesc& shader) const { return at(shader).name; }

private:
  struct Shader {
    std::string name, file; // name: file and defines
  };
  const Shader& at(const core::ShaderDesc& shader) const {
    const auto code = core::ShaderWords::of(shader.spirv, std::pmr::get_default_resource());
    if (!code) throw std::runtime_error(code.error().text);
    const auto* bytes = reinterpret_cast<const uint8_t*>(code->words().data());
    const auto found = files_.find({bytes, bytes + code->words().size_bytes()});
    if (found == files_.end()) throw std::runtime_error(std::string("no source for the shader of ") + shader.name);
    return found->second;
  }

  std::map<std::vector<uint8_t>, Shader> files_;
};

struct Row {
  std::string name, file;
  std::set<std::string> reads, writes;
};

/// A pass without its form: "mark, several drawings" and "raster rgba8" are forms of mark and raster.
std::string withoutForm(std::string name) {
  name = name.substr(0, name.find(", "));
  for (const char* form : {" rgba8", " rgba16f"})
    if (name.ends_with(form)) name.resize(name.size() - std::strlen(form));
  return name;
}
/// One of several of a kind: "drawing 3" is one of the drawings, "images[3]" of the images.
std::string withoutNumber(const std::string& name) {
  if (name.starts_with("drawing ")) return "drawings";
  return name.substr(0, name.find('['));
}

std::string joined(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "–" : text;
}

std::string tableOf(const core::PassList& list, const ShaderFiles& files) {
  std::vector<Row> rows;
  for (const core::Pass& pass : list.passes) {
    const std::string name = withoutForm(pass.name);
    const bool fills = pass.kind == core::PassKind::fill;
    const std::string file = fills ? "(fill)" : files.of(list.shaders[pass.shader]);
    auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.name == name && r.file == file; });
    if (row == rows.end()) row = rows.insert(rows.end(), Row{name, file, {}, {}});
    const auto nameOf = [&](core::ResourceIndex resource) { return withoutNumber(list.resources[resource].name); };
    if (fills) row->writes.insert(nameOf(pass.target));
    if (pass.kind == core::PassKind::dispatchIndirect) row->reads.insert(nameOf(pass.target));
    for (uint32_t u = 0; u < pass.useCount; ++u) {
      const core::Use& use = pass.uses[u];
      if (use.kind != core::UseKind::write) row->reads.insert(nameOf(use.resource));
      if (use.kind == core::UseKind::write || use.kind == core::UseKind::readWrite)
        row->writes.insert(nameOf(use.resource));
    }
  }
  for (size_t r = 0; r + 1 < rows.size();) { // neighbours that differ in nothing that the table has share a row
    const Row& next = rows[r + 1];
    if (next.file == rows[r].file && next.reads == rows[r].reads && next.writes == rows[r].writes) {
      rows[r].name += ", " + next.name;
      rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(r + 1));
    } else {
      ++r;
    }
  }
  std::string text = "| pass | file | reads | writes |\n|---|---|---|---|\n";
  for (const Row& row : rows)
    text += "| " + row.name + " | `" + row.file + "` | " + joined(row.reads) + " | " + joined(row.writes) + " |\n";
  return text;
}

/// Which form of the interpreter each kind of device has.
std::string interpreters(const ShaderFiles& files) {
  std::string text = "| device | without colliders | with colliders |\n|---|---|---|\n";
  for (const auto& [name, software, subgroups] : {std::tuple("hardware", false, true),
                                                  {"hardware without subgroup arithmetic", false, false},
                                                  {"software", true, true},
                                                  {"software without subgroup arithmetic", true, false}})
    text += std::string("| ") + name + " | `" + files.nameOf(test::interpreterOf(software, subgroups, false)) +
            "` | `" + files.nameOf(test::interpreterOf(software, subgroups, true)) + "` |\n";
  return text;
}

std::string page() {
  const ShaderFiles files;
  return "# Passes\n\n"
         "Each recorder has a list of passes. From it come barriers, scratch, labels, timestamps.\n"
         "`pass_table_test --write` makes these tables and tests them. Files lie below\n"
         "`shaders/`. Forms of a pass, of which a recording runs one, share a row, as do passes of one\n"
         "file with the same resources. What they do is in [spawn](spawn.md), [vector](vector.md),\n"
         "[visibility](visibility.md) and [atlas](atlas.md).\n\n"
         "## Spawn\n\nOf ordered instances, with colliders:\n\n" +
         tableOf(test::spawnPasses(false), files) + "\nOf ordered vertices:\n\n" +
         tableOf(test::spawnPasses(true), files) +
         "\nForms of the interpreter, which pass `derive` runs for grammars without a kernel:\n\n" +
         interpreters(files) + "\n## Vector\n\n" + tableOf(test::canvasPasses(false), files) +
         "\n### On software devices\n\n" + tableOf(test::canvasPasses(true), files) +
         "\n## Visibility\n\nWith all methods. Without 64-bit atomics there are passes `ids`, too.\n\n" +
         tableOf(test::visibilityPasses(), files) + "\n### Shading atlas\n\n" + tableOf(test::atlasPasses(), files);
}
} // namespace

int main(int count, char** arguments) try {
  const char* path = GPGP_DOCS "/internals/passes.md";
  const std::string text = page();
  if (count > 1 && !std::strcmp(arguments[1], "--write")) {
    std::ofstream(path) << text;
    return 0;
  }
  std::ifstream file(path);
  std::stringstream found;
  found << file.rdbuf();
  if (found.str() == text) return 0;
  std::fprintf(stderr, "%s is out of date: run pass_table_test --write\n", path);
  return 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
