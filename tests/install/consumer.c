/* What a program that only just found gpgp can do: ask the library for its version, and get a clear error from a call
 * without a device. Also proves that header and library belong together. */
#include <gpgp/gpgp.h>

#include <stdio.h>
#include <string.h>

#ifdef CONSUMER_OF_EVALUATOR_ALONE
/* A server that only derives links libgpgp_evaluator and nothing else. */
int main(void) {
  static const char text[] = "axiom Box A; terminal T (1, 0); A = Repeat(X, 1, ADJUST_TO_FILL) T;";
  GpgpGrammarSource source = GPGP_GRAMMAR_SOURCE_INIT;
  GpgpEvaluatorCreateInfo info = GPGP_EVALUATOR_CREATE_INFO_INIT;
  GpgpEvaluationInfo what = GPGP_EVALUATION_INFO_INIT;
  GpgpEvaluationResult made = GPGP_EVALUATION_RESULT_INIT;
  GpgpEvaluator evaluator = NULL;
  GpgpEvaluation evaluation = NULL;
  GpgpAxiom axiom;
  memset(&axiom, 0, sizeof axiom);
  axiom.transform[0] = axiom.transform[5] = axiom.transform[10] = 1;
  axiom.size[0] = 12;
  axiom.size[1] = axiom.size[2] = 1;
  axiom.start = GPGP_AXIOM_DEFAULT_START;
  source.text = text;
  source.size = sizeof text - 1;
  info.sources = &source;
  info.sourceCount = 1;
  what.axioms = &axiom;
  what.axiomCount = 1;
  if (gpgpCreateEvaluator(&info, &evaluator) != GPGP_SUCCESS) return 5;
  if (gpgpCreateEvaluation(evaluator, &evaluation) != GPGP_SUCCESS) return 6;
  if (gpgpEvaluate(evaluation, &what) != GPGP_SUCCESS) return 7;
  if (gpgpGetEvaluationResult(evaluation, &made) != GPGP_SUCCESS || made.terminals != 12) return 8;
  printf("%u terminals\n", (unsigned)made.axioms[0].instanceCount);
  gpgpDestroyEvaluation(evaluation);
  gpgpDestroyEvaluator(evaluator);
  return gpgpGetVersion() == GPGP_VERSION ? 0 : 9;
}
#elif defined(CONSUMER_OF_TEXT_ALONE)
/* A tool that only sets text links libgpgp_text and nothing else. */
int main(void) {
  GpgpShaperCreateInfo text = GPGP_SHAPER_CREATE_INFO_INIT;
  GpgpShaper shaper = NULL;
  const GpgpResult result = gpgpCreateShaper(&text, &shaper);
  printf("%s\n", gpgpResultString(result));
  gpgpDestroyShaper(shaper);
  return result == GPGP_SUCCESS ? 0 : 4;
}
#else
int main(void) {
  GpgpContextCreateInfo info = GPGP_CONTEXT_CREATE_INFO_INIT;
  GpgpContext context = NULL;
  const GpgpResult result = gpgpCreateContext(&info, &context);
#ifdef CONSUMER_USES_COMPILER
  GpgpBlob blob = {NULL, 0};
  gpgpFreeBlob(&blob);
#endif
#ifdef CONSUMER_USES_TEXT
  GpgpShaperCreateInfo text = GPGP_SHAPER_CREATE_INFO_INIT;
  GpgpShaper shaper = NULL;
  if (gpgpCreateShaper(&text, &shaper) != GPGP_SUCCESS) return 4;
  gpgpDestroyShaper(shaper);
#endif
  if (gpgpGetVersion() != GPGP_VERSION) return 1;
  if (result != GPGP_ERROR_INVALID_ARGUMENT || context) return 2;
  if (strcmp(gpgpResultString(result), "GPGP_ERROR_INVALID_ARGUMENT") != 0) return 3;
  printf("gpgp %u.%u\n", (unsigned)(gpgpGetVersion() >> 22), (unsigned)(gpgpGetVersion() >> 12 & 1023));
  return 0;
}
#endif
