/* Grammars made in code: the sponge and the house of samples/grammars/, bit for bit as their text gives them.
 *
 * C99, libgpgp_compiler; no GPU. Prints how large they are once baked; gpgpCreateGrammar takes such bytes as they are.
 * An engine makes grammars so where they come from its own editor, or from another language's front end. */
#include <gpgp/spawn_builder.h>

#include <stdio.h>

void buildSponge(GpgpGrammarBuilder builder);
void buildHouse(GpgpGrammarBuilder builder);

/* Values that both use, and operators with one value or one successor, to keep the grammars readable. */
static const GpgpGrammarValue kX = GPGP_GRAMMAR_VALUE(GPGP_VALUE_X), kY = GPGP_GRAMMAR_VALUE(GPGP_VALUE_Y),
                              kZ = GPGP_GRAMMAR_VALUE(GPGP_VALUE_Z);

static GpgpGrammarValue number(float value) {
  const GpgpGrammarValue made = GPGP_GRAMMAR_NUMBER(value);
  return made;
}

static GpgpGrammarSuccessor named(const char* name) {
  const GpgpGrammarSuccessor to = {GPGP_GRAMMAR_VALUE(GPGP_VALUE_NONE), name, 0};
  return to;
}

static GpgpGrammarSuccessor further(GpgpGrammarOperator op) {
  const GpgpGrammarSuccessor to = {GPGP_GRAMMAR_VALUE(GPGP_VALUE_NONE), NULL, op};
  return to;
}

/* Name = SubDiv(axis) { a: first | b: second | c: third }; NULL discards. */
static void thirds(GpgpGrammarBuilder builder, const char* name, GpgpGrammarValue axis, const float lengths[3],
                   const char* const parts[3]) {
  GpgpGrammarSuccessor to[3];
  int i;
  for (i = 0; i < 3; ++i) {
    to[i] = parts[i] ? named(parts[i]) : further(gpgpAddOperator(builder, GPGP_OPERATOR_DISCARD, NULL, 0, NULL, 0));
    to[i].value = number(lengths[i]);
  }
  gpgpAddRule(builder, name, NULL, gpgpAddOperator(builder, GPGP_OPERATOR_SUB_DIV, &axis, 1, to, 3));
}

/* menger_sponge_3.pga */
void buildSponge(GpgpGrammarBuilder builder) {
  static const float equal[3] = {-1, -1, -1};
  const char* const split[3] = {"Face", "Core", "Face"};
  const char* const face[3] = {"Bar", "Ends", "Bar"};
  const char* const core[3] = {"Ends", NULL, "Ends"};
  const char* const bar[3] = {"Sponge", "Sponge", "Sponge"};
  const char* const ends[3] = {"Sponge", NULL, "Sponge"};
  const GpgpGrammarValue stop = gpgpAddVariable(builder, "stop", number(0.05f));
  const GpgpGrammarValue size[2] = {kX, stop};
  const GpgpGrammarSuccessor next[2] = {named("Cube"), named("Thirds")};
  gpgpAddAxiom(builder, GPGP_SHAPE_BOX, NULL, 0, "Sponge");
  gpgpAddTerminal(builder, "Cube", 1, 13);
  /* names may be used before what they name is there */
  gpgpAddRule(builder, "Sponge", NULL, gpgpAddOperator(builder, GPGP_OPERATOR_IF_SIZE_LESS, size, 2, next, 2));
  thirds(builder, "Thirds", kX, equal, split);
  thirds(builder, "Face", kY, equal, face);
  thirds(builder, "Core", kY, equal, core);
  thirds(builder, "Bar", kZ, equal, bar);
  thirds(builder, "Ends", kZ, equal, ends);
}

