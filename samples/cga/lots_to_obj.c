/* A .cga file in an engine's tools: prints its attributes as an editor would group them, derives a street of lots and
 * writes their triangles as OBJ.
 *
 *   lots_to_obj samples/cga/house.cga houses.obj floors=2 roofForm=hip
 *
 * C99, libgpgp_evaluator; neither a GPU nor a context. */
#include <gpgp/cga.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LOTS = 8, MOST_VALUES = 32 };

static void GPGP_CALL onMessage(void* user, const GpgpCompileMessage* m) {
  (void)user;
  if (m->line)
    fprintf(stderr, "%s:%u:%u: %s\n", m->file, m->line, m->column, m->text);
  else
    fprintf(stderr, "%s: %s\n", m->file, m->text);
}

/* An editor would make a slider, a list or a colour button of each. */
static void printAttribute(const GpgpCgaAttribute* a) {
  uint32_t i;
  for (i = 0; i < a->groupCount; ++i) printf("%s / ", a->groups[i]);
  printf("%s = %s", a->name, a->text);
  if (!isnan(a->min) && !isnan(a->max)) printf("   %g to %g", a->min, a->max);
  if (!isnan(a->step)) printf(" by %g", a->step);
  for (i = 0; i < a->choiceCount; ++i) printf("%s%s", i ? " | " : "   ", a->choices[i]);
  if (a->flags & GPGP_CGA_ATTRIBUTE_COLOR) printf("   colour");
  if (a->description[0]) printf("   %s", a->description);
  printf("\n");
}

static int listAttributes(GpgpCgaProgram program) {
  uint32_t count = 0, i;
  GpgpCgaAttribute* all;
  if (gpgpGetCgaAttributes(program, &count, NULL) != GPGP_SUCCESS) return 0;
  all = (GpgpCgaAttribute*)calloc(count ? count : 1, sizeof *all);
  if (!all || gpgpGetCgaAttributes(program, &count, all) != GPGP_SUCCESS) {
    free(all);
    return 0;
  }
  for (i = 0; i < count; ++i)
    if (!(all[i].flags & GPGP_CGA_ATTRIBUTE_HIDDEN)) printAttribute(&all[i]);
  free(all);
  return 1;
}

static int writeObj(const GpgpCgaDerivationResult* result, const char* path) {
  uint32_t i, leaf;
  FILE* file = fopen(path, "w");
  if (!file) return 0;
  for (i = 0; i < result->vertexCount; ++i) {
    const GpgpCgaVertex* v = &result->vertices[i];
    fprintf(file, "v %g %g %g\nvt %g %g\nvn %g %g %g\n", v->position[0], v->position[1], v->position[2], v->uv[0],
            v->uv[1], v->normal[0], v->normal[1], v->normal[2]);
  }
  for (leaf = 0; leaf < result->leafCount; ++leaf) {
    const GpgpCgaLeaf* l = &result->leaves[leaf];
    fprintf(file, "g lot%u_%s\n", l->lot, l->rule);
    for (i = l->firstIndex; i < l->firstIndex + l->indexCount; i += 3) {
      const uint32_t *k = &result->indices[i], a = k[0] + 1, b = k[1] + 1, c = k[2] + 1;
      fprintf(file, "f %u/%u/%u %u/%u/%u %u/%u/%u\n", a, a, a, b, b, b, c, c, c);
    }
  }
  return fclose(file) == 0;
}

static int derive(GpgpCgaProgram program, const GpgpCgaValue* values, uint32_t valueCount, const char* path) {
  GpgpCgaLot lots[LOTS];
  GpgpCgaDerivationInfo info = GPGP_CGA_DERIVATION_INFO_INIT;
  GpgpCgaDerivationResult result = GPGP_CGA_DERIVATION_RESULT_INIT;
  GpgpCgaDerivation derivation = NULL;
  int i, done;
  memset(lots, 0, sizeof lots);
  for (i = 0; i < LOTS; ++i) {
    GpgpAxiom* axiom = &lots[i].axiom;
    axiom->transform[0] = axiom->transform[5] = axiom->transform[10] = 1;
    axiom->transform[3] = 24.0f * (float)i; /* x of the lot's middle */
    axiom->size[0] = 22;
    axiom->size[2] = 26;
    axiom->seed = 1 + (uint32_t)i;
    axiom->start = GPGP_AXIOM_DEFAULT_START;
  }
  info.lots = lots;
  info.lotCount = LOTS;
  info.values = values;
  info.valueCount = valueCount;
  info.messageFn = onMessage;
  done = gpgpCreateCgaDerivation(program, &derivation) == GPGP_SUCCESS &&
         gpgpDeriveCga(derivation, &info) == GPGP_SUCCESS &&
         gpgpGetCgaDerivationResult(derivation, &result) == GPGP_SUCCESS;
  if (done) {
    printf("%u lots: %u shapes, %llu triangles\n", LOTS, result.leafCount, (unsigned long long)result.triangles);
    for (i = 0; i < (int)result.reportCount; ++i)
      printf("report %s: %g\n", result.reports[i].name, result.reports[i].sum);
    done = writeObj(&result, path);
    if (!done) fprintf(stderr, "%s cannot be written\n", path);
  }
  gpgpDestroyCgaDerivation(derivation);
  return done;
}

int main(int argc, char** argv) {
  GpgpCgaProgramCreateInfo info = GPGP_CGA_PROGRAM_CREATE_INFO_INIT;
  GpgpCgaProgram program = NULL;
  GpgpCgaValue values[MOST_VALUES];
  uint32_t valueCount = 0;
  int i, done;
  if (argc < 3 || argc - 3 > MOST_VALUES) {
    fprintf(stderr, "usage: lots_to_obj FILE.cga OUT.obj [NAME=VALUE...]\n");
    return 2;
  }
  for (i = 3; i < argc; ++i) {
    char* equals = strchr(argv[i], '=');
    if (!equals) {
      fprintf(stderr, "\"%s\" is not NAME=VALUE\n", argv[i]);
      return 2;
    }
    *equals = 0;
    values[valueCount].name = argv[i];
    values[valueCount++].text = equals + 1;
  }
  info.name = argv[1];
  info.messageFn = onMessage;
  if (gpgpCreateCgaProgram(&info, &program) != GPGP_SUCCESS) return 1;
  done = listAttributes(program) && derive(program, values, valueCount, argv[2]);
  gpgpDestroyCgaProgram(program);
  return done ? 0 : 1;
}
