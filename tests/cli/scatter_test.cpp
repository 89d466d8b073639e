// `gpgp spawn --scatter`: points by pictures of density and terrain. The library's own tests have the pattern.
#include "files.h"
#include "host/picture.h"
#include "run.h"

namespace gpgp::test {
namespace {

TEST(CliScatter, ScattersByPictures) {
  host::Picture half{2, 1, {0, 0, 0, 255, 255, 255, 255, 255}};
  const TemporaryFile grammar("box.pga", "axiom Box A;\nterminal T (1, 0);\nA = T;\n"), png("half.png"),
      picture("scattered.png");
  host::writePng(png.path(), half);
  const json all = gpgpJson({"spawn", grammar.path(), "--scatter", "2", "--area", "60,40", "--validate"});
  const double expected = 0.59 * 60 * 40 / 4;
  EXPECT_NEAR(all["axioms"].get<double>(), expected, 0.1 * expected);
  EXPECT_EQ(all["terminals"], all["axioms"]);
  const json some = gpgpJson({"spawn", grammar.path(), "--scatter", "2", "--area", "60,40", "--density", png.path(),
                              "--terrain", png.path(), "--terrain-height", "30", "--image", picture.path()});
  EXPECT_NEAR(some["axioms"].get<double>(), expected / 2, 0.15 * expected);
  EXPECT_NE(gpgpJson({"spawn", grammar.path(), "--scatter", "2", "--area", "60,40", "--seed", "2"})["key_hash"],
            all["key_hash"]);
  const TemporaryFile plant("plant.lsys", "axiom: F\niterations: 1\nF --> FF\n");
  expectWrongUsage({{"spawn", grammar.path(), "--scatter", "0"},
                    {"spawn", grammar.path(), "--scatter", "1", "--axioms", "4"},
                    {"spawn", grammar.path(), "--scatter", "1", "--spacing", "4"},
                    {"spawn", grammar.path(), "--scatter", "1", "--area", "5000,1"},
                    {"spawn", grammar.path(), "--area", "5,1"},
                    {"spawn", grammar.path(), "--scatter", "1", "--terrain-height", "4"},
                    {"spawn", plant.path(), "--scatter", "1"}});
}

} // namespace
} // namespace gpgp::test