/* simple_house.pga */
void buildHouse(GpgpGrammarBuilder builder) {
  static const float across[3] = {-1, 1.3f, -1}, upwards[3] = {1, 1.4f, -1};
  const char* const tileParts[3] = {"Wall", "Opening", "Wall"};
  const char* const openingParts[3] = {"Wall", "Window", "Wall"};
  const GpgpGrammarValue sizeX = GPGP_GRAMMAR_VALUE(GPGP_VALUE_SHAPE_SIZE_X);
  const GpgpGrammarValue sizeY = GPGP_GRAMMAR_VALUE(GPGP_VALUE_SHAPE_SIZE_Y);
  const GpgpGrammarValue sizeZ = GPGP_GRAMMAR_VALUE(GPGP_VALUE_SHAPE_SIZE_Z);
  const GpgpGrammarValue fill = GPGP_GRAMMAR_VALUE(GPGP_VALUE_ADJUST_TO_FILL);
  const GpgpGrammarValue tile = gpgpAddVariable(builder, "tile", number(3));
  GpgpGrammarSuccessor to[3];
  GpgpGrammarValue values[3];
  GpgpGrammarOperator op;

  gpgpAddAxiom(builder, GPGP_SHAPE_BOX, NULL, 0, "House");
  gpgpAddTerminal(builder, "Wall", 1, 13);
  gpgpAddTerminal(builder, "Window", 1, 14);
  gpgpAddTerminal(builder, "Roof", 1, 12);

  /* House = Replicate() { CompSplit() { Discard() | Discard() | Facade } | Gable }; */
  to[0] = further(gpgpAddOperator(builder, GPGP_OPERATOR_DISCARD, NULL, 0, NULL, 0));
  to[1] = further(gpgpAddOperator(builder, GPGP_OPERATOR_DISCARD, NULL, 0, NULL, 0));
  to[2] = named("Facade");
  to[0] = further(gpgpAddOperator(builder, GPGP_OPERATOR_COMP_SPLIT, NULL, 0, to, 3));
  to[1] = named("Gable");
  gpgpAddRule(builder, "House", NULL, gpgpAddOperator(builder, GPGP_OPERATOR_REPLICATE, NULL, 0, to, 2));

  /* Gable = Translate(0, ShapeSize(Y) * 0.5, 0) Rotate(0, 0, 45)
   *         Scale((ShapeSize(X) + 1) * 0.70711, the same, ShapeSize(Z) - 0.1) Roof; what comes last is added first */
  values[0] = gpgpAddExpression(builder, GPGP_EXPRESSION_MULTIPLY,
                                gpgpAddExpression(builder, GPGP_EXPRESSION_ADD, sizeX, number(1)), number(0.70711f));
  values[1] = values[0];
  values[2] = gpgpAddExpression(builder, GPGP_EXPRESSION_SUBTRACT, sizeZ, number(0.1f));
  to[0] = named("Roof");
  op = gpgpAddOperator(builder, GPGP_OPERATOR_SCALE, values, 3, to, 1);
  values[0] = values[1] = number(0);
  values[2] = number(45);
  to[0] = further(op);
  op = gpgpAddOperator(builder, GPGP_OPERATOR_ROTATE, values, 3, to, 1);
  values[1] = gpgpAddExpression(builder, GPGP_EXPRESSION_MULTIPLY, sizeY, number(0.5f));
  values[2] = number(0);
  to[0] = further(op);
  gpgpAddRule(builder, "Gable", NULL, gpgpAddOperator(builder, GPGP_OPERATOR_TRANSLATE, values, 3, to, 1));

  /* Facade = Repeat(Y, tile, ADJUST_TO_FILL) Repeat(X, tile, ADJUST_TO_FILL) Tile; */
  values[0] = kX;
  values[1] = tile;
  values[2] = fill;
  to[0] = named("Tile");
  op = gpgpAddOperator(builder, GPGP_OPERATOR_REPEAT, values, 3, to, 1);
  values[0] = kY;
  to[0] = further(op);
  gpgpAddRule(builder, "Facade", NULL, gpgpAddOperator(builder, GPGP_OPERATOR_REPEAT, values, 3, to, 1));

  thirds(builder, "Tile", kX, across, tileParts);
  thirds(builder, "Opening", kY, upwards, openingParts);
}

static void GPGP_CALL onMessage(void* user, const GpgpCompileMessage* message) {
  (void)user;
  fprintf(stderr, "%s: %s\n", message->file,
          message->text); /* "house: rule 'Gable', Translate, value 2: expected ..." */
}

/* Builds, compiles, says how large the baked grammar is. */
static int bake(const char* name, void (*build)(GpgpGrammarBuilder builder)) {
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  GpgpBlob blob = {NULL, 0};
  GpgpResult result = gpgpCreateGrammarBuilder(&source.builder);
  if (result == GPGP_SUCCESS) {
    build(source.builder);
    source.name = name;
    source.messageFn = onMessage;
    result = gpgpCompileGrammar(&source, &blob); /* every error of the builder is reported here */
  }
  if (result == GPGP_SUCCESS) printf("%s: %lu bytes\n", name, (unsigned long)blob.size);
  gpgpFreeBlob(&blob);
  gpgpDestroyGrammarBuilder(source.builder);
  return result == GPGP_SUCCESS;
}

int main(void) {
  const int sponge = bake("sponge", buildSponge), house = bake("house", buildHouse);
  return sponge && house ? 0 : 1;
}
