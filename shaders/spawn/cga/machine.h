// Runs one chunk of a CGA program: expressions, conditions, functions and the order of operations on shapes.
//
// The text is GLSL and C++. Who includes it has included functions.h before, and provides, as functions (GLSL) or as
// members of the struct around the inclusion (C++):
//
//   uint cgaWord(uint at)                                    the program
//   CgaValue cgaStack(uint at), void cgaSetStack(uint, CgaValue), uint cgaStackSize()
//   uint cgaFrame(uint at), void cgaSetFrame(uint, uint), uint cgaMostFrames()  two words a frame
//   uint cgaMostTurns()                                      instructions of one run
//   CgaValue cgaAttribute(uint slot), void cgaSetAttribute(uint slot, CgaValue)
//   float cgaRandom()                                        the next number of [0, 1)
//   CgaValue cgaAddOther(CgaValue, CgaValue)                 a sum with strings or arrays
//   CgaValue cgaCompareOther(uint code, CgaValue, CgaValue)  a comparison of what are not two numbers
//   CgaValue cgaEach(uint code, CgaValue, CgaValue)
//   CgaValue cgaFunction(uint function, uint first, uint count)  first: of the arguments, in the stack
//   CgaValue cgaArray(uint first, uint count), CgaValue cgaIndex(uint first, uint count), CgaValue cgaRange(...)
//   bool cgaOperation(uint operation, uint first, uint count), bool cgaBlock(..., uint table, uint base)
//   bool cgaInvoke(uint chunk, uint first, uint count), bool cgaGoOn(uint chunk)
//   bool cgaLeaf(uint name), void cgaNil(), bool cgaPushShape(), bool cgaPopShape(), bool cgaEnd()
//   void cgaAt(uint at)                                      the instruction that runs next, for messages
//
// Those that give a bool stop the run by false.

GPGP_FN CgaValue cgaBinary(uint code, CgaValue a, CgaValue b) {
  const bool numbers = (a.type == kCgaFloat || a.type == kCgaBool) && (b.type == kCgaFloat || b.type == kCgaBool);
  if (code >= kCgaEqualCode) {
    if (numbers) return cgaBoolValue(cgaCompare(code, cgaNumber(a), cgaNumber(b)));
    return cgaCompareOther(code, a, b);
  }
  if (!numbers && code == kCgaAddCode) return cgaAddOther(a, b);
  const float x = cgaNumber(a);
  const float y = cgaNumber(b);
  float result = 0.0f;
  if (code == kCgaAddCode) result = add(x, y);
  if (code == kCgaSubtractCode) result = subtract(x, y);
  if (code == kCgaMultiplyCode) result = multiply(x, y);
  if (code == kCgaDivideCode) result = divide(x, y);
  if (code == kCgaModuloCode) result = cgaModulo(x, y);
  return cgaFloatValue(result);
}

/// rand and p draw, once each.
GPGP_FN CgaValue cgaCallMath(uint function, uint first, uint count) {
  const float a = count > 0u ? cgaNumber(cgaStack(first)) : 0.0f;
  const float b = count > 1u ? cgaNumber(cgaStack(first + 1u)) : 0.0f;
  if (function == kCgaPMath) return cgaBoolValue(cgaRandom() < a);
  if (function == kCgaRandMath) {
    const float r = cgaRandom();
    if (count == 0u) return cgaFloatValue(r);
    const float low = count == 1u ? 0.0f : a;
    const float high = count == 1u ? a : b;
    return cgaFloatValue(add(low, multiply(r, subtract(high, low))));
  }
  // What no number is stays one: isnan(ln(-1)).
  if (function == kCgaIsnanMath) return cgaBoolValue(cgaStack(first).type == kCgaNothing);
  if (cgaHasNoValue(function, a)) return cgaMake(kCgaNothing, 0u);
  const float result = cgaMath(function, a, b);
  if (function == kCgaIsinfMath) return cgaBoolValue(result != 0.0f);
  return cgaFloatValue(result);
}

