// Baked grammars: round trips, and that bytes which are not a grammar never get past load().
#include "grammars.h"
#include "random_grammar.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/language/append_graph.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

namespace {
using namespace gpgp;
using namespace gpgp::test;

std::span<const std::byte> bytesOf(const std::vector<uint32_t>& words) { return std::as_bytes(std::span(words)); }
auto load(const std::vector<uint32_t>& words) { return spawn::load(bytesOf(words), std::pmr::new_delete_resource()); }

/// Makes changed words pass the checksum, so that the checks behind it are reached.
void sign(std::vector<uint32_t>& words) {
  words[shader::kHeaderChecksum] = spawn::checksum(std::span(words).subspan(shader::kHeaderChecked));
}

/// What loads can be linked as well, with itself here.
void expectLinks(const spawn::Graph& graph) {
  spawn::Graph linked(std::pmr::new_delete_resource());
  spawn::addRegularPolygons(linked);
  spawn::Tags tags;
  spawn::Diagnostics diagnostics;
  for (const char* name : {"a", "b"}) spawn::appendGraph(graph, name, linked, tags, diagnostics);
  spawn::analyse(linked);
  if (const auto ok = spawn::validate(linked); !ok) ADD_FAILURE() << ok.error().text;
}

std::vector<std::vector<uint32_t>> grammars() {
  std::vector<std::vector<uint32_t>> result;
  for (const std::string& name : ownGrammarNames()) result.push_back(bake(ownGrammar(name)));
  for (uint32_t seed = 0; seed < 50; ++seed) result.push_back(bake(randomGrammar(seed)));
  return result;
}

TEST(Blob, RoundTrips) {
  for (const auto& words : grammars()) {
    const auto graph = load(words);
    ASSERT_TRUE(graph) << graph.error().text;
    const auto again = spawn::serialize(*graph, std::pmr::new_delete_resource());
    EXPECT_TRUE(std::equal(words.begin(), words.end(), again.begin(), again.end()));
  }
}

TEST(Blob, RandomGrammarsCompile) {
  for (uint32_t seed = 0; seed < 500; ++seed) EXPECT_NO_THROW(bake(randomGrammar(seed))) << randomGrammar(seed);
}

TEST(Blob, SaysWhatIsWrong) {
  const auto words = bake(ownGrammar("sponge.pga"));
  const auto message = [&](auto change) {
    auto changed = words;
    change(changed);
    const auto graph = load(changed);
    return graph ? std::string("accepted") : std::string(graph.error().text);
  };
  EXPECT_EQ(message([](auto& w) { w.clear(); }), "not a baked grammar: it is too short");
  EXPECT_EQ(message([](auto& w) { w[0] ^= 1; }), "not a baked grammar: it does not begin with \"gppg\"");
  EXPECT_EQ(message([](auto& w) { w[1] = 99; }), "the grammar was baked in format 99; this library reads format " +
                                                     std::to_string(shader::kGraphVersion) + ": bake it again");
  EXPECT_EQ(message([](auto& w) { w.pop_back(); }), "not a baked grammar: it was cut, or something follows it");
  EXPECT_EQ(message([](auto& w) { w[40] ^= 1; }), "not a baked grammar: its checksum is wrong");
  EXPECT_EQ(message([](auto& w) { w[shader::kHeaderSections + 3] += 1, sign(w); }),
            "not a baked grammar: a section is not where it should be");
  EXPECT_EQ(message([](auto& w) { w[shader::kHeaderSize] = 77, sign(w); }), "node 0 (?): unknown operator");
}

TEST(Blob, EveryWordIsChecked) {
  // Each word changed in several ways: refused, or still a grammar that can be derived.
  const auto words = bake(ownGrammar("shapes.pga"));
  const GpgpAxiom axiom = spawn::makeAxiom(4, 5, 6, 3);
  spawn::DeriveOptions options;
  options.maxShapes = 20000;
  size_t refused = 0;
  for (size_t i = shader::kHeaderChecked; i < words.size(); ++i)
    for (const uint32_t value :
         {0u, 1u, words[i] + 1, words[i] - 1, words[i] ^ 0x80000000u, 0x7fffffffu, 0xffffffffu}) {
      auto changed = words;
      changed[i] = value;
      sign(changed);
      if (const auto graph = load(changed)) {
        spawn::derive(changed, std::span(&axiom, 1), options);
        expectLinks(*graph);
      } else {
        ++refused;
      }
    }
  EXPECT_GT(refused, words.size());
}

TEST(Blob, RandomBytesAreRefused) {
  std::mt19937 random(5);
  for (int i = 0; i < 3000; ++i) {
    std::vector<uint32_t> words(random() % 200);
    for (uint32_t& word : words) word = static_cast<uint32_t>(random() % 3 ? random() % 64 : random());
    if (words.size() > shader::kHeaderSize) {
      words[shader::kHeaderMagic] = shader::kGraphMagic;
      words[shader::kHeaderVersion] = shader::kGraphVersion;
      words[shader::kHeaderWords] = static_cast<uint32_t>(words.size());
      sign(words);
    }
    EXPECT_FALSE(load(words));
  }
}

TEST(Blob, MutatedGrammarsNeverCrash) {
  std::mt19937 random(6);
  const auto all = grammars();
  const GpgpAxiom axiom = spawn::makeAxiom(4, 5, 6, 3);
  spawn::DeriveOptions options;
  options.maxShapes = 5000;
  size_t accepted = 0;
  for (int i = 0; i < 4000; ++i) {
    auto words = all[random() % all.size()];
    for (uint32_t n = 1 + random() % 4; n > 0; --n) {
      const size_t at = shader::kHeaderChecked + random() % (words.size() - shader::kHeaderChecked);
      words[at] = static_cast<uint32_t>(random() % 2   ? words[random() % words.size()]
                                        : random() % 8 ? random() % 100
                                                       : random());
    }
    sign(words);
    const auto graph = load(words);
    if (!graph) continue;
    ++accepted;
    expectLinks(*graph);
    spawn::derive(words, std::span(&axiom, 1), options);
  }
  EXPECT_GT(accepted, 100u); // numbers and names may change freely
}

} // namespace