/// chunk: the offset of its header. base: where its parameters lie in the stack. How it ended; what a function returns
/// is at base then.
GPGP_FN uint cgaRun(uint chunk, uint base) {
  uint frames = 0u;
  uint at = chunk + kCgaChunkHeader;
  uint top = base + cgaWord(chunk + kCgaChunkLocals);
  const uint mostTurns = cgaMostTurns();
  for (uint turn = 0u; turn < mostTurns; ++turn) {
    if (top + 2u >= cgaStackSize()) return kCgaStackFull;
    const uint code = cgaWord(at);
    switch (code) {
    case kCgaPushFloatCode:
      cgaSetStack(top++, cgaMake(kCgaFloat, cgaWord(at + 1u)));
      at += 2u;
      break;
    case kCgaPushBoolCode:
      cgaSetStack(top++, cgaMake(kCgaBool, cgaWord(at + 1u)));
      at += 2u;
      break;
    case kCgaPushStringCode:
      cgaSetStack(top++, cgaMake(kCgaString, cgaWord(at + 1u)));
      at += 2u;
      break;
    case kCgaPushWordCode:
      cgaSetStack(top++, cgaMake(kCgaWord, cgaWord(at + 1u)));
      at += 2u;
      break;
    case kCgaPushNothingCode:
      cgaSetStack(top++, cgaMake(kCgaNothing, 0u));
      at += 1u;
      break;
    case kCgaLocalCode:
      cgaSetStack(top++, cgaStack(base + cgaWord(at + 1u)));
      at += 2u;
      break;
    case kCgaSetLocalCode:
      cgaSetStack(base + cgaWord(at + 1u), cgaStack(--top));
      at += 2u;
      break;
    case kCgaAttributeCode:
      cgaSetStack(top++, cgaAttribute(cgaWord(at + 1u)));
      at += 2u;
      break;
    case kCgaPopCode:
      top -= 1u;
      at += 1u;
      break;
    case kCgaAddCode:
    case kCgaSubtractCode:
    case kCgaMultiplyCode:
    case kCgaDivideCode:
    case kCgaModuloCode:
    case kCgaEqualCode:
    case kCgaNotEqualCode:
    case kCgaLessCode:
    case kCgaLessEqualCode:
    case kCgaGreaterCode:
    case kCgaGreaterEqualCode:
      cgaAt(at);
      top -= 1u;
      cgaSetStack(top - 1u, cgaBinary(code, cgaStack(top - 1u), cgaStack(top)));
      at += 1u;
      break;
    case kCgaEachCode:
      cgaAt(at);
      top -= 1u;
      cgaSetStack(top - 1u, cgaEach(cgaWord(at + 1u), cgaStack(top - 1u), cgaStack(top)));
      at += 2u;
      break;
    case kCgaNegateCode:
      cgaSetStack(top - 1u, cgaFloatValue(-cgaNumber(cgaStack(top - 1u))));
      at += 1u;
      break;
    case kCgaNotCode:
      cgaSetStack(top - 1u, cgaBoolValue(!cgaIsTrue(cgaStack(top - 1u))));
      at += 1u;
      break;
    case kCgaRelativeCode:
    case kCgaFloatingCode:
      cgaSetStack(top - 1u, cgaMake(code == kCgaRelativeCode ? kCgaRelative : kCgaFloating,
                                    floatBitsToUint(cgaNumber(cgaStack(top - 1u)))));
      at += 1u;
      break;
    case kCgaJumpCode: at = cgaWord(at + 1u); break;
    case kCgaJumpUnlessCode:
      top -= 1u;
      at = cgaIsTrue(cgaStack(top)) ? at + 2u : cgaWord(at + 1u);
      break;
    case kCgaAndCode:
    case kCgaOrCode: {
      const bool value = cgaIsTrue(cgaStack(top - 1u));
      if (value == (code == kCgaOrCode)) {
        cgaSetStack(top - 1u, cgaBoolValue(value));
        at = cgaWord(at + 1u);
      } else {
        top -= 1u;
        at += 2u;
      }
      break;
    }
    case kCgaDrawCode:
      cgaSetStack(top++, cgaFloatValue(multiply(cgaRandom(), 100.0f)));
      at += 1u;
      break;
    case kCgaChooseCode: {
      const float part = cgaNumber(cgaStack(top - 1u));
      const float drawn = cgaNumber(cgaStack(top - 2u));
      top -= 1u;
      if (drawn < part) {
        top -= 1u;
        at += 2u;
      } else {
        cgaSetStack(top - 1u, cgaFloatValue(subtract(drawn, part)));
        at = cgaWord(at + 1u);
      }
      break;
    }
    case kCgaCallCode: {
      cgaAt(at);
      if (frames + 1u >= cgaMostFrames()) return kCgaTooDeep;
      const uint callee = cgaWord(at + 1u);
      cgaSetFrame(2u * frames, at + 3u);
      cgaSetFrame(2u * frames + 1u, base);
      frames += 1u;
      base = top - cgaWord(at + 2u);
      top = base + cgaWord(callee + kCgaChunkLocals);
      at = callee + kCgaChunkHeader;
      break;
    }
    case kCgaReturnCode: {
      const CgaValue result = cgaStack(top - 1u);
      cgaSetStack(base, result);
      if (frames == 0u) return kCgaDone;
      frames -= 1u;
      top = base + 1u;
      at = cgaFrame(2u * frames);
      base = cgaFrame(2u * frames + 1u);
      break;
    }
    case kCgaMathCode:
      top -= cgaWord(at + 2u);
      cgaSetStack(top, cgaCallMath(cgaWord(at + 1u), top, cgaWord(at + 2u)));
      top += 1u;
      at += 3u;
      break;
    case kCgaFunctionCode:
      cgaAt(at);
      top -= cgaWord(at + 2u);
      cgaSetStack(top, cgaFunction(cgaWord(at + 1u), top, cgaWord(at + 2u)));
      top += 1u;
      at += 3u;
      break;
    case kCgaArrayCode:
      cgaAt(at);
      top -= cgaWord(at + 1u);
      cgaSetStack(top, cgaArray(top, cgaWord(at + 1u)));
      top += 1u;
      at += 2u;
      break;
    case kCgaIndexCode:
      cgaAt(at);
      top -= cgaWord(at + 1u) + 1u;
      cgaSetStack(top, cgaIndex(top, cgaWord(at + 1u)));
      top += 1u;
      at += 2u;
      break;
    case kCgaRangeCode:
      top -= 2u;
      cgaSetStack(top, cgaRange(cgaStack(top), cgaStack(top + 1u)));
      top += 1u;
      at += 1u;
      break;
    case kCgaOperationCode:
      cgaAt(at);
      top -= cgaWord(at + 2u);
      if (!cgaOperation(cgaWord(at + 1u), top, cgaWord(at + 2u))) return kCgaStopped;
      at += 3u;
      break;
    case kCgaBlockCode:
      cgaAt(at);
      top -= cgaWord(at + 2u);
      if (!cgaBlock(cgaWord(at + 1u), top, cgaWord(at + 2u), cgaWord(at + 3u), base)) return kCgaStopped;
      at += 4u;
      break;
    case kCgaInvokeCode:
      cgaAt(at);
      top -= cgaWord(at + 2u);
      if (!cgaInvoke(cgaWord(at + 1u), top, cgaWord(at + 2u))) return kCgaStopped;
      at += 3u;
      break;
    case kCgaInvokeLastCode: {
      cgaAt(at);
      const uint callee = cgaWord(at + 1u);
      const uint count = cgaWord(at + 2u);
      if (!cgaGoOn(callee)) return kCgaStopped;
      for (uint i = 0u; i < count; ++i) cgaSetStack(base + i, cgaStack(top - count + i));
      top = base + cgaWord(callee + kCgaChunkLocals);
      at = callee + kCgaChunkHeader;
      break;
    }
    case kCgaLeafCode:
      cgaAt(at);
      if (!cgaLeaf(cgaWord(at + 1u))) return kCgaStopped;
      at += 2u;
      break;
    case kCgaNilCode:
      cgaNil();
      at += 1u;
      break;
    case kCgaPushShapeCode:
    case kCgaPopShapeCode:
      cgaAt(at);
      if (!(code == kCgaPushShapeCode ? cgaPushShape() : cgaPopShape())) return kCgaStopped;
      at += 1u;
      break;
    case kCgaSetAttributeCode:
      cgaAt(at);
      top -= 1u;
      cgaSetAttribute(cgaWord(at + 1u), cgaStack(top));
      at += 2u;
      break;
    case kCgaEndCode: return cgaEnd() ? kCgaDone : kCgaStopped;
    default: return kCgaBadCode;
    }
  }
  return kCgaTooLong;
}
